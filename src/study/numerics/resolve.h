/* Resolves the numerics of a scene for each of its studies (kz_numerics_resolve, kz_orbit_steps and kz_orbit_numerics of study.h). */
#ifndef KAPITZA_STUDY_RESOLVE_H
#define KAPITZA_STUDY_RESOLVE_H

#include "step_check.h"

/* The motions of a basin's cells. The allowed errors are shares of a cell, except for method exact, which carries its errors. */
kz_motions kz_motions_of_basin(const kz_scene *scene);

/* Samples a period of the study `orbit`: enough for turning points and spectra, and a multiple of the scene's samples_per_period. */
int64_t kz_orbit_samples(const kz_scene *scene);

#endif
