/* Output that a person sees: a bar on a terminal, lines elsewhere, nothing where nothing is asked for. */
#define _GNU_SOURCE
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>

#include "ranks.h"

static char shown[100000];
static int here = -1, there = -1; /* ends of a terminal whose foreground is this process; -1: no terminals */

/* The clock of this process stands still but for what its work adds, in s: a busy machine changes no line. */
static double passed = 1;

int clock_gettime(clockid_t clock, struct timespec *now) {
  (void)clock;
  now->tv_sec = (time_t)passed;
  now->tv_nsec = (long)(1e9 * (passed - (double)now->tv_sec));
  return 0;
}

static kz_status progress_fill(void *context, int64_t tile, void *bytes) {
  (void)context;
  (void)bytes;
  (void)tile;
  passed += 0.02;
  return KZ_OK;
}

static kz_status run_cells(int64_t n_tiles) {
  const kz_stage stage = {.name = "cells", .n_tiles = n_tiles, .record_bytes = 1, .work = progress_fill};
  char records[100];
  return run_stage(&stage, records);
}

/* Two stages of half a second and more, after which as much is left. */
static kz_status run_chain(int64_t n_stages) {
  kz_serial_progress *chain = kz_serial_progress_begin(&(kz_run){.ranks = ranks}, "reference");
  kz_status status = KZ_OK;
  for (int64_t i = 0; status == KZ_OK && i < n_stages; i++) {
    passed += 0.6;
    status = run_cells(1);
    kz_serial_progress_show(chain, 0.6 * (double)(i + 1));
  }
  kz_serial_progress_end(chain, status == KZ_OK);
  return status;
}

/* Runs stages with stderr at `end`; what came out is read from `file` into shown. */
static void progress_show(kz_progress progress, kz_status (*run)(int64_t), int64_t n, int end, int file) {
  const int before = dup(STDERR_FILENO);
  dup2(end, STDERR_FILENO);
  kz_ranks_set_progress(ranks, progress);
  const kz_status status = run(n);
  dup2(before, STDERR_FILENO);
  close(before);
  assert_int_equal(status, KZ_OK);
  struct pollfd waiting = {.fd = file, .events = POLLIN};
  size_t bytes = 0;
  while (poll(&waiting, 1, 300) > 0) { /* a terminal hands its bytes on in pieces */
    const ssize_t got = read(file, shown + bytes, sizeof shown - 1 - bytes);
    if (got <= 0) break;
    bytes += (size_t)got;
  }
  shown[bytes] = '\0';
}

static void show_in_pipe(kz_progress progress, kz_status (*run)(int64_t), int64_t n) {
  int ends[2];
  assert_int_equal(pipe(ends), 0);
  progress_show(progress, run, n, ends[1], ends[0]);
  close(ends[0]);
  close(ends[1]);
}

/* Skips the test on a machine without pseudo-terminals: a bare chroot has none. */
static void show_on_terminal(kz_progress progress, int64_t n_tiles) {
  if (here < 0) skip();
  progress_show(progress, run_cells, n_tiles, there, here);
}

TEST(a_terminal_gets_a_bar) {
  show_on_terminal(KZ_PROGRESS_AUTO, 60);
  assert_non_null(strstr(shown, "\rcells"));
  assert_non_null(strstr(shown, "###"));
  assert_string_equal(shown + strlen(shown) - 4, "\r\033[K"); /* the line is clean again */
}

TEST(a_file_gets_lines) {
  show_in_pipe(KZ_PROGRESS_ALWAYS, run_cells, 70);
  assert_non_null(strstr(shown, "kapitza: cells: 100 %"));
  assert_non_null(strstr(shown, "ranks idle "));
  assert_ptr_not_equal(strstr(shown, "kapitza: cells:"), strstr(shown, "kapitza: cells: 100 %"));
  assert_null(strchr(shown, '\r'));
}

/* Half of the time has passed after the second one, a second after the first line was due. */
TEST(a_chain_of_stages_is_shown_as_one) {
  show_in_pipe(KZ_PROGRESS_ALWAYS, run_chain, 2);
  assert_non_null(strstr(shown, "kapitza: reference: 51 %, 0:01, 0:01 left\n"));
  assert_non_null(strstr(shown, "kapitza: reference: 100 %, 0:01"));
  assert_null(strstr(shown, "cells"));
}

TEST(nothing_is_nothing) {
  show_in_pipe(KZ_PROGRESS_AUTO, run_cells, 60); /* over before the first line is due */
  assert_string_equal(shown, "");
  show_in_pipe(KZ_PROGRESS_ALWAYS, run_cells, 1);
  assert_string_equal(shown, "");
}

TEST(a_terminal_is_left_alone_too) {
  show_on_terminal(KZ_PROGRESS_NEVER, 60);
  assert_string_equal(shown, "");
  show_on_terminal(KZ_PROGRESS_AUTO, 5);
  assert_string_equal(shown, "");
}

/* Another group has the terminal, which stops whoever else writes to it (stty tostop): the stage ends all the same,
 * without a bar. */
TEST(a_terminal_of_others_is_left_alone) {
  if (here < 0) skip();
  const pid_t other = fork();
  if (other == 0) pause();
  struct termios settings;
  assert_int_equal(setpgid(other, other) | tcgetattr(there, &settings), 0);
  settings.c_lflag |= TOSTOP;
  assert_int_equal(tcsetattr(there, TCSANOW, &settings) | tcsetpgrp(there, other), 0);
  progress_show(KZ_PROGRESS_AUTO, run_cells, 60, there, here);
  kill(other, SIGKILL);
  waitpid(other, NULL, 0);
  assert_int_equal(tcsetpgrp(there, getpgrp()), 0); /* allowed in the background, since SIGTTOU is ignored */
  assert_string_equal(shown, "");
}

/* Continues in a session of its own, in the foreground of its terminal; the first process returns its status. */
static void take_terminal(void) {
  const pid_t second = fork();
  if (second > 0) {
    int status = 1;
    waitpid(second, &status, 0);
    exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
  }
  signal(SIGHUP, SIG_IGN);
  if (second == 0 && setsid() > 0 && openpty(&here, &there, NULL, NULL, NULL) == 0 && ioctl(there, TIOCSCTTY, 0) != 0)
    here = -1;
}

int main(void) {
  take_terminal();
  if (unsetenv("OMPI_COMM_WORLD_RANK") != 0) return 1;
  return run_ranks();
}
