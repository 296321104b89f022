#include "inbox.h"

#include <errno.h>
#include <poll.h>
#include <unistd.h>

void kz_inbox_open(kz_inbox *inbox) {
  *inbox = (kz_inbox){.bytes = kz_malloc(KZ_LINE_MOST + 1)};
}

void kz_inbox_close(kz_inbox *inbox) {
  free(inbox->bytes);
  *inbox = (kz_inbox){0};
}

/* Reads what is there; false where nothing is, or at the end. */
static bool inbox_fill(kz_inbox *inbox, bool waits) {
  struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN};
  if (inbox->first > 0) {
    memmove(inbox->bytes, inbox->bytes + inbox->first, inbox->filled - inbox->first);
    inbox->filled -= inbox->first;
    inbox->first = 0;
  }
  int ready;
  while ((ready = poll(&input, 1, waits ? -1 : 0)) < 0 && errno == EINTR) continue;
  if (ready <= 0) return false;
  ssize_t n;
  while ((n = read(STDIN_FILENO, inbox->bytes + inbox->filled, KZ_LINE_MOST + 1 - inbox->filled)) < 0 && errno == EINTR)
    continue;
  inbox->ended = n <= 0;
  if (n > 0) inbox->filled += (size_t)n;
  return n > 0;
}

/* The end of the first line that has been read, or NULL. */
static char *line_end(const kz_inbox *inbox) {
  return memchr(inbox->bytes + inbox->first, '\n', inbox->filled - inbox->first);
}

/* Forgets what fills the whole buffer; true where a line is so long that it begins there. */
static bool is_too_long(kz_inbox *inbox) {
  if (inbox->filled - inbox->first <= KZ_LINE_MOST) return false;
  const bool begins = !inbox->skips;
  inbox->first = inbox->filled;
  inbox->skips = true;
  return begins;
}

/* What stands after the last newline, once the input has ended; NULL where nothing does. */
static const char *last_line(kz_inbox *inbox, size_t *length) {
  const char *line = inbox->bytes + inbox->first;
  *length = inbox->filled - inbox->first;
  inbox->first = inbox->filled;
  return *length > 0 && !inbox->skips ? line : NULL;
}

const char *kz_inbox_line(kz_inbox *inbox, bool waits, size_t *length, kz_status *status) {
  char *end;
  *status = KZ_OK;
  for (;;) {
    while (!(end = line_end(inbox))) {
      if (is_too_long(inbox)) {
        *status = kz_fail(KZ_REFUSED, "request: has more than %d bytes", KZ_LINE_MOST);
        return NULL;
      }
      if (inbox->ended) return last_line(inbox, length);
      if (!inbox_fill(inbox, waits) && !inbox->ended) return NULL;
    }
    const char *line = inbox->bytes + inbox->first;
    *length = (size_t)(end - line);
    inbox->first += *length + 1;
    if (!inbox->skips) return line;
    inbox->skips = false;
  }
}
