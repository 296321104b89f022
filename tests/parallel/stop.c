/* Requests to stop: one rank gets it, all ranks stop, nothing finished is lost. */
#include <signal.h>

#include "ranks.h"

enum { N_TILES = 400 };
static char path[64];
static int64_t records[N_TILES];
static int64_t raising = -1;

static kz_status stop_fill(void *context, int64_t tile, void *bytes) {
  ++*(int64_t *)context;
  pause_for(0.005);
  if (tile == raising && raise(SIGUSR1) != 0) return kz_fail(KZ_FAILED, "raise");
  *(int64_t *)bytes = tile + 1;
  return KZ_OK;
}

static kz_status stop_run(int64_t *done, bool keep) {
  const kz_stage stage = {.name = "cells",
                          .n_tiles = N_TILES,
                          .record_bytes = sizeof *records,
                          .work = stop_fill,
                          .context = done,
                          .keep = keep};
  memset(records, 0, sizeof records);
  const kz_status status = run_stage(&stage, records);
  return status == KZ_STOPPED ? kz_checkpoint_stopped(checkpoint) : status;
}

static bool is_right(void) {
  for (int64_t t = 0; t < N_TILES; ++t)
    if (records[t] != t + 1) return false;
  return true;
}

TEST(the_time_limit_stops_and_resumes) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "k: 1\n", .resume = true};
  int64_t done = 0, more = 0;
  kz_ranks_set_time_limit(ranks, 0.05);
  pause_for(0.05);
  assert_all(open_checkpoint(&plan) == KZ_OK);
  assert_all(stop_run(&done, true) == KZ_STOPPED && done == 0 && strstr(kz_message(), "nothing was saved"));
  assert_all(close_checkpoint(false) == KZ_OK);
  kz_ranks_set_time_limit(ranks, 0);
  assert_all(open_checkpoint(&plan) == KZ_OK);
  assert_all(stop_run(&more, true) == KZ_OK && (kz_rank(ranks) != 0 || is_right()));
  assert_all(close_checkpoint(true) == KZ_OK);
}

/* From here on the request stays. */
TEST(a_signal_to_one_rank_stops_all) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "k: 1\n"};
  int64_t done = 0;
  raising = 20;
  assert_all(open_checkpoint(&plan) == KZ_OK);
  const kz_status status = stop_run(&done, true);
  assert_all(status == KZ_STOPPED && strstr(kz_message(), "SIGUSR1") && strstr(kz_message(), path));
  assert_all(done < N_TILES / 4); /* the others learn of it with their next batch */
  assert_all(stop_run(&done, true) == KZ_STOPPED);
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(kz_rank(ranks) != 0 || unlink(path) == 0);
}

TEST(nothing_is_promised_where_nothing_was_kept) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "k: 1\n"};
  int64_t done = 0;
  assert_all(open_checkpoint(&plan) == KZ_OK);
  const kz_status status = stop_run(&done, false);
  assert_all(status == KZ_STOPPED && strstr(kz_message(), path) == NULL && strstr(kz_message(), "nothing was saved"));
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(access(path, F_OK) != 0);
}

int main(void) {
  return run_ranks_with_path(path, sizeof path);
}
