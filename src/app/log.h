/* The log of a run: JSON lines for programs (--log), and the table of timings for people (--timings). Rank 0. */
#ifndef KAPITZA_APP_LOG_H
#define KAPITZA_APP_LOG_H

#include <stdio.h>

#include "kapitza/parallel.h"

/* Opens FILE to append to it. KZ_REFUSED if it cannot be written, or if it exists and is not such a log. */
kz_status kz_log_open(const char *path, FILE **log);
/* Writes one event, "begin", "warning" or "end". `fields` = pairs of name and text, NULL-ended; "#name" = the text is a number. NULL as
 * `log`: does nothing. */
void kz_log_event(FILE *log, double seconds, const char *event, const char *const *fields);
/* Writes an event "warning" for each line of `text` that is a warning. */
void kz_log_warnings(FILE *log, double seconds, const char *text);
/* Closes the log; KZ_FAILED if it could not be written completely. NULL: does nothing. */
kz_status kz_log_close(FILE *log, const char *path);

/* Prints the table of timings. */
void kz_timings_print(const kz_ranks *ranks, FILE *out);

/* Prints `text` escaped for JSON, without the quotes. */
void kz_json_text(FILE *out, const char *text);

#endif
