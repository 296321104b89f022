/* The log of a run: JSON lines for programs (--log), and the table of timings for people (--timings). Rank 0. */
#ifndef KAPITZA_APP_LOG_H
#define KAPITZA_APP_LOG_H

#include <stdio.h>

#include "kapitza/parallel.h"

/* Opens FILE to go on writing at its end. KZ_REFUSED where it cannot be written, or is there and no such log. */
kz_status kz_log_open(const char *path, FILE **log);
/* One event, "begin", "warning" or "end": `fields` are pairs of name and text, NULL-ended; "#name": the text is a
 * number. `log` NULL: nothing. */
void kz_log_event(FILE *log, double seconds, const char *event, const char *const *fields);
/* An event "warning" for each line of `text` that is one. */
void kz_log_warnings(FILE *log, double seconds, const char *text);
/* Closes it; KZ_FAILED where not all was written. NULL: nothing. */
kz_status kz_log_close(FILE *log, const char *path);

/* Prints where the time went. */
void kz_timings_print(const kz_ranks *ranks, FILE *out);

/* What stands between the quotes of a text in JSON. */
void kz_json_text(FILE *out, const char *text);

#endif
