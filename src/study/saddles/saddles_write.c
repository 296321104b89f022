/* The file's group /saddles, and the summary. */
#include <math.h>
#include <stdlib.h>

#include "saddles.h"

enum { MOST_LINES = 40 }; /* of the summary's table */

/* The unstable cycles, in their order. */
static const kz_listed_cycle **unstable_of(const kz_cycle_list *cycles) {
  const kz_listed_cycle **list = kz_malloc((size_t)(cycles->n_unstable + 1) * sizeof *list);
  for (int64_t i = 0; i < cycles->count; i++)
    if (cycles->entries[i].unstable) list[cycles->entries[i].saddle] = cycles->entries + i;
  return list;
}

#define COLUMN(type, name, expression) KZ_COLUMN(store, "saddles", name, n, type, expression)

static kz_status write_columns(int64_t n, const kz_listed_cycle *const *e, kz_store *store) {
  COLUMN(int32_t, "period", e[i]->row.period);
  COLUMN(int32_t, "winding", e[i]->row.winding);
  COLUMN(int8_t, "centre", e[i]->row.centre);
  COLUMN(const char *, "name", e[i]->name);
  COLUMN(int8_t, "symmetric", e[i]->row.symmetric);
  COLUMN(int32_t, "mirror", e[i]->mirror);
  COLUMN(int8_t, "index", kz_cycle_index(&e[i]->row, 1));
  return KZ_OK;
}

/* Columns of several values for each cycle: places beyond its period are NaN. */
static kz_status write_matrices(int64_t n, const kz_listed_cycle *const *e, int64_t phases, kz_store *store) {
  const int64_t points = n * phases;
#define POINTS(name, field)                         \
  KZ_COLUMN(store, "saddles", name, points, double, \
            i % phases < e[i / phases]->row.period ? e[i / phases]->field[i % phases] : NAN)
  POINTS("strobe_theta", theta);
  POINTS("strobe_velocity", velocity);
  KZ_COLUMN(store, "saddles", "multiplier_re", 2 * n, double, e[i / 2]->row.multiplier_re[i % 2]);
  KZ_COLUMN(store, "saddles", "multiplier_im", 2 * n, double, e[i / 2]->row.multiplier_im[i % 2]);
  return KZ_OK;
}

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
  const int64_t n = cycles->n_unstable;
  const kz_listed_cycle **list = unstable_of(cycles);
  int64_t phases = 1;
  for (int64_t i = 0; i < n; i++) phases = list[i]->row.period > phases ? list[i]->row.period : phases;
  kz_status status = kz_store_dimension(store, "saddles", "saddle", n, NULL);
  if (status == KZ_OK) status = kz_store_dimension(store, "saddles", "phase", phases, NULL);
  if (status == KZ_OK) status = kz_store_dimension(store, "saddles", "pair", 2, NULL);
  if (status == KZ_OK) status = write_columns(n, list, store);
  if (status == KZ_OK) status = write_matrices(n, list, phases, store);
  if (status == KZ_OK) status = write_sums(sums, store);
  free(list);
  return status;
}

static void print_cycles(const kz_cycle_list *cycles, FILE *summary) {
  fprintf(summary, "  id  name                          period  winding  index     multiplier\n");
  for (int64_t i = 0; i < cycles->count; i++) {
    const kz_listed_cycle *e = cycles->entries + i;
    if (!e->unstable || e->saddle >= MOST_LINES) continue;
    fprintf(summary, "%4d  %-28s  %6d  %7d  %+5d  %13.6f\n", e->saddle, e->name, e->row.period, e->row.winding,
            kz_cycle_index(&e->row, 1), e->row.multiplier_re[0]);
  }
  if (cycles->n_unstable > MOST_LINES)
    fprintf(summary, "  and %lld more, in the file\n", (long long)(cycles->n_unstable - MOST_LINES));
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
          (long long)cycles->n_unstable, (long long)scene->saddles->max_period,
          (long long)(cycles->count - cycles->n_unstable));
  if (cycles->n_unstable > 0) print_cycles(cycles, summary);
  print_sums(scene, sums, summary);
}
