/* Records of varying length: they stay with their ranks, survive checkpoints with holes, reach rank 0 once. */
#include <fcntl.h>
#include <mpi.h>
#include <sys/stat.h>

#include "ranks.h"

enum { N_TILES = 60, MOST = 1 << 16, PAGE = 4096 };
static char path[64];

typedef struct {
  int64_t done, failing;
  int64_t taken[N_TILES];
} job;

static size_t length_of(int64_t tile) {
  return 8 + (size_t)(tile * tile * 17 % 3000);
}

static kz_status local_records_fill(void *context, int64_t tile, void *record) {
  job *j = context;
  if (tile == j->failing) return kz_fail(KZ_FAILED, "tile %lld fails", (long long)tile);
  const uint64_t bytes = length_of(tile);
  memset(record, (int)tile + 1, bytes);
  memcpy(record, &bytes, sizeof bytes);
  ++j->done;
  pause_for(0.0005);
  return KZ_OK;
}

static kz_status local_records_run(job *j, kz_local_records *records) {
  const kz_stage stage = {.name = "records",
                          .n_tiles = N_TILES,
                          .record_bytes = MOST,
                          .work = local_records_fill,
                          .context = j,
                          .keep = true,
                          .local = records};
  return run_stage(&stage, NULL);
}

/* Every other message is too long for MPI to send it before the receiver has asked for it. */
static size_t padding_of(int64_t tile) {
  return tile % 2 ? MOST : 0;
}

/* A message: the tile, and the last byte of its record; padding. */
static kz_status local_records_make(void *context, const kz_local_record *piece, void *message, size_t *bytes) {
  const job *j = context;
  if (piece->tile == j->failing) return kz_fail(KZ_FAILED, "tile %lld fails", (long long)piece->tile);
  const int64_t facts[] = {piece->tile, (int64_t)piece->bytes, ((const unsigned char *)piece->data)[piece->bytes - 1]};
  *bytes = sizeof facts + padding_of(piece->tile);
  memcpy(message, facts, sizeof facts);
  memset((char *)message + sizeof facts, (int)piece->tile, padding_of(piece->tile));
  return KZ_OK;
}

static kz_status local_records_take(void *context, const void *message, size_t bytes) {
  job *j = context;
  int64_t facts[3];
  const unsigned char *padding = (const unsigned char *)message + sizeof facts;
  memcpy(facts, message, sizeof facts);
  const size_t n = padding_of(facts[0]);
  if (bytes != sizeof facts + n) return kz_fail(KZ_FAILED, "a message of %zu bytes", bytes);
  for (size_t i = 0; i < n; i++)
    if (padding[i] != facts[0]) return kz_fail(KZ_FAILED, "a message with other bytes");
  const int64_t last = facts[1] > 8 ? facts[0] + 1 : 0;
  if (facts[1] == (int64_t)length_of(facts[0]) && facts[2] == last) ++j->taken[facts[0]];
  return KZ_OK;
}

static kz_status local_records_deliver(job *j, const kz_local_records *records) {
  const kz_delivery delivery = {
      .name = "mail", .message_bytes = MOST + 64, .make = local_records_make, .take = local_records_take, .context = j};
  return kz_local_records_deliver(&(kz_run){.ranks = ranks}, records, &delivery);
}

static bool has_all(const job *j) {
  for (int tile = 0; tile < N_TILES && kz_rank(ranks) == 0; ++tile)
    if (j->taken[tile] != 1) return false;
  return true;
}

static void open_records(bool resume) {
  const kz_checkpoint_plan plan = {.path = path, .fingerprint = "a: 1\n", .resume = resume, .force = !resume};
  assert_all(open_checkpoint(&plan) == KZ_OK);
}

static int64_t local_records_sum(int64_t mine) {
  assert_all(kz_ranks_sum(ranks, &mine, 1) == KZ_OK);
  return mine;
}

TEST(each_piece_comes_once) {
  job j = {.failing = -1};
  kz_local_records records = {0};
  assert_all(local_records_run(&j, &records) == KZ_OK && local_records_sum(records.n) == N_TILES);
  assert_all(local_records_deliver(&j, &records) == KZ_OK && has_all(&j));
  kz_local_records_free(&records);
}

TEST(a_failure_on_the_way_reaches_all) {
  job j = {.failing = -1};
  kz_local_records records = {0};
  assert_all(local_records_run(&j, &records) == KZ_OK);
  j.failing = N_TILES / 2;
  assert_all(local_records_deliver(&j, &records) == KZ_FAILED);
  j = (job){.failing = -1};
  assert_all(local_records_deliver(&j, &records) == KZ_OK && has_all(&j));
  kz_local_records_free(&records);
}

static void local_records_spoil(int64_t tile) {
  const int file = open(path, O_WRONLY);
  const off_t slot = 2 * PAGE + tile * (off_t)(MOST + PAGE); /* header, head of the section */
  assert_all(kz_rank(ranks) != 0 || pwrite(file, "\xa5", 1, slot + 30) == 1);
  close(file);
}

TEST(finished_records_are_found_again) {
  job j = {.failing = 45};
  kz_local_records records = {0};
  open_records(false);
  assert_all(local_records_run(&j, &records) == KZ_FAILED);
  assert_all(close_checkpoint(false) == KZ_OK);
  kz_local_records_free(&records);
  const int64_t done = local_records_sum(j.done);
  local_records_spoil(7);
  struct stat facts;
  assert_all(stat(path, &facts) == 0 && facts.st_blocks * 512 < (N_TILES + 4) * 2 * PAGE && facts.st_size > 10 * MOST);
  open_records(true);
  j = (job){.failing = -1};
  assert_all(local_records_run(&j, &records) == KZ_OK && local_records_sum(j.done) == N_TILES - done + 1 &&
             local_records_sum(records.n) == N_TILES);
  assert_all(local_records_deliver(&j, &records) == KZ_OK && has_all(&j));
  assert_all(close_checkpoint(true) == KZ_OK);
  kz_local_records_free(&records);
}

int main(void) {
  return run_ranks_with_path(path, sizeof path);
}
