/* Stages: every record arrives, whoever did it; a failure ends all ranks. */
#include <fcntl.h>

#include "ranks.h"

enum { N_TILES = 200, N_NUMBERS = 9 };

typedef struct {
  int64_t number[N_NUMBERS];
  char tail[3]; /* a record whose size is no multiple of anything */
} record;

typedef struct {
  int64_t done;    /* tiles of this rank */
  int64_t failing; /* tile that fails, -1: none */
  double seconds;  /* Seconds of a tile */
  int dirty;       /* records that were not zero at the start */
} job;

static kz_status stage_fill(void *context, int64_t tile, void *bytes) {
  job *j = context;
  record *r = bytes;
  for (size_t i = 0; i < sizeof *r; ++i) j->dirty += ((char *)bytes)[i] != 0;
  ++j->done;
  if (j->seconds > 0) pause_for(j->seconds);
  if (tile == j->failing) return kz_fail(KZ_FAILED, "tile %lld fails", (long long)tile);
  for (int i = 0; i < N_NUMBERS; ++i) r->number[i] = tile * 100 + i;
  memcpy(r->tail, "end", 3);
  return KZ_OK;
}

static int is_right(const record *records, int64_t n_tiles) {
  for (int64_t t = 0; t < n_tiles; ++t)
    for (int i = 0; i < N_NUMBERS; ++i)
      if (records[t].number[i] != t * 100 + i || memcmp(records[t].tail, "end", 3) != 0) return 0;
  return 1;
}

static kz_stage stage_of(job *j, int64_t n_tiles, bool everywhere) {
  return (kz_stage){.name = "test",
                    .n_tiles = n_tiles,
                    .record_bytes = sizeof(record),
                    .work = stage_fill,
                    .context = j,
                    .everywhere = everywhere};
}

TEST(records_arrive_on_rank_0) {
  job j = {.failing = -1};
  const kz_stage stage = stage_of(&j, N_TILES, false);
  record *records = kz_rank(ranks) == 0 ? malloc(N_TILES * sizeof *records) : NULL;
  assert_all(run_stage(&stage, records) == KZ_OK);
  assert_all(kz_rank(ranks) != 0 || is_right(records, N_TILES));
  assert_all(j.dirty == 0);
  free(records);
}

TEST(records_arrive_everywhere) {
  job j = {.failing = -1};
  const kz_stage stage = stage_of(&j, N_TILES, true);
  static record records[N_TILES];
  for (int again = 0; again < 3; ++again) {
    memset(records, 0x55, sizeof records);
    assert_all(run_stage(&stage, records) == KZ_OK);
    assert_all(is_right(records, N_TILES));
  }
}

TEST(few_tiles_are_enough) {
  static record records[2];
  for (int64_t n = 0; n <= 2; ++n) {
    job j = {.failing = -1};
    const kz_stage stage = stage_of(&j, n, true);
    memset(records, 0, sizeof records);
    assert_all(run_stage(&stage, records) == KZ_OK);
    assert_all(is_right(records, n));
    assert_all(j.done <= n);
  }
}

TEST(all_ranks_take_part) {
  job j = {.failing = -1, .seconds = 0.005};
  const kz_stage stage = stage_of(&j, N_TILES, true);
  static record records[N_TILES];
  assert_all(run_stage(&stage, records) == KZ_OK);
  assert_all(j.done > 0 && j.done < (kz_ranks_count(ranks) == 1 ? N_TILES + 1 : N_TILES));
}

TEST(a_failing_tile_ends_all_ranks) {
  static record records[N_TILES];
  for (int64_t failing = 0; failing < N_TILES; failing += 57) {
    job j = {.failing = failing, .seconds = 0.001};
    const kz_stage stage = stage_of(&j, N_TILES, true);
    const kz_status status = run_stage(&stage, records);
    char expected[64];
    snprintf(expected, sizeof expected, "tile %lld fails", (long long)failing);
    assert_all(status == KZ_FAILED && strcmp(kz_message(), expected) == 0);
  }
  records_arrive_everywhere(NULL); /* the ranks work as before */
}

TEST(a_missing_array_ends_all_ranks) {
  job j = {.failing = -1};
  const kz_stage stage = stage_of(&j, N_TILES, false);
  assert_all(run_stage(&stage, NULL) == KZ_FAILED);
  assert_all(j.done == 0);
}

static kz_status fill_large(void *context, int64_t tile, void *bytes) {
  const size_t n = *(const size_t *)context;
  memset(bytes, (int)tile + 1, n);
  pause_for(0.1); /* every rank gets one */
  return KZ_OK;
}

TEST(records_beyond_a_message_arrive) {
  size_t n = ((size_t)6 << 20) + 7; /* larger than a block of small ones */
  const kz_stage stage = {
      .name = "large", .n_tiles = 7, .record_bytes = n, .work = fill_large, .context = &n, .everywhere = true};
  char *records = malloc(7 * n);
  assert_all(run_stage(&stage, records) == KZ_OK);
  int wrong = 0;
  for (int t = 0; t < 7; ++t) wrong += records[(size_t)t * n] != t + 1 || records[(size_t)(t + 1) * n - 1] != t + 1;
  assert_all(wrong == 0);
  free(records);
}

/* Tiles done by all ranks, as the length of a file that they share; -1: it cannot be had. */
typedef struct {
  char path[64];
  int file;
} tally;

static int64_t stage_count(const tally *t) {
  return lseek(t->file, 0, SEEK_END);
}

/* The first tile ends once all others are done, whoever has it: rank 0. */
static kz_status wait_for_others(void *context, int64_t tile, void *bytes) {
  const tally *t = context;
  const double begun = kz_clock();
  memset(bytes, 1, 1);
  while (tile == 0 && stage_count(t) < N_TILES - 1 && kz_clock() - begun < 1000) pause_for(0.001);
  if (tile == 0 && stage_count(t) < N_TILES - 1)
    return kz_fail(KZ_FAILED, "%lld tiles are done", (long long)stage_count(t));
  pause_for(0.001);
  return write(t->file, "x", 1) == 1 ? KZ_OK : kz_fail(KZ_FAILED, "no tally");
}

TEST(rank_0_answers_amid_its_own_tile) {
  if (kz_ranks_count(ranks) == 1) skip();
  tally t = {.path = "/tmp/kapitza-tally-XXXXXX"};
  t.file = kz_rank(ranks) == 0 ? mkstemp(t.path) : -1;
  kz_ranks_broadcast(ranks, t.path, sizeof t.path);
  if (kz_rank(ranks) > 0) t.file = open(t.path, O_WRONLY);
  assert_all(fcntl(t.file, F_SETFL, O_APPEND) == 0);
  const kz_stage stage = {
      .name = "wait", .n_tiles = N_TILES, .record_bytes = 1, .work = wait_for_others, .context = &t};
  char records[N_TILES];
  const kz_status status = run_stage(&stage, records);
  assert_all(kz_rank(ranks) != 0 || unlink(t.path) == 0);
  assert_all(status == KZ_OK && stage_count(&t) == N_TILES);
  close(t.file);
}

TEST(the_worst_status_wins) {
  const int last = kz_ranks_count(ranks) - 1, rank = kz_rank(ranks);
  const kz_status mine = rank == last ? kz_fail(KZ_REFUSED, "rank %d", rank) : kz_fail(KZ_STOPPED, "stop");
  const kz_status agreed = kz_ranks_agree(ranks, mine);
  char expected[32];
  snprintf(expected, sizeof expected, "rank %d", last);
  assert_all(agreed == KZ_REFUSED && strcmp(kz_message(), expected) == 0);
  assert_all(kz_ranks_agree(ranks, KZ_OK) == KZ_OK);
}

TEST(broadcast_reaches_all) {
  char text[100000];
  memset(text, kz_rank(ranks) == 0 ? 'x' : 'y', sizeof text);
  assert_all(kz_ranks_broadcast(ranks, text, sizeof text) == KZ_OK);
  assert_all(text[0] == 'x' && text[sizeof text - 1] == 'x');
}

int main(void) {
  return run_ranks();
}
