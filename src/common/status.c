#include "kapitza/common.h"

#include <stdarg.h>

/* Message of this thread: another may fail at the same moment. */
static _Thread_local char message[KZ_MESSAGE_BYTES];

kz_status kz_fail(kz_status status, const char *format, ...) {
  if (message[0] == '\0') {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
  }
  return status;
}

const char *kz_message(void) {
  return message;
}

void kz_message_clear(void) {
  message[0] = '\0';
}
