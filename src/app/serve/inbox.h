/* Lines of standard input, taken as they come. */
#ifndef KAPITZA_APP_INBOX_H
#define KAPITZA_APP_INBOX_H

#include <stdbool.h>
#include <stddef.h>

#include "kapitza/common.h"

typedef struct {
  char *bytes;          /* KZ_LINE_MOST + 1 of them: */
  size_t first, filled; /* not yet taken, and read so far */
  bool skips;           /* the rest of a line that is too long */
  bool ended;           /* there will be no more */
} kz_inbox;
enum { KZ_LINE_MOST = 65536 };

void kz_inbox_open(kz_inbox *inbox);
void kz_inbox_close(kz_inbox *inbox);

/* The next line, without its end, valid until the next call; NULL where there is none: `waits` = only at the end of input. The last
 * line needs no newline. A line that is too long is refused: *status. */
const char *kz_inbox_line(kz_inbox *inbox, bool waits, size_t *length, kz_status *status);

#endif
