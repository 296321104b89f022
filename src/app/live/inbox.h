/* Reads lines of standard input as they arrive. */
#pragma once

#include "kapitza/common.h"

typedef struct {
  char *bytes;          /* KZ_LINE_MOST + 1 of them: */
  size_t first, filled; /* index of the first byte not yet taken; number of bytes read */
  bool skips;           /* true while the rest of a line that is too long is skipped */
  bool ended;           /* the input has ended */
} kz_inbox;
enum { KZ_LINE_MOST = 65536 };

void kz_inbox_open(kz_inbox *inbox);
void kz_inbox_close(kz_inbox *inbox);

/* The next line without its newline, valid until the next call; NULL if there is none, which with waits = true happens
 * at the end of the input only. The last line needs no newline. *status is KZ_REFUSED for a line that is too long. */
const char *kz_inbox_line(kz_inbox *inbox, bool waits, size_t *length, kz_status *status);
