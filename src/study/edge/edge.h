/* Study `edge`. */
#ifndef KAPITZA_STUDY_EDGE_H
#define KAPITZA_STUDY_EDGE_H

#include "kapitza/study.h"

kz_cost kz_edge_cost(const kz_scene *scene);
kz_status kz_edge_measure(const kz_scene *scene, double *seconds);
kz_status kz_edge_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_edge_variables[];

#endif
