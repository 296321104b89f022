/* Study `potential`: the effective potential over theta for several drive amplitudes. */
#ifndef KAPITZA_STUDY_POTENTIAL_H
#define KAPITZA_STUDY_POTENTIAL_H

#include "kapitza/study.h"

kz_cost kz_potential_cost(const kz_scene *scene);
kz_status kz_potential_measure(const kz_scene *scene, double *seconds);
kz_status kz_potential_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_potential_variables[];

#endif
