#include "saddles.h"

#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void kz_cycle_list_make(const kz_dynamics *dynamics, kz_cycle_list *list) {
  kz_catalogue_make(dynamics, NULL, &list->all);
  const int64_t n = list->all.count;
  kz_catalogue *unstable = &list->unstable;
  *unstable = (kz_catalogue){.entries = kz_calloc((size_t)n + 1, sizeof *unstable->entries)};
  KZ_FREED int32_t *id = kz_malloc((size_t)(n + 1) * sizeof *id);
  for (int64_t i = 0; i < n; i++) {
    const kz_entry *entry = list->all.entries + i;
    const bool is_unstable = hypot(entry->row.multiplier_re[0], entry->row.multiplier_im[0]) > 1;
    id[i] = is_unstable ? (int32_t)unstable->count : -1;
    if (!is_unstable) continue;
    unstable->entries[unstable->count] = *entry;
    snprintf(unstable->entries[unstable->count++].name, KZ_NAME_LENGTH, "unstable %.*s", KZ_NAME_LENGTH - 10, entry->name);
  }
  for (int64_t i = 0; i < unstable->count; i++) unstable->entries[i].mirror = id[unstable->entries[i].mirror];
}

void kz_cycle_list_free(kz_cycle_list *list) {
  kz_catalogue_free(&list->all);
  free(list->unstable.entries);
  *list = (kz_cycle_list){0};
}

int kz_cycle_index(const kz_attractor *cycle, int64_t n) {
  double complex factor[2];
  for (int i = 0; i < 2; i++) factor[i] = 1 - cpow(cycle->multiplier_re[i] + I * cycle->multiplier_im[i], (double)n);
  const double determinant = creal(factor[0] * factor[1]); /* of 1 - DF: the multipliers are real or conjugate */
  return (determinant > 0) - (determinant < 0);
}

void kz_index_sums_free(kz_index_sums *sums) {
  free(sums->entries);
  *sums = (kz_index_sums){0};
}

/* The sum of period n and winding w; a new one where there is none yet. */
static kz_index_sum *sum_of(kz_index_sums *sums, int64_t n, int64_t winding) {
  for (int64_t i = 0; i < sums->count; i++)
    if (sums->entries[i].period == n && sums->entries[i].winding == winding) return sums->entries + i;
  sums->entries[sums->count] = (kz_index_sum){.period = (int32_t)n, .winding = (int32_t)winding};
  return sums->entries + sums->count++;
}

static int compare(const void *a, const void *b) {
  const kz_index_sum *x = a, *y = b;
  return x->period != y->period ? x->period - y->period : x->winding - y->winding;
}

void kz_index_sums_make(const kz_cycle_list *list, int64_t max_period, kz_index_sums *sums) {
  *sums = (kz_index_sums){.entries = kz_calloc((size_t)(list->all.count * max_period) + 1, sizeof *sums->entries)};
  for (int64_t i = 0; i < list->all.count; i++) {
    const kz_attractor *row = &list->all.entries[i].row;
    for (int64_t n = 1; n * row->period <= max_period; n++) {
      kz_index_sum *sum = sum_of(sums, n * row->period, n * row->winding);
      sum->points += row->period;
      sum->index += row->period * kz_cycle_index(row, n);
    }
  }
  qsort(sums->entries, (size_t)sums->count, sizeof *sums->entries, compare);
  for (int64_t i = 0; i < sums->count; i++) sums->open += sums->entries[i].index != 0;
}
