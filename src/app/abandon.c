/* The end of a rank that cannot go on to the next agreement with the others: memory that ran out in a Fortran layer, a
 * library that aborts or exits, a stop request amid work that takes too long. It says so in one line, removes the half
 * file and ends all ranks. */
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <unistd.h>

#include "app.h"

static struct {
  bool armed;
  int rank; /* as the launcher gives it */
  kz_run run;
  char part[PATH_MAX + 16]; /* the half file; "" = there is none yet */
} here;

/* One rank alone removes the half file and prints the line. */
static bool abandon_prints(void) {
  return !here.part[0] || unlink(here.part) == 0 || errno != ENOENT;
}

/* A line built with calls that a signal handler may make: no stream, no memory. */
typedef struct {
  char text[PATH_MAX + 256];
  size_t length;
} line;

static void abandon_append(line *l, const char *text) {
  for (; *text && l->length + 1 < sizeof l->text; text++) l->text[l->length++] = *text;
  l->text[l->length] = '\0';
}

static void append_number(line *l, unsigned number) {
  char digits[16] = "";
  size_t first = sizeof digits - 1;
  do digits[--first] = (char)('0' + number % 10);
  while (number /= 10);
  abandon_append(l, digits + first);
}

/* "kapitza: WHAT; finished work is in ...", or OTHERWISE. */
static void print_line(const char *what, const char *otherwise) {
  line l = {.length = 0};
  const char *saved = kz_checkpoint_saved(here.run.checkpoint);
  here.armed = false;
  kz_checkpoint_forget(here.run.checkpoint);
  abandon_append(&l, "kapitza: ");
  abandon_append(&l, what);
  abandon_append(&l, saved ? "; finished work is in " : otherwise);
  abandon_append(&l, saved ? saved : "");
  abandon_append(&l, saved ? ", --resume goes on from it\n" : "\n");
  if (!abandon_prints())
    sleep(1); /* the end of this rank may end them all, and the line must come first */
  else if (write(STDERR_FILENO, l.text, l.length) < 0)
    return; /* a failed write cannot be reported */
}

static void print_error(const char *what) {
  line l = {.length = 0};
  abandon_append(&l, "error: ");
  abandon_append(&l, what);
  abandon_append(&l, " on rank ");
  append_number(&l, here.rank > 0 ? (unsigned)here.rank : 0);
  print_line(l.text, "");
}

static void abandon_leave(const char *what) {
  print_error(what);
  kz_ranks_abandon(here.run.ranks, KZ_FAILED);
}

static void without_memory(void) {
  abandon_leave("memory ran out");
}

/* Libraries print their own words, then exit (gfortran's) or abort (FFTW). */
static const char LIBRARY_ENDED[] = "a library ended the program, probably because memory ran out,";

static void at_exit(void) {
  if (here.armed) abandon_leave(LIBRARY_ENDED);
}

/* MPI could wait for the allocator that has just aborted: the launcher ends the other ranks. */
static void at_abort(int number) {
  (void)number;
  if (here.armed) print_error(LIBRARY_ENDED);
  _exit(KZ_FAILED);
}

/* All ranks have had the request, or the launcher ends those that have not. */
static void abandon_overdue(const char *reason) {
  if (!here.part[0] && here.rank > 0) sleep(1); /* no file yet: all ranks come here, rank 0 prints */
  if (here.part[0] || here.rank <= 0) print_line(reason, "; nothing was saved");
  _exit(KZ_STOPPED);
}

void kz_abandon_arm(void) {
  here.rank = kz_launch_rank(); /* looks into the environment, which a signal handler must not do */
  here.armed = true;
  kz_memory_on_failure(without_memory);
  atexit(at_exit);
  signal(SIGABRT, at_abort);
}

void kz_abandon_run(const kz_run *run, const char *path) {
  here.run = *run;
  here.part[0] = '\0';
  if (path) snprintf(here.part, sizeof here.part, "%s.part", path);
  if (run->ranks) kz_ranks_set_overdue(run->ranks, abandon_overdue);
}

void kz_abandon_disarm(void) {
  here.armed = false;
}
