/* Checkpoints: finished work is used again, damaged work is done again, foreign work is refused. */
#include <fcntl.h>
#include <mpi.h>
#include <sys/stat.h>

#include "ranks.h"

enum { N_TILES = 40, N_BYTES = 5000, PAGE = 4096, SLOT = 2 * PAGE, FIRST_SLOT = 2 * PAGE };
static const char FINGERPRINT[] = "version: 1\nk: 0.25\nsteps: 24\n";
static char path[64];
static unsigned char records[N_TILES][N_BYTES];

typedef struct {
  int64_t done, failing;
} job;

static kz_status checkpoint_fill(void *context, int64_t tile, void *bytes) {
  job *j = context;
  if (tile == j->failing) return kz_fail(KZ_FAILED, "tile %lld fails", (long long)tile);
  for (int i = 0; i < N_BYTES; ++i) ((unsigned char *)bytes)[i] = (unsigned char)(tile * 31 + i * 7 + 1);
  ++j->done;
  pause_for(0.0005);
  return KZ_OK;
}

static bool checkpoint_first(void) {
  return kz_rank(ranks) == 0;
}

static int64_t checkpoint_sum(int64_t mine) {
  int64_t all = -1;
  MPI_Allreduce(&mine, &all, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

static kz_status run_named(const char *name, job *j) {
  const kz_stage stage = {.name = name,
                          .n_tiles = N_TILES,
                          .record_bytes = N_BYTES,
                          .work = checkpoint_fill,
                          .context = j,
                          .keep = true,
                          .everywhere = true};
  memset(records, 0, sizeof records);
  return run_stage(&stage, records);
}

static bool is_right(void) {
  for (int t = 0; t < N_TILES; ++t)
    for (int i = 0; i < N_BYTES; ++i)
      if (records[t][i] != (unsigned char)(t * 31 + i * 7 + 1)) return false;
  return true;
}

static kz_status open_with(const char *fingerprint, bool checkpoint_resume, bool force) {
  const kz_checkpoint_plan plan = {
      .path = path, .fingerprint = fingerprint, .resume = checkpoint_resume, .force = force};
  return open_checkpoint(&plan);
}

/* A run that does some tiles and fails; how many it did. A checkpoint stays where it did any. */
static int64_t leave_partial(int64_t failing) {
  job j = {.failing = failing};
  assert_all(open_with(FINGERPRINT, false, true) == KZ_OK);
  assert_all(run_named("first", &j) == (failing < 0 ? KZ_OK : KZ_FAILED));
  assert_all(close_checkpoint(false) == KZ_OK);
  const int64_t done = checkpoint_sum(j.done);
  assert_all(!checkpoint_first() || (access(path, R_OK) == 0) == (done > 0));
  return done;
}

/* A resumed run to the end; how many tiles it did. */
static int64_t checkpoint_resume_of(void) {
  job j = {.failing = -1};
  assert_all(open_with(FINGERPRINT, true, false) == KZ_OK);
  assert_all(run_named("first", &j) == KZ_OK);
  assert_all(is_right());
  assert_all(close_checkpoint(true) == KZ_OK);
  assert_all(!checkpoint_first() || access(path, F_OK) != 0);
  return checkpoint_sum(j.done);
}

/* One bit of the file turned over, on rank 0, seen by all. */
static void checkpoint_flip(long offset) {
  unsigned char byte = 0;
  if (checkpoint_first()) {
    FILE *file = fopen(path, "r+b");
    fseek(file, offset, SEEK_SET);
    if (fread(&byte, 1, 1, file) != 1) byte = 0;
    byte ^= 4;
    fseek(file, offset, SEEK_SET);
    fwrite(&byte, 1, 1, file);
    fclose(file);
  }
  kz_ranks_broadcast(ranks, &byte, 1);
}

TEST(finished_tiles_are_not_done_again) {
  for (int64_t failing = 0; failing < N_TILES; failing += 13) {
    const int64_t done = leave_partial(failing);
    assert_all(checkpoint_resume_of() == N_TILES - done);
  }
  assert_all(leave_partial(-1) == N_TILES);
  assert_all(checkpoint_resume_of() == 0);
}

TEST(resume_without_a_file_starts_anew) {
  assert_all(checkpoint_resume_of() == N_TILES);
  if (checkpoint_first()) fclose(fopen(path, "w")); /* killed before the header was there */
  assert_all(checkpoint_resume_of() == N_TILES);
}

TEST(a_flipped_bit_is_done_again) {
  const long offsets[] = {0, 1, 9, 16, 17, 2000, 16 + N_BYTES - 1}; /* Offsets in a slot: tile, checksum, record */
  for (size_t i = 0; i < sizeof offsets / sizeof *offsets; ++i) {
    leave_partial(-1);
    checkpoint_flip(FIRST_SLOT + 7 * SLOT + offsets[i]);
    assert_all(checkpoint_resume_of() == 1);
  }
  leave_partial(-1);
  checkpoint_flip(FIRST_SLOT + SLOT - 1); /* padding means nothing */
  assert_all(checkpoint_resume_of() == 0);
}

TEST(a_damaged_section_is_done_again) {
  leave_partial(-1);
  checkpoint_flip(PAGE + 12);
  assert_all(checkpoint_resume_of() == N_TILES);
}

TEST(a_short_file_is_done_again_or_refused) {
  for (int kept = 0; kept < N_TILES; kept += 11) {
    leave_partial(-1);
    if (checkpoint_first() && truncate(path, FIRST_SLOT + kept * SLOT + 100) != 0) perror("truncate");
    assert_all(checkpoint_resume_of() == N_TILES - kept);
  }
  leave_partial(-1);
  if (checkpoint_first() && truncate(path, 50) != 0) perror("truncate");
  assert_all(open_with(FINGERPRINT, true, false) == KZ_REFUSED);
  assert_all(!checkpoint_first() || unlink(path) == 0);
}

TEST(a_damaged_header_is_refused) {
  const long offsets[] = {0, 3, 8, 17, 25, 40};
  for (size_t i = 0; i < sizeof offsets / sizeof *offsets; ++i) {
    leave_partial(3);
    checkpoint_flip(offsets[i]);
    const kz_status status = open_with(FINGERPRINT, true, false);
    assert_all(status == KZ_REFUSED && strstr(kz_message(), path) && strstr(kz_message(), "damaged"));
    assert_all(!checkpoint_first() || access(path, F_OK) == 0);
  }
  leave_partial(3); /* --force replaces it */
  assert_all(checkpoint_resume_of() > 0);
}

TEST(another_run_is_refused) {
  const int64_t done = leave_partial(20);
  kz_status status = open_with("version: 1\nk: 0.26\nsteps: 24\n", true, false);
  assert_all(status == KZ_REFUSED && strstr(kz_message(), "\"k: 0.25\"") && strstr(kz_message(), "\"k: 0.26\""));
  status = open_with("version: 1\nk: 0.25\n", true, false);
  assert_all(status == KZ_REFUSED && strstr(kz_message(), "\"steps: 24\"") && strstr(kz_message(), "\"nothing\""));
  status = open_with("version: 1\nk: 0.25\nsteps: 24\nmore: 1\n", true, false);
  assert_all(status == KZ_REFUSED && strstr(kz_message(), "\"more: 1\""));
  assert_all(checkpoint_resume_of() == N_TILES - done);
}

TEST(an_existing_file_needs_a_word) {
  leave_partial(20);
  const kz_status status = open_with(FINGERPRINT, false, false);
  assert_all(status == KZ_REFUSED && strstr(kz_message(), "--resume") && strstr(kz_message(), "--force"));
  job j = {.failing = -1};
  assert_all(open_with(FINGERPRINT, false, true) == KZ_OK);
  assert_all(run_named("first", &j) == KZ_OK && is_right());
  assert_all(checkpoint_sum(j.done) == N_TILES);
  assert_all(close_checkpoint(true) == KZ_OK);
}

TEST(sections_follow_each_other) {
  job j = {.failing = -1}, k = {.failing = 30}, again = {.failing = -1};
  assert_all(open_with(FINGERPRINT, false, true) == KZ_OK);
  assert_all(run_named("first", &j) == KZ_OK);
  assert_all(run_named("second", &k) == KZ_FAILED);
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(open_with(FINGERPRINT, true, false) == KZ_OK);
  assert_all(run_named("first", &again) == KZ_OK && is_right());
  assert_all(checkpoint_sum(again.done) == 0);
  assert_all(run_named("second", &again) == KZ_OK && is_right());
  assert_all(checkpoint_sum(again.done) == N_TILES - checkpoint_sum(k.done));
  assert_all(run_named("third", &again) == KZ_OK && is_right());
  assert_all(close_checkpoint(true) == KZ_OK);
}

TEST(nothing_kept_leaves_nothing) {
  assert_all(open_with(FINGERPRINT, false, false) == KZ_OK);
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(!checkpoint_first() || access(path, F_OK) != 0);
  assert_all(close_checkpoint(true) == KZ_OK);
}

TEST(a_wrong_path_is_refused) {
  const kz_checkpoint_plan missing = {.path = "/proc/nowhere/a.checkpoint", .fingerprint = ""};
  const kz_checkpoint_plan device = {.path = "/dev/null", .fingerprint = "", .resume = true};
  const kz_checkpoint_plan directory = {.path = "/dev", .fingerprint = "", .resume = true};
  assert_all(open_checkpoint(&missing) == KZ_REFUSED);
  assert_all(open_checkpoint(&device) == KZ_REFUSED);
  assert_all(open_checkpoint(&directory) == KZ_REFUSED);
}

/* A link in the checkpoint's place, where it may lead nowhere, is neither followed nor removed. */
TEST(a_link_is_refused) {
  const char *const targets[] = {"/nowhere/at/all", "/dev/null", path};
  for (size_t i = 0; i < sizeof targets / sizeof *targets; ++i) {
    assert_all(!checkpoint_first() || symlink(targets[i], path) == 0);
    assert_all(open_with(FINGERPRINT, true, false) == KZ_REFUSED && strstr(kz_message(), "a link"));
    assert_all(open_with(FINGERPRINT, false, true) == KZ_REFUSED);
    if (checkpoint_first()) kz_checkpoint_clear(path, FINGERPRINT);
    assert_all(!checkpoint_first() || unlink(path) == 0);
  }
}

TEST(only_the_own_checkpoint_is_cleared) {
  leave_partial(20);
  if (checkpoint_first()) kz_checkpoint_clear(path, "version: 1\nk: 0.26\nsteps: 24\n");
  assert_all(!checkpoint_first() || access(path, F_OK) == 0);
  assert_all(open_with(FINGERPRINT, true, false) == KZ_OK);
  if (checkpoint_first()) kz_checkpoint_clear(path, FINGERPRINT); /* it is in use */
  assert_all(!checkpoint_first() || access(path, F_OK) == 0);
  assert_all(close_checkpoint(false) == KZ_OK);
  if (checkpoint_first()) kz_checkpoint_clear(path, FINGERPRINT);
  assert_all(!checkpoint_first() || access(path, F_OK) != 0);
}

TEST(a_run_without_records_leaves_nothing) {
  job j = {.failing = 0};
  assert_all(open_with(FINGERPRINT, false, false) == KZ_OK);
  assert_all(kz_ranks_count(ranks) > 1 || run_named("first", &j) == KZ_FAILED);
  assert_all(!checkpoint_first() || access(path, F_OK) == 0);
  assert_all(close_checkpoint(false) == KZ_OK);
  assert_all(!checkpoint_first() || access(path, F_OK) != 0);
}

static kz_status remove_and_fill(void *context, int64_t tile, void *bytes) {
  if (tile == N_TILES / 2) unlink(path);
  return checkpoint_fill(context, tile, bytes);
}

TEST(a_removed_file_is_noticed) {
  job j = {.failing = -1};
  kz_stage stage = {.name = "first",
                    .n_tiles = N_TILES,
                    .record_bytes = N_BYTES,
                    .work = remove_and_fill,
                    .context = &j,
                    .keep = true};
  assert_all(open_with(FINGERPRINT, false, true) == KZ_OK);
  const kz_status status = run_stage(&stage, records);
  assert_all(status == KZ_FAILED && strstr(kz_message(), "was removed during the run"));
  assert_all(close_checkpoint(false) == KZ_FAILED);
}

TEST(too_large_for_the_disk_is_known_early) {
  job j = {.failing = -1};
  kz_stage stage = {.name = "huge",
                    .n_tiles = (int64_t)1 << 43,
                    .record_bytes = N_BYTES,
                    .work = checkpoint_fill,
                    .context = &j,
                    .keep = true};
  assert_all(open_with(FINGERPRINT, false, true) == KZ_OK);
  const kz_status status = run_stage(&stage, records);
  assert_all(status == KZ_FAILED && strstr(kz_message(), "no space"));
  assert_all(j.done == 0);
  assert_all(close_checkpoint(false) == KZ_OK);
}

int main(void) {
  return run_ranks_with_path(path, sizeof path);
}
