/* basin.accuracy: the program chooses method, table and numerics. */
#ifndef KAPITZA_STUDY_ACCURACY_H
#define KAPITZA_STUDY_ACCURACY_H

#include "setting.h"

/* What was chosen and why. */
typedef struct {
  const kz_setting *setting;
  int64_t samples, wrong, flipped, tried;
} kz_choice;

/* Chooses the cheapest setting (kz_setting_cost) whose share of wrong labels in the sample, at the upper end of its 95 % interval, is at most
 * 1 - accuracy; method exact if there is none. Collective. */
kz_status kz_accuracy_choose(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary, kz_choice *choice);

/* The choice as attributes of /basin. Rank 0. */
kz_status kz_accuracy_write(const kz_choice *choice, double accuracy, kz_store *store);

/* Estimates the processor time of the choice from samples and adds it to *seconds. Not collective. */
kz_status kz_accuracy_measure(const kz_scene *scene, double *seconds);

#endif
