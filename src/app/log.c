#include "app.h"
#include "json.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static const char FIRST[] = "{\"event\": \"";

/* An empty file, or one that begins as a log does. */
static bool is_log(int file) {
  char begin[sizeof FIRST] = "";
  const ssize_t n = pread(file, begin, sizeof FIRST - 1, 0);
  return n == 0 || (n == sizeof FIRST - 1 && memcmp(begin, FIRST, sizeof FIRST - 1) == 0);
}

/* A run that was killed may have cut its last line: what follows begins on a line of its own. */
static void end_line(int file, off_t bytes, FILE *log) {
  char last = '\n';
  if (bytes > 0 && pread(file, &last, 1, bytes - 1) == 1 && last != '\n') fputc('\n', log);
}

kz_status kz_log_open(const char *path, FILE **log) {
  struct stat facts;
  const int file = open(path, O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file < 0) return kz_fail(KZ_REFUSED, "--log: %s: cannot be written: %s; use another name", path, strerror(errno));
  const bool regular = fstat(file, &facts) == 0 && S_ISREG(facts.st_mode);
  if (regular && is_log(file) && (*log = fdopen(file, "a"))) {
    end_line(file, facts.st_size, *log);
    return KZ_OK;
  }
  close(file);
  return kz_fail(KZ_REFUSED, "--log: %s: exists and is no log of this program; use another name", path);
}

void kz_log_event(FILE *log, double seconds, const char *event, const char *const *fields) {
  if (!log) return;
  fprintf(log, "%s%s\", \"seconds\": %.3f", FIRST, event, seconds);
  for (; *fields; fields += 2) {
    const bool number = fields[0][0] == '#';
    kz_json *text = kz_json_text(fields[1]);
    fprintf(log, ", \"%s\": %s", fields[0] + number,
            number ? fields[1] : json_object_to_json_string_ext(text, JSON_C_TO_STRING_NOSLASHESCAPE));
    json_object_put(text);
  }
  fputs("}\n", log);
  fflush(log);
}

void kz_log_warnings(FILE *log, double seconds, const char *text) {
  for (size_t n; *text; text += n + (text[n] == '\n')) {
    char line[1024];
    n = strcspn(text, "\n");
    snprintf(line, sizeof line, "%.*s", (int)(n < sizeof line ? n : sizeof line - 1), text);
    if (strstr(line, "warning: ")) kz_log_event(log, seconds, "warning", (const char *const[]){"text", line, NULL});
  }
}

kz_status kz_log_close(FILE *log, const char *path) {
  if (!log) return KZ_OK;
  const bool whole = !ferror(log);
  return fclose(log) == 0 && whole ? KZ_OK : kz_fail(KZ_FAILED, "--log: %s: cannot be written", path);
}

void kz_timings_print(const kz_ranks *ranks, FILE *out) {
  const kz_timing *list;
  const int64_t n = kz_ranks_timings(ranks, &list);
  const double all = kz_ranks_seconds(ranks), outside = kz_ranks_outside(ranks);
  const int count = kz_ranks_count(ranks);
  double rest = all, processor = outside, most = outside, busy = 0, serial = 0;
  fprintf(out, "%-12s %7s %9s %9s %12s %9s %7s %9s\n", "stage", "times", "tiles", "wall s", "processor s", "most s",
          "busy", "serial s");
  for (int64_t i = 0; i < n; i++) {
    const kz_timing *t = &list[i];
    fprintf(out, "%-12s %7lld %9lld %9.3f %12.3f %9.3f %5.1f %% %9.3f\n", t->stage, (long long)t->calls,
            (long long)t->tiles, t->wall, t->processor, t->most,
            t->wall > 0 ? 100 * t->busy / (t->wall * count) : 100.0, t->serial);
    rest -= t->wall;
    processor += t->processor;
    most += t->most;
    busy += t->busy;
    serial += t->serial;
  }
  fprintf(out, "%-12s %7s %9s %9.3f %12.3f %9.3f %7s %9.3f\n", "between", "", "", rest, outside, outside, "", rest);
  fprintf(out, "%-12s %7s %9s %9.3f %12.3f %9.3f %5.1f %% %9.3f\n", "all", "", "", all, processor, most,
          all > 0 ? 100 * (busy + rest) / (all * count) : 100.0, serial + rest);
}
