/* Study `tradeoff`. */
#ifndef KAPITZA_STUDY_TRADEOFF_H
#define KAPITZA_STUDY_TRADEOFF_H

#include "numerics/share.h"
#include "numerics/processed.h"
#include "setting.h"

/* Settings measured on one sample of reference labels. */
typedef struct {
  int64_t count;
  const kz_setting **settings; /* [count] */
  kz_numerics *numerics;       /* [count] resolved */
  kz_measured *measured;       /* [count] */
  double *seconds;             /* [count] for the whole grid of the basin, without the search for attractors */
  double *wrong;               /* [count] */
  int8_t *pareto;              /* [count] */
  double best_wrong;           /* the lowest share of a setting in double precision; NaN without one */
} kz_trade;

/* Group /tradeoff and its table in the summary. Rank 0. */
kz_status kz_tradeoff_write(const kz_reference_labels *reference, const kz_trade *trade, kz_store *store, FILE *summary);

/* The name FILE.truth of the cache of reference labels beside the result; the caller frees it; NULL without a store. */
char *kz_reference_path(const kz_store *store);

kz_cost kz_tradeoff_cost(const kz_scene *scene);
kz_status kz_tradeoff_measure(const kz_scene *scene, double *seconds);
kz_status kz_tradeoff_check(const kz_scene *scene);
kz_status kz_tradeoff_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_tradeoff_variables[];

#endif
