#include "kapitza/common.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>

static char message[2048];
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER; /* threads may fail at once: the message is that of the first */

kz_status kz_fail(kz_status status, const char *format, ...) {
  pthread_mutex_lock(&mutex);
  if (message[0] == '\0') {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
  }
  pthread_mutex_unlock(&mutex);
  return status;
}

const char *kz_message(void) {
  return message;
}

void kz_message_clear(void) {
  pthread_mutex_lock(&mutex);
  message[0] = '\0';
  pthread_mutex_unlock(&mutex);
}
