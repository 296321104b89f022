/* Labels that are proved, for basin.proof. */
#ifndef KAPITZA_STUDY_PROOF_H
#define KAPITZA_STUDY_PROOF_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "label.h"

/* The attractors that are proved to exist: numbers of kz_dynamics, mirror [0] = 0. */
typedef struct {
  bool any, has[KZ_PROOF_MOST + 1];
  uint8_t mirror[KZ_PROOF_MOST + 1];
} kz_proved;

/* *proof = an empty proof for the scene's basin, or NULL without basin.proof; the caller frees it with kz_proof_free in every case.
 * KZ_REFUSED if the window is too fast for a proof. */
kz_status kz_proof_plan(const kz_scene *scene, kz_proof **proof);
/* Proves the regions of the known attractors, in kept stages, with the same result on every rank. Collective. */
kz_status kz_prove_regions(const kz_run *run, const kz_dynamics *dynamics, kz_proof *proof, kz_proved *proved);
/* Largest number of drive periods for which a start is followed, at least 2000 whatever basin.max_periods is. */
int64_t kz_proof_periods(const kz_basin_plan *plan);

/* Random real starts of the window. */
typedef struct {
  int64_t starts, unproved;
  double high; /* upper bound of the share of the window's area that is not proved, with KZ_PROOF_CONFIDENCE */
} kz_proof_sample;
#define KZ_PROOF_CONFIDENCE 0.95
int64_t kz_proof_sample_starts(const kz_basin_plan *plan);
kz_status kz_prove_sample(const kz_run *run, const kz_basin_plan *plan, const kz_proof *proof, kz_proof_sample *sample);

/* Proves regions, cells and the sample, one after the other. Collective. */
kz_status kz_prove_window(kz_window_labels *labelling, kz_proof *proof, kz_proof_sample *sample);

/* The start of a cell. */
kz_proof_start kz_proof_cell_start(const kz_basin_plan *plan, int64_t cell);

/* The cost of a proof: bytes of memory of a rank; processor seconds, which are added to *seconds (the attractors must be known). */
double kz_proof_bytes(const kz_scene *scene);
kz_status kz_proof_measure(const kz_scene *scene, const kz_dynamics *dynamics, double *seconds);

#endif
