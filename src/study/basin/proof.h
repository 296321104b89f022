/* Trapping regions that are proved, for basin.proof. */
#ifndef KAPITZA_STUDY_PROOF_H
#define KAPITZA_STUDY_PROOF_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* An open grid for the proof of a scene's basin, NULL where none is asked for; free with kz_proof_free in every case. KZ_REFUSED where
 * the window is too fast for a proof. */
kz_status kz_proof_plan(const kz_scene *scene, kz_proof **proof);
/* Proves the regions of the known attractors, in kept stages; every rank has the same grid then. Collective. */
kz_status kz_prove_regions(const kz_run *run, const kz_dynamics *dynamics, kz_proof *proof);

/* What a proof costs: bytes of a rank, seconds of one core. */
double kz_proof_bytes(const kz_scene *scene);
double kz_proof_seconds(const kz_scene *scene);

#endif
