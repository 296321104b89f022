/* The file's group /saddles, and the summary. */
#include <math.h>
#include <stdlib.h>

#include "saddles.h"

enum { MOST_LINES = 40 }; /* of the summary's table */

#define COLUMN(type, name, expression) KZ_COLUMN(store, "saddles", name, n, type, expression)

static kz_status write_sums(const kz_index_sums *sums, kz_store *store) {
  const int64_t n = sums->count;
  KZ_TRY(kz_store_dimension(store, "saddles", "sum", n, NULL));
  COLUMN(int32_t, "sum_period", sums->entries[i].period);
  COLUMN(int32_t, "sum_winding", sums->entries[i].winding);
  COLUMN(int32_t, "sum_points", sums->entries[i].points);
  COLUMN(int32_t, "index_sum", sums->entries[i].index);
  return KZ_OK;
}

kz_status kz_saddles_write(const kz_cycle_list *cycles, const kz_index_sums *sums, kz_store *store) {
  const int64_t n = cycles->unstable.count;
  const kz_entry *e = cycles->unstable.entries;
  KZ_TRY(kz_catalogue_write_motions(&cycles->unstable, "saddles", "saddle", store));
  COLUMN(int32_t, "mirror", e[i].mirror);
  COLUMN(int8_t, "index", kz_cycle_index(&e[i].row, 1));
  return write_sums(sums, store);
}

kz_status kz_saddle_check(kz_store *store, const char *keys, int64_t saddle) {
  int64_t known;
  KZ_TRY(kz_store_length(store, "saddles", "saddle", &known));
  if (saddle < known) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: %lld is not among the %lld unstable cycles; choose an id below that", keys, (long long)saddle,
                 (long long)known);
}

static void print_cycles(const kz_catalogue *unstable, FILE *summary) {
  fprintf(summary, "  id  name                          period  winding  index     multiplier\n");
  for (int64_t i = 0; i < unstable->count && i < MOST_LINES; i++) {
    const kz_entry *e = unstable->entries + i;
    fprintf(summary, "%4d  %-28s  %6d  %7d  %+5d  %13.6f\n", (int)i, e->name, e->row.period, e->row.winding,
            kz_cycle_index(&e->row, 1), e->row.multiplier_re[0]);
  }
  if (unstable->count > MOST_LINES)
    fprintf(summary, "  and %lld more, in the file\n", (long long)(unstable->count - MOST_LINES));
}

static void print_sums(const kz_scene *scene, const kz_index_sums *sums, FILE *summary) {
  if (scene->parameters.pendulum.beta <= 0) {
    fprintf(summary, "Without damping the index sums cannot show missing cycles.\n");
    return;
  }
  if (sums->open == 0) {
    fprintf(summary, "The indices add up to 0 for all %lld pairs of period and winding, as they must if no cycle is missing.\n",
            (long long)sums->count);
    return;
  }
  fprintf(summary, "The indices do not add up to 0 for %lld of %lld pairs of period and winding, so cycles are missing:\n",
          (long long)sums->open, (long long)sums->count);
  for (int64_t i = 0; i < sums->count; i++)
    if (sums->entries[i].index != 0)
      fprintf(summary, "  period %d, winding %d: sum %+d\n", sums->entries[i].period, sums->entries[i].winding,
              sums->entries[i].index);
  fprintf(summary,
          "They lie outside the window, between the lines of the search, or at a bifurcation. Widen saddles.velocity first.\n");
}

void kz_saddles_print(const kz_scene *scene, const kz_cycle_list *cycles, const kz_index_sums *sums, FILE *summary) {
  fprintf(summary, "saddles: %lld unstable cycles of up to %lld periods, and %lld that attract\n",
          (long long)cycles->unstable.count, (long long)scene->saddles->max_period,
          (long long)(cycles->all.count - cycles->unstable.count));
  if (cycles->unstable.count > 0) print_cycles(&cycles->unstable, summary);
  print_sums(scene, sums, summary);
}
