/* Shares of tiles: batches shrink, nobody gets more than a share, the last ones go to the first who is done. */
#include "../tools/test.h"

#include "schedule.h"

enum { RANKS = 4 };
static const double FAST = 1e-4, SLOW = 1e-3; /* s a tile */

/* Four ranks, the last one ten times slower, with `left` tiles to give away. */
static kz_schedule schedule_begin(int64_t left) {
  kz_schedule schedule;
  kz_schedule_begin(&schedule, RANKS + left, RANKS);
  for (int rank = 0; rank < RANKS; ++rank) kz_schedule_note(&schedule, rank, rank == RANKS - 1 ? SLOW : FAST);
  return schedule;
}

TEST(every_tile_is_given_once_in_shrinking_batches) {
  kz_schedule schedule = schedule_begin(2000);
  int64_t next = RANKS, before = INT64_MAX, n, first, batches = 0;
  while ((n = kz_schedule_grant(&schedule, 1, false, &first)) > 0) {
    assert_true(first == next && n <= before);
    next += before = n;
    ++batches;
  }
  assert_true(next == RANKS + 2000 && before == 1 && batches < 60);
  kz_schedule_end(&schedule);
}

TEST(a_slow_rank_gets_a_tenth) {
  kz_schedule schedule = schedule_begin(2000);
  int64_t first;
  const int64_t fast = kz_schedule_grant(&schedule, 0, false, &first),
                slow = kz_schedule_grant(&schedule, 3, false, &first);
  assert_true(fast > 200 && fast < 1000 && slow >= fast / 20 && slow <= fast / 9);
  kz_schedule_end(&schedule);
}

TEST(a_batch_lasts_a_tenth_of_a_second) {
  kz_schedule schedule = schedule_begin(1000000000);
  int64_t first;
  assert_int_equal(kz_schedule_grant(&schedule, 0, false, &first), 1000);
  assert_int_equal(kz_schedule_grant(&schedule, 3, true, &first), 100);
  kz_schedule_end(&schedule);
}

TEST(who_still_works_leaves_the_last_tiles_to_others) {
  kz_schedule schedule = schedule_begin(30); /* 1 ms of all ranks, a tile of the slow one */
  int64_t first;
  assert_int_equal(kz_schedule_grant(&schedule, 3, true, &first), 0);
  assert_true(kz_schedule_grant(&schedule, 0, true, &first) > 0);
  kz_schedule_end(&schedule);
}

/* Three fast ranks do what is left in less time than the slow one needs for a tile: it gets no more. The others go on
 * to the end, also one that is slower than those that have left. */
TEST(a_slow_rank_does_not_keep_all_waiting) {
  kz_schedule schedule = schedule_begin(30);
  int64_t first, given = 0, n;
  assert_int_equal(kz_schedule_grant(&schedule, 3, false, &first), 1);
  assert_true(kz_schedule_grant(&schedule, 0, false, &first) > 3);
  assert_int_equal(kz_schedule_grant(&schedule, 3, false, &first), 0);
  assert_true(schedule.taking == 3 && schedule.rate > 2.99 / FAST && schedule.rate < 3.01 / FAST);
  kz_schedule_note(&schedule, 0, 10 * SLOW);
  assert_int_equal(kz_schedule_take(&schedule, 0), -1);
  kz_schedule_note(&schedule, 1, 100 * SLOW);
  assert_int_equal(kz_schedule_grant(&schedule, 1, false, &first), 0);
  kz_schedule_note(&schedule, 2, 1000 * SLOW);
  while ((n = kz_schedule_grant(&schedule, 2, false, &first)) > 0) given += n;
  assert_true(given > 0 && schedule.next == schedule.end && schedule.taking == 1);
  kz_schedule_end(&schedule);
}

TEST(few_tiles_are_not_asked_for) {
  kz_schedule schedule;
  int64_t first;
  kz_schedule_begin(&schedule, 3, RANKS);
  assert_int_equal(kz_schedule_grant(&schedule, 2, false, &first), 0);
  kz_schedule_end(&schedule);
}
