/* Study `saddles`. */
#ifndef KAPITZA_STUDY_SADDLES_H
#define KAPITZA_STUDY_SADDLES_H

#include "cycles.h"
#include "kapitza/study.h"

kz_cost kz_saddles_cost(const kz_scene *scene);
kz_status kz_saddles_measure(const kz_scene *scene, double *seconds);
/* A rough estimate of the number of cycles that a search would find. */
double kz_saddles_expected(const kz_scene *scene);
kz_status kz_saddles_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* Writes the unstable cycles and the index sums to group /saddles. */
kz_status kz_saddles_write(const kz_cycle_list *cycles, const kz_index_sums *sums, kz_store *store);
/* Prints the cycles that were found, and the index sums. */
void kz_saddles_print(const kz_scene *scene, const kz_cycle_list *cycles, const kz_index_sums *sums, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_saddles_variables[];

#endif
