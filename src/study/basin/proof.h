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

/* An open grid for the proof of a scene's basin, NULL where none is asked for; free with kz_proof_free in every case. KZ_REFUSED where
 * the window is too fast for a proof. */
kz_status kz_proof_plan(const kz_scene *scene, kz_proof **proof);
/* Proves the regions of the known attractors, in kept stages; every rank has the same grid then. Collective. */
kz_status kz_prove_regions(const kz_run *run, const kz_dynamics *dynamics, kz_proof *proof, kz_proved *proved);
/* Drive periods that a start is followed through, at most: a small basin.max_periods does not hinder a proof. */
int64_t kz_proof_periods(const kz_basin_plan *plan);
/* Follows the starts of all cells into the region, in kept stages, but those that some method labelled with an attractor that is not
 * proved: the fields proof and proved of the labelling's cells. Collective. */
kz_status kz_prove_cells(kz_window_labels *labelling, const kz_proof *proof, const kz_proved *proved);

/* Random real starts of the window. */
typedef struct {
  int64_t starts, unproved;
  double high; /* upper bound of the share of the window's area that is not proved, with KZ_PROOF_CONFIDENCE */
} kz_proof_sample;
#define KZ_PROOF_CONFIDENCE 0.95
int64_t kz_proof_sample_starts(const kz_basin_plan *plan);
kz_status kz_prove_sample(const kz_run *run, const kz_basin_plan *plan, const kz_proof *proof, kz_proof_sample *sample);

/* The three of them, one after the other. Collective. */
kz_status kz_prove_window(kz_window_labels *labelling, kz_proof *proof, kz_proof_sample *sample);

/* The start of a cell. */
kz_proof_start kz_proof_cell_start(const kz_basin_plan *plan, int64_t cell);

/* What a proof costs: bytes of a rank; seconds of one core, with the known attractors, are added to *seconds. */
double kz_proof_bytes(const kz_scene *scene);
kz_status kz_proof_measure(const kz_scene *scene, const kz_dynamics *dynamics, double *seconds);

#endif
