/* The cost of a proof: the region is made, and some cells are followed. */
#include <stdlib.h>

#include "numerics/cells.h"
#include "numerics/share.h"
#include "proof.h"

enum { SAMPLE = 16384, FULL = 256 }; /* starts; fewer than FULL take as long, since lanes are idle then */

/* Follows n cells; those that the precision leaves come to the front, *n of them. Returns the processor seconds. */
static double follow(const kz_basin_plan *plan, const kz_proof *proof, int32_t precision, int64_t *n, int64_t *cell) {
  kz_proof_start *start = kz_malloc((size_t)*n * sizeof *start + 1);
  uint8_t *number = kz_malloc((size_t)*n + 1);
  int64_t left = 0;
  for (int64_t i = 0; i < *n; i++) start[i] = kz_proof_cell_start(plan, cell[i]);
  const double begin = kz_processor_clock();
  kz_proof_follow(proof, precision, *n, start, kz_proof_periods(plan), number);
  const double seconds = kz_processor_clock() - begin;
  for (int64_t i = 0; i < *n; i++)
    if (number[i] == 0) cell[left++] = cell[i];
  *n = left;
  free(start);
  free(number);
  return seconds;
}

/* Of all cells, and of the random real starts, which are not followed in quads. */
static double starts_seconds(const kz_basin_plan *plan, const kz_proof *proof) {
  const int64_t own = kz_unique_cells(plan), taken = own < SAMPLE ? own : SAMPLE;
  int64_t *cell = kz_malloc((size_t)taken * sizeof *cell + 1), n = taken;
  double seconds = 0;
  for (int64_t i = 0; i < taken; i++) cell[i] = kz_shuffled(i, own, plan->seed);
  for (int32_t precision = 0; precision < KZ_ENCLOSURES && n > 0; precision++) {
    const double all = (double)own + (precision < KZ_ENCLOSE_QUADS ? (double)kz_proof_sample_starts(plan) : 0);
    const double starts = all * (double)n / (double)taken, followed = (double)(n < FULL ? FULL : n);
    seconds += follow(plan, proof, precision, &n, cell) * starts / followed;
  }
  free(cell);
  return seconds;
}

kz_status kz_proof_measure(const kz_scene *scene, const kz_dynamics *dynamics, double *seconds) {
  const kz_run alone = {NULL, NULL};
  kz_proved proved = {.any = false};
  kz_proof *proof;
  KZ_TRY(kz_proof_plan(scene, &proof));
  if (!proof) return KZ_OK;
  const double begin = kz_processor_clock();
  const kz_status status = kz_prove_regions(&alone, dynamics, proof, &proved);
  *seconds += kz_processor_clock() - begin;
  if (proved.any) *seconds += starts_seconds(&scene->basin, proof);
  kz_proof_free(proof);
  return status;
}
