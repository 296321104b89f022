/* Progress: a live bar on a terminal, else lines. */
#include "watch.h"

#include <unistd.h>

static const double BAR_DELAY = 0.5, BAR_PERIOD = 0.2, LINE_PERIOD = 10.0, LINE_PERIOD_ALWAYS = 1.0; /* s */
enum { BAR_CELLS = 24, CLOCK_BYTES = 24 };

/* Finds the terminal; under a launcher stderr is none even if a person is watching. */
static FILE *find_terminal(kz_ranks *ranks) {
  if (isatty(STDERR_FILENO)) return stderr;
  if (!ranks->terminal && kz_launch_rank() >= 0) ranks->terminal = fopen("/dev/tty", "we");
  return ranks->terminal;
}

void kz_meter_begin(kz_meter *meter, kz_ranks *ranks, const char *name, int64_t total, int64_t first) {
  *meter = (kz_meter){.name = name, .ranks = ranks, .total = total, .first = first, .begun = kz_clock()};
  meter->log_due = meter->begun + LINE_PERIOD_ALWAYS;
  if (ranks->describe)
    ranks->describe(name, meter->words, sizeof meter->words);
  else
    snprintf(meter->words, sizeof meter->words, "%s", name);
  if (ranks->rank != 0 || ranks->progress == KZ_PROGRESS_NEVER || total < 2) return;
  FILE *terminal = find_terminal(ranks);
  const bool always = ranks->progress == KZ_PROGRESS_ALWAYS;
  meter->live = terminal != NULL;
  meter->out = terminal ? terminal : stderr;
  meter->last = always && !meter->live;
  meter->due = meter->begun + (meter->live ? BAR_DELAY : always ? LINE_PERIOD_ALWAYS : LINE_PERIOD);
}

static const char *clock_text(double seconds, char text[CLOCK_BYTES]) {
  const long long whole = (long long)(seconds + 0.5), hours = whole / 3600;
  if (hours > 0)
    snprintf(text, CLOCK_BYTES, "%lld:%02lld:%02lld", hours, whole / 60 % 60, whole % 60);
  else
    snprintf(text, CLOCK_BYTES, "%lld:%02lld", whole / 60, whole % 60);
  return text;
}

/* True if this process, or the launcher that started it in its own group, is in the foreground of the terminal. */
static bool has_terminal(FILE *terminal) {
  const pid_t foreground = tcgetpgrp(fileno(terminal));
  return foreground > 0 && (foreground == getpgrp() || (kz_launch_rank() >= 0 && foreground == getpgid(getppid())));
}

static void draw_meter(const kz_meter *meter, int64_t done, double elapsed) {
  char bar[BAR_CELLS + 1] = "", spent[CLOCK_BYTES], left[CLOCK_BYTES] = "?";
  const double share = (double)done / (double)meter->total;
  const int64_t fresh = done - meter->first;
  if (fresh > 0) clock_text(elapsed * (double)(meter->total - done) / (double)fresh, left);
  for (int i = 0; i < BAR_CELLS; ++i) bar[i] = i < share * BAR_CELLS ? '#' : '.';
  if (meter->live)
    fprintf(meter->out, "\r%-12s [%s] %3.0f %%  %s, %s left \033[K", meter->words, bar, 100 * share,
            clock_text(elapsed, spent), left);
  else
    fprintf(meter->out, "kapitza: %s: %.0f %%, %s, %s left\n", meter->words, 100 * share, clock_text(elapsed, spent),
            left);
  fflush(meter->out);
}

static void log_progress(kz_meter *meter, int64_t done, double now) {
  if (!meter->ranks->log || now < meter->log_due) return;
  meter->log_due = now + LINE_PERIOD_ALWAYS;
  fprintf(meter->ranks->log,
          "{\"event\": \"progress\", \"seconds\": %.3f, \"stage\": \"%s\", \"done\": %lld, \"total\": %lld}\n",
          now - meter->ranks->start, meter->name, (long long)done, (long long)meter->total);
  fflush(meter->ranks->log);
}

void kz_meter_show(kz_meter *meter, int64_t done) {
  if (!meter->out && !meter->ranks->log) return;
  const double now = kz_clock();
  log_progress(meter, done, now);
  if (!meter->out) return;
  if (now < meter->due) return;
  meter->due = now + (meter->live ? BAR_PERIOD : meter->last ? LINE_PERIOD_ALWAYS : LINE_PERIOD);
  if (meter->live && !has_terminal(meter->out)) return;
  meter->shown = true;
  draw_meter(meter, kz_smaller(done, meter->total), now - meter->begun);
}

void kz_meter_end(kz_meter *meter, bool complete, double idle) {
  char spent[CLOCK_BYTES];
  if (!meter->out) return;
  if (meter->live && meter->shown && has_terminal(meter->out)) fputs("\r\033[K", meter->out);
  if (meter->last && complete)
    fprintf(meter->out, "kapitza: %s: 100 %%, %s, ranks idle %.1f %%\n", meter->words,
            clock_text(kz_clock() - meter->begun, spent), 100 * idle);
  fflush(meter->out);
}

enum { SERIAL_PARTS = 1000000 };
struct kz_serial_progress {
  kz_meter meter;
};

kz_serial_progress *kz_serial_progress_begin(const kz_run *run, const char *name) {
  if (!run || !run->ranks) return NULL;
  kz_serial_progress *chain = kz_calloc(1, sizeof *chain);
  kz_meter_begin(&chain->meter, run->ranks, name, SERIAL_PARTS, 0);
  return chain;
}

void kz_serial_progress_show(kz_serial_progress *chain, double seconds_left) {
  if (!chain) return;
  const double elapsed = kz_clock() - chain->meter.begun;
  kz_meter_show(&chain->meter, (int64_t)(SERIAL_PARTS * elapsed / (elapsed + seconds_left + 1e-9)));
}

void kz_serial_progress_end(kz_serial_progress *chain, bool complete) {
  if (!chain) return;
  kz_meter_end(&chain->meter, complete, 1 - 1.0 / chain->meter.ranks->size);
  free(chain);
}
