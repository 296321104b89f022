/* The message with which the program ends. */
#include "app.h"

/* One line whatever the message holds: control characters become '?'. */
static void print_message(kz_status status) {
  fputs(status == KZ_STOPPED ? "kapitza: " : "kapitza: error: ", stderr);
  for (const char *c = kz_message(); *c;) {
    const int control = kz_control_bytes(c);
    fputc(control ? '?' : *c, stderr);
    c += control ? control : 1;
  }
  fputc('\n', stderr);
}

kz_status kz_say(kz_status status) {
  if (fflush(stdout) != 0 && status == KZ_OK) status = kz_fail(KZ_FAILED, "standard output cannot be written");
  if (status != KZ_OK && kz_message()[0]) print_message(status);
  kz_message_clear();
  return status;
}
