/* Cells that are released at another phase of the drive, at many phases, or on a ramp. */
#pragma once

#include "basin/basin.h"
#include "kapitza/dynamics_release.h"
#include "kapitza/study_release.h"
#include "plan.h"
#include "sweep/plan.h"

/* Functions of the rows (kz_study). */
void kz_release_begin(const kz_scene *scene, const kz_pendulum *pendulum, const double *swept, kz_dynamics *dynamics);
kz_status kz_release_describe(const kz_scene *scene, kz_store *store);
kz_status kz_ramp_describe(const kz_scene *scene, kz_store *store);
extern const kz_basin_part kz_release_part;
extern const kz_sweep_part kz_alike_part;
