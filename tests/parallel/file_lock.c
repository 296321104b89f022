/* A checkpoint in use: waited for while its ranks end, refused where they do not. */
#define _GNU_SOURCE
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>

#include "ranks.h"

static char path[64];

/* A process that holds the file for a while, as an orphan of a killed run does: byte 1, shared. */
static pid_t lock_for(double seconds) {
  const int file = open(path, O_RDWR | O_CREAT, 0666);
  struct flock byte = {.l_type = F_RDLCK, .l_whence = SEEK_SET, .l_start = 1, .l_len = 1};
  if (file < 0 || fcntl(file, F_OFD_SETLK, &byte) != 0) perror(path);
  const pid_t child = fork();
  if (child == 0) {
    pause_for(seconds);
    _exit(0);
  }
  close(file);
  return child;
}

/* Opens against a process that holds the file for so long or until the end of the test; the time it took. */
static double open_against(double seconds, kz_status expected) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "k: 1\n", .resume = true};
  const double begun = kz_clock();
  const pid_t child = kz_rank(ranks) == 0 ? lock_for(seconds) : 0;
  const kz_status status = open_checkpoint(&plan);
  const double took = kz_clock() - begun;
  assert_all(status == expected && (status == KZ_OK || strstr(kz_message(), "held by another process")));
  if (child > 0) kill(child, SIGKILL), waitpid(child, NULL, 0);
  return took;
}

TEST(orphans_are_waited_for) {
  const double took = open_against(1.5, KZ_OK);
  assert_all(kz_rank(ranks) != 0 || took > 1.4);
  assert_all(close_checkpoint(true) == KZ_OK);
}

/* Alone: other ranks would wait for the first one, at work all the time. */
TEST(a_running_program_is_refused) {
  if (kz_ranks_count(ranks) > 1) return;
  assert_true(open_against(60, KZ_REFUSED) > 14.0);
}

TEST(a_rank_of_this_run_holds_it) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "k: 1\n", .force = true};
  struct flock byte = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = 1, .l_len = 1};
  assert_all(open_checkpoint(&plan) == KZ_OK);
  const int other = open(path, O_RDWR);
  assert_all(fcntl(other, F_OFD_SETLK, &byte) == -1);
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(fcntl(other, F_OFD_GETLK, &byte) == 0 && byte.l_type == F_UNLCK);
  close(other);
}

int main(void) {
  return run_ranks_with_path(path, sizeof path);
}
