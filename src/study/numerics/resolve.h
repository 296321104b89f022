/* What a scene's numerics come to, for each of its studies (kz_numerics_resolve, kz_orbit_steps and kz_orbit_numerics of study.h). */
#ifndef KAPITZA_STUDY_RESOLVE_H
#define KAPITZA_STUDY_RESOLVE_H

#include "step_check.h"

/* Motions of a basin's cells: the allowed errors are shares of a cell, but for method exact, which follows errors. */
kz_motions kz_motions_of_basin(const kz_scene *scene);

/* Samples a period of the study `orbit`: as many as turning points and spectra need, and a multiple of those that the scene asks for. */
int64_t kz_orbit_samples(const kz_scene *scene);

#endif
