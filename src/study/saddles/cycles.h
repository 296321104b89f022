/* All known cycles of the strobe map up to a period, attracting or not, and their index sums. */
#ifndef KAPITZA_STUDY_SADDLES_CYCLES_H
#define KAPITZA_STUDY_SADDLES_CYCLES_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/analysis.h"
#include "kapitza/dynamics.h"
#include "kapitza/study.h"

typedef struct {
  kz_attractor row;
  bool unstable;
  int32_t saddle; /* id among the unstable cycles; -1 = it attracts */
  int32_t mirror; /* saddle of its mirror image */
  char name[KZ_NAME_LENGTH];
  double theta[KZ_SADDLES_MAX_PERIOD], velocity[KZ_SADDLES_MAX_PERIOD]; /* strobe points */
} kz_listed_cycle;

/* In the order of attractors of the file. */
typedef struct {
  int64_t count, n_unstable;
  kz_listed_cycle *entries;
} kz_cycle_list;

/* Makes the list of the cycles of a catalogue; the caller frees it. */
void kz_cycle_list_make(const kz_dynamics *dynamics, kz_cycle_list *list);
void kz_cycle_list_free(kz_cycle_list *list);

/* The index of each fixed point of F^(n * period) on a cycle: the sign of (1 - mu1^n)(1 - mu2^n). */
int kz_cycle_index(const kz_attractor *cycle, int64_t n);

/* The fixed points of F^period with this winding: their number, and the sum of their indices. */
typedef struct {
  int32_t period, winding, points, index;
} kz_index_sum;
typedef struct {
  int64_t count, open; /* open: sums that are not 0 */
  kz_index_sum *entries;
} kz_index_sums;

/* Makes the sums for every period up to max_period and every winding of a known cycle; the caller frees sums->entries. The theorem is in
 * docs/explanation/theory.md. */
void kz_index_sums_make(const kz_cycle_list *list, int64_t max_period, kz_index_sums *sums);

#endif
