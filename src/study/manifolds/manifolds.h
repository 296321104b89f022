/* Study `manifolds`. */
#ifndef KAPITZA_STUDY_MANIFOLDS_H
#define KAPITZA_STUDY_MANIFOLDS_H

#include "kapitza/study.h"

kz_cost kz_manifolds_cost(const kz_scene *scene);
kz_status kz_manifolds_measure(const kz_scene *scene, double *seconds);
kz_status kz_manifolds_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_manifolds_variables[];

#endif
