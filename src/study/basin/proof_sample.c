/* Random real starts of a window: what share of its area may end elsewhere than on attractors that are proved. A start is drawn to 106
 * binary digits; a square around it holds the rest of them. */
#include <stdlib.h>

#include "kapitza/analysis.h"
#include "numerics/cells.h"
#include "proof.h"

enum { MOST_STARTS = 50000, TILE = 4096, PERIODS = 2000 };

typedef struct {
  const kz_basin_plan *plan;
  const kz_proof *proof;
  int64_t starts;
} job;

/* A number that looks random (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014, 453), its first 53 bits. */
static uint64_t random_bits(uint64_t index) {
  uint64_t x = index * 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return (x ^ x >> 31) >> 11;
}

static kz_proof_start start_of(const kz_basin_plan *plan, int64_t i) {
  kz_proof_start start = {.radius = 0};
  uint64_t bits[4];
  for (int b = 0; b < 4; b++) bits[b] = random_bits(((uint64_t)plan->seed << 32) + 4 * (uint64_t)i + (uint64_t)b + 1);
  const double theta = kz_axis_random(&plan->theta, bits, start.theta);
  const double velocity = kz_axis_random(&plan->velocity, bits + 2, start.velocity);
  start.radius = theta > velocity ? theta : velocity;
  return start;
}

int64_t kz_proof_periods(const kz_basin_plan *plan) {
  return plan->max_periods > PERIODS ? plan->max_periods : PERIODS;
}

int64_t kz_proof_sample_starts(const kz_basin_plan *plan) {
  const int64_t cells = plan->theta.count * plan->velocity.count;
  return cells < MOST_STARTS ? cells : MOST_STARTS;
}

/* Record: how many of the tile's starts are not proved. */
static kz_status follow_tile(void *context, int64_t tile, void *record) {
  const job *j = context;
  const int64_t first = tile * TILE, n = j->starts - first < TILE ? j->starts - first : TILE;
  kz_proof_start *start = kz_malloc(TILE * sizeof *start);
  uint8_t *number = kz_malloc(TILE);
  for (int64_t i = 0; i < n; i++) start[i] = start_of(j->plan, first + i);
  int64_t left = n, late = 0;
  for (int32_t precision = KZ_ENCLOSE_DOUBLES; precision <= KZ_ENCLOSE_PAIRS; precision++) {
    kz_proof_follow(j->proof, precision, left, start, kz_proof_periods(j->plan), number);
    int64_t grown = 0;
    for (int64_t i = 0; i < left; i++) {
      late += number[i] == KZ_PROOF_LATE;
      if (number[i] == 0) start[grown++] = start[i];
    }
    left = grown;
  }
  *(int64_t *)record = left + late;
  free(start);
  free(number);
  return KZ_OK;
}

kz_status kz_prove_sample(const kz_run *run, const kz_basin_plan *plan, const kz_proof *proof, kz_proof_sample *sample) {
  job j = {.plan = plan, .proof = proof, .starts = kz_proof_sample_starts(plan)};
  const kz_stage stage =
      kz_stage_for_all("proof of real starts", (j.starts + TILE - 1) / TILE, sizeof(int64_t), follow_tile, &j);
  int64_t *record = kz_calloc((size_t)stage.n_tiles, sizeof *record);
  const kz_status status = kz_stage_run(run, &stage, record);
  *sample = (kz_proof_sample){.starts = j.starts};
  for (int64_t tile = 0; tile < stage.n_tiles; tile++) sample->unproved += record[tile];
  sample->high = kz_share_upper(sample->unproved, sample->starts, KZ_PROOF_CONFIDENCE);
  free(record);
  return status;
}
