/* Sampled runs: how much of a stage is done, what its records hold, and what is counted. Without time for samples exactly one tile is done. */
#define OWN_MAIN
#include "../../tools/test.h"

#include "kapitza/parallel.h"

enum { TILES = 40 };

static int64_t done;

/* Record: the tile's number, and 1. */
static kz_status work(void *context, int64_t tile, void *record) {
  (void)context;
  ((int64_t *)record)[0] = tile;
  ((int64_t *)record)[1] = 1;
  done++;
  return KZ_OK;
}

/* A tile of some length of time: 1 ms, and 20 ms more for the first one. */
static kz_status take_time(void *context, int64_t tile, void *record) {
  const double begin = kz_processor_clock(), long_enough = done == 0 ? 0.021 : 0.001;
  while (kz_processor_clock() - begin < long_enough) continue;
  return work(context, tile, record);
}

/* Local record: its bytes, and the tile's number. */
static kz_status work_locally(void *context, int64_t tile, void *record) {
  (void)context;
  ((uint64_t *)record)[0] = 2 * sizeof(uint64_t);
  ((uint64_t *)record)[1] = (uint64_t)tile;
  return KZ_OK;
}

static kz_status make(void *context, const kz_local_record *piece, void *message, size_t *bytes) {
  (void)context;
  *(int64_t *)message = piece->tile;
  *bytes = sizeof piece->tile;
  return KZ_OK;
}

static kz_status take(void *context, const void *message, size_t bytes) {
  int64_t *taken = context;
  taken[*(const int64_t *)message] += bytes == sizeof(int64_t);
  return KZ_OK;
}

static int begin(void **state) {
  (void)state;
  done = 0;
  return 0;
}

/* Until it is over, the patience lets one tile of each stage be done. */
static kz_sampling impatient(void) {
  kz_sampling sampling;
  kz_sampling_begin(&sampling, 1000);
  sampling.until = 0;
  return sampling;
}

TEST(test_other_records_are_copies) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2];
  const kz_stage stage = kz_stage_for_all("copies", TILES, sizeof *record, work, NULL);
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_OK);
  assert_int_equal(done, 1);
  for (int i = 0; i < TILES; i++) {
    assert_int_equal(record[i][0], record[0][0]);
    assert_int_equal(record[i][1], 1);
  }
  assert_true(kz_sampling_stands_for(&run) == TILES);
}

TEST(test_records_of_a_collective_stage_stay_empty) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2], filled = 0;
  kz_stage stage = kz_stage_for_all("collective", TILES, sizeof *record, work, NULL);
  stage.collective = true;
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_OK);
  for (int i = 0; i < TILES; i++) filled += record[i][1];
  assert_int_equal(filled, 1);
}

TEST(test_whole_stages_are_done_whole) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2];
  kz_stage stage = kz_stage_for_all("whole", TILES, sizeof *record, work, NULL);
  stage.whole = true;
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_OK);
  assert_int_equal(done, TILES);
  for (int i = 0; i < TILES; i++) assert_int_equal(record[i][0], i);
  assert_true(kz_sampling_stands_for(&run) == 1);
}

/* With enough time everything is done, once, and nothing is counted that was not. */
TEST(test_short_stages_are_done_whole) {
  kz_sampling sampling;
  kz_sampling_begin(&sampling, 1000);
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2];
  const kz_stage stage = kz_stage_for_all("short", TILES, sizeof *record, work, NULL);
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_OK);
  assert_int_equal(done, TILES);
  for (int i = 0; i < TILES; i++) assert_int_equal(record[i][0], i);
  assert_true(sampling.counted == 0);
}

/* What the first tile sets up is counted once, the rest for all tiles and as often as the weight says: 20 ms + 2 * 40 * 1 ms. The clock may
 * be late, never early. */
TEST(test_a_set_up_is_counted_once) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2];
  sampling.until = kz_processor_clock() + 5 * 0.025; /* the stage takes a fifth of it */
  const kz_stage stage = kz_stage_for_all("set up", TILES, sizeof *record, take_time, NULL);
  kz_sampling_weigh(&run, 2);
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_OK);
  kz_sampling_weigh(&run, 0.5);
  assert_true(sampling.weight == 1);
  assert_true(done < TILES);
  assert_true(kz_sampling_seconds(&sampling) > 0.095);
}

TEST(test_without_patience_a_run_stops) {
  kz_sampling sampling;
  kz_sampling_begin(&sampling, -1);
  const kz_run run = {.sample = &sampling};
  int64_t record[TILES][2];
  const kz_stage stage = kz_stage_for_all("late", TILES, sizeof *record, work, NULL);
  assert_int_equal(kz_stage_run(&run, &stage, record), KZ_STOPPED);
  assert_int_equal(done, 0);
  kz_message_clear();
}

TEST(test_a_loop_ends_when_enough_is_seen) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling}, real = {NULL};
  const kz_sampling_mark mark = kz_sampling_mark_now(&run);
  const double before = kz_sampling_seconds(&sampling);
  assert_false(kz_sampling_enough(&run, &mark, 0)); /* a first step is always done */
  while (kz_sampling_seconds(&sampling) - before < 0.01) continue;
  assert_true(kz_sampling_enough(&run, &mark, 0.1));
  assert_true(kz_sampling_seconds(&sampling) - before >= 0.1);
  assert_false(kz_sampling_enough(&real, &mark, 0.1));
}

/* Records that stay where they were made: with one of 40 the file takes 40 times what that one takes. Without a sample all are delivered. */
TEST(test_local_records) {
  kz_sampling sampling = impatient();
  const kz_run run = {.sample = &sampling}, alone = {NULL};
  for (int sampled = 0; sampled < 2; sampled++) {
    kz_local_records pieces = {0};
    int64_t taken[TILES] = {0}, sum = 0;
    const kz_stage stage = {
        .name = "local", .n_tiles = TILES, .record_bytes = 4 * sizeof(uint64_t), .work = work_locally, .local = &pieces};
    const kz_delivery delivery = {.name = "mail", .message_bytes = 64, .make = make, .take = take, .context = taken};
    assert_int_equal(kz_stage_run(sampled ? &run : &alone, &stage, NULL), KZ_OK);
    assert_int_equal(kz_local_records_deliver(sampled ? &run : &alone, &pieces, &delivery), KZ_OK);
    for (int i = 0; i < TILES; i++) sum += taken[i];
    assert_int_equal(sum, sampled ? 1 : TILES);
    assert_true(pieces.stands_for == (sampled ? TILES : 0));
    kz_local_records_free(&pieces);
  }
  assert_true(sampling.weight == 1);
}

int main(void) {
  for (size_t i = 0; i < test_count; i++) all_tests[i].setup_func = begin;
  return run_all_tests(NULL, NULL);
}
