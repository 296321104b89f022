/* Study `attractors`. */
#ifndef KAPITZA_STUDY_ATTRACTORS_H
#define KAPITZA_STUDY_ATTRACTORS_H

#include "kapitza/study.h"

kz_cost kz_attractors_cost(const kz_scene *scene);
kz_status kz_attractors_measure(const kz_scene *scene, double *seconds);
kz_status kz_attractors_check(const kz_scene *scene);
kz_status kz_attractors_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_attractors_variables[];

#endif
