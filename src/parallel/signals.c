/* Signals that ask for a stop. The handler notes the signal; the stage asks between two tiles. */
#include <signal.h>

#include "team.h"

static const struct {
  int number;
  const char *name;
} STOP_SIGNALS[] = {{SIGUSR1, "SIGUSR1"}, {SIGTERM, "SIGTERM"}, {SIGINT, "SIGINT"}};
enum { N_STOP_SIGNALS = sizeof STOP_SIGNALS / sizeof *STOP_SIGNALS };

static volatile sig_atomic_t caught;

static void note(int number) {
  caught = number;
}

void kz_signals_catch(void) {
  struct sigaction action = {.sa_handler = note, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < N_STOP_SIGNALS; ++i) sigaction(STOP_SIGNALS[i].number, &action, NULL);
  action.sa_handler = SIG_IGN; /* a write beyond the size limit shall return EFBIG */
  sigaction(SIGXFSZ, &action, NULL);
}

const char *kz_signals_caught(void) {
  const int number = caught;
  for (int i = 0; i < N_STOP_SIGNALS; ++i)
    if (STOP_SIGNALS[i].number == number) return STOP_SIGNALS[i].name;
  return NULL;
}
