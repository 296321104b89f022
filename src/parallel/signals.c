/* Signals that ask for a stop. The handler notes the signal; the stage asks between two tiles. If a tile lasts too
 * long, an alarm ends the run. */
#include <signal.h>
#include <unistd.h>

#include "ranks.h"

static const struct {
  int number;
  const char *reason;
} STOP_SIGNALS[] = {{SIGUSR1, "stopped by SIGUSR1"},
                    {SIGUSR2, "stopped by SIGUSR2"},
                    {SIGXCPU, "stopped by SIGXCPU"},
                    {SIGTERM, "stopped by SIGTERM"},
                    {SIGINT, "stopped by SIGINT"}};
enum { N_STOP_SIGNALS = sizeof STOP_SIGNALS / sizeof *STOP_SIGNALS };

enum { GRACE_SECONDS = 6, LONGEST_ALARM = 1 << 30 }; /* s */

static volatile sig_atomic_t caught;
static void (*volatile overdue)(const char *reason);

const char *kz_signals_caught(void) {
  const int number = caught;
  for (int i = 0; i < N_STOP_SIGNALS; ++i)
    if (STOP_SIGNALS[i].number == number) return STOP_SIGNALS[i].reason;
  return NULL;
}

/* Sets the alarm in `seconds`, unless it is set to an earlier time. */
static void set_alarm(unsigned seconds) {
  const unsigned left = alarm(seconds);
  if (left > 0 && left < seconds) alarm(left);
}

static void record_signal(int number) {
  caught = number;
  if (overdue) set_alarm(GRACE_SECONDS);
}

static void end_overdue(int number) {
  (void)number;
  const char *reason = kz_signals_caught();
  if (overdue) overdue(reason ? reason : "stopped by the time limit");
}

static void set_handler(int number, void (*handler)(int)) {
  struct sigaction action = {.sa_handler = handler, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, NULL);
}

/* True if a signal was ignored at the start (trap '' INT), which is kept. */
static bool is_ignored(int number) {
  struct sigaction present;
  return sigaction(number, NULL, &present) == 0 && present.sa_handler == SIG_IGN;
}

void kz_signals_catch(void) {
  static bool known, ignored[N_STOP_SIGNALS]; /* before MPI, which may have handlers of its own */
  for (int i = 0; !known && i < N_STOP_SIGNALS; ++i) ignored[i] = is_ignored(STOP_SIGNALS[i].number);
  known = true;
  for (int i = 0; i < N_STOP_SIGNALS; ++i) set_handler(STOP_SIGNALS[i].number, ignored[i] ? SIG_IGN : record_signal);
  set_handler(SIGALRM, end_overdue);
  set_handler(SIGXFSZ, SIG_IGN); /* a write beyond the size limit shall return EFBIG */
  set_handler(SIGTTOU, SIG_IGN); /* progress must not stop the program on a terminal with stty tostop */
  set_handler(SIGPIPE, SIG_IGN); /* a closed progress stream is no reason to stop */
}

void kz_ranks_set_overdue(kz_ranks *ranks, void (*leave)(const char *reason)) {
  overdue = leave;
  if (!leave) alarm(0);
  if (leave && caught) set_alarm(GRACE_SECONDS);
  if (leave && ranks->limit > 0)
    set_alarm((unsigned)(ranks->limit < LONGEST_ALARM ? ranks->limit + 1 : LONGEST_ALARM) + GRACE_SECONDS);
}
