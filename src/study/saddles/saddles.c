/* Study `saddles`: rounds of ever closer lines of starts until nothing is new and the index sums are 0. */
#include "saddles.h"
#include "kapitza/study_saddles.h"

#include <complex.h>

/* All cycles, and those that do not attract (indices are ids), which share the strobe points of the former. */
typedef struct {
  kz_catalogue all, unstable;
} kz_cycle_list;

/* The fixed points of F^period with this winding: their number, and the sum of their indices. */
typedef struct {
  int32_t period, winding, points, index;
} kz_index_sum;
typedef struct {
  int64_t count, open; /* open: sums that are not 0 */
  kz_index_sum *entries;
} kz_index_sums;

static void list_known(const kz_dynamics *dynamics, kz_cycle_list *list) {
  kz_catalogue_make(dynamics, NULL, &list->all);
  const int64_t n = list->all.count;
  kz_catalogue *unstable = &list->unstable;
  *unstable = (kz_catalogue){.entries = kz_calloc((size_t)n + 1, sizeof *unstable->entries)};
  KZ_AUTOFREE int32_t *id = kz_malloc((size_t)(n + 1) * sizeof *id);
  for (int64_t i = 0; i < n; i++) {
    const kz_entry *entry = list->all.entries + i;
    const bool is_unstable = hypot(entry->row.multiplier_re[0], entry->row.multiplier_im[0]) > 1;
    id[i] = is_unstable ? (int32_t)unstable->count : -1;
    if (!is_unstable) continue;
    unstable->entries[unstable->count] = *entry;
    snprintf(unstable->entries[unstable->count++].name, KZ_NAME_LENGTH, "unstable %.*s", KZ_NAME_LENGTH - 10,
             entry->name);
  }
  for (int64_t i = 0; i < unstable->count; i++) unstable->entries[i].mirror = id[unstable->entries[i].mirror];
}

/* Lists the cycles that are known; the caller frees the list. */
static void free_cycles(kz_cycle_list *list) {
  kz_catalogue_free(&list->all);
  free(list->unstable.entries);
  *list = (kz_cycle_list){0};
}

/* The index of each fixed point of F^(n * period) on a cycle: the sign of (1 - mu1^n)(1 - mu2^n). */
static int index_of(const kz_attractor *cycle, int64_t n) {
  double complex factor[2];
  for (int i = 0; i < 2; i++) factor[i] = 1 - cpow(cycle->multiplier_re[i] + I * cycle->multiplier_im[i], (double)n);
  const double determinant = creal(factor[0] * factor[1]); /* determinant of 1 - DF: real or conjugate multipliers */
  return (determinant > 0) - (determinant < 0);
}

static void free_sums(kz_index_sums *sums) {
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

static int saddles_compare(const void *a, const void *b) {
  const kz_index_sum *x = a, *y = b;
  return x->period != y->period ? x->period - y->period : x->winding - y->winding;
}

/* Makes the sums for every period up to max_period and every winding of a known cycle; the caller frees them. The
 * theorem is in docs/explanation/theory.md. */
static void make_sums(const kz_cycle_list *list, int64_t max_period, kz_index_sums *sums) {
  *sums = (kz_index_sums){.entries = kz_calloc((size_t)(list->all.count * max_period) + 1, sizeof *sums->entries)};
  for (int64_t i = 0; i < list->all.count; i++) {
    const kz_attractor *row = &list->all.entries[i].row;
    for (int64_t n = 1; n * row->period <= max_period; n++) {
      kz_index_sum *sum = sum_of(sums, n * row->period, n * row->winding);
      sum->points += row->period;
      sum->index += row->period * index_of(row, n);
    }
  }
  qsort(sums->entries, (size_t)sums->count, sizeof *sums->entries, saddles_compare);
  for (int64_t i = 0; i < sums->count; i++) sums->open += sums->entries[i].index != 0;
}

/* ---- the file's group /saddles, and the summary ---- */

enum { MOST_LINES = 40 }; /* Lines of the summary's table */

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

/* Writes the unstable cycles and the index sums to group /saddles. */
static kz_status write_saddles(const kz_cycle_list *cycles, const kz_index_sums *sums, kz_store *store) {
  const int64_t n = cycles->unstable.count;
  const kz_entry *e = cycles->unstable.entries;
  KZ_TRY(kz_catalogue_write_motions(&cycles->unstable, "saddles", "saddle", store));
  COLUMN(int32_t, "mirror", e[i].mirror);
  COLUMN(int8_t, "index", index_of(&e[i].row, 1));
  return write_sums(sums, store);
}

static void print_cycles(const kz_catalogue *unstable, FILE *summary) {
  fprintf(summary, "  id  name                          period  winding  index     multiplier\n");
  for (int64_t i = 0; i < unstable->count && i < MOST_LINES; i++) {
    const kz_entry *e = unstable->entries + i;
    fprintf(summary, "%4d  %-28s  %6d  %7d  %+5d  %13.6f\n", (int)i, e->name, e->row.period, e->row.winding,
            index_of(&e->row, 1), e->row.multiplier_re[0]);
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
    fprintf(summary,
            "The indices add up to 0 for all %lld pairs of period and winding, as they must if no cycle is missing.\n",
            (long long)sums->count);
    return;
  }
  fprintf(summary,
          "The indices do not add up to 0 for %lld of %lld pairs of period and winding, so cycles are missing:\n",
          (long long)sums->open, (long long)sums->count);
  for (int64_t i = 0; i < sums->count; i++)
    if (sums->entries[i].index != 0)
      fprintf(summary, "  period %d, winding %d: sum %+d\n", sums->entries[i].period, sums->entries[i].winding,
              sums->entries[i].index);
  fprintf(summary,
          "They lie outside the window, between the lines of the search, or at a bifurcation. Widen saddles.velocity "
          "first.\n");
}

/* Prints the cycles that were found, and the index sums. */
static void print_saddles(const kz_scene *scene, const kz_cycle_list *cycles, const kz_index_sums *sums,
                          FILE *summary) {
  fprintf(summary, "saddles: %lld unstable cycles of up to %lld periods, and %lld that attract\n",
          (long long)cycles->unstable.count, (long long)scene->saddles->max_period,
          (long long)(cycles->all.count - cycles->unstable.count));
  if (cycles->unstable.count > 0) print_cycles(&cycles->unstable, summary);
  print_sums(scene, sums, summary);
}

enum {
  ROUNDS = 8,       /* at most */
  USUAL_ROUNDS = 3, /* Rounds of most searches */
  QUIET = 2         /* rounds without a new cycle, after which the search ends even if the sums are not 0 */
};
/* Everything about the cycles that were found. Rank 0. */
static void list_cycles(const kz_scene *scene, const kz_found *found, kz_cycle_list *cycles, kz_index_sums *sums) {
  const int64_t max_period = scene->saddles->max_period;
  KZ_AUTOFREE_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics, max_period);
  free_cycles(cycles);
  free_sums(sums);
  kz_dynamics_add_cycles(dynamics, max_period, found->count, found->cycle);
  list_known(dynamics, cycles);
  make_sums(cycles, max_period, sums);
}

static void free_found(kz_found *found) {
  free(found->cycle);
}

/* Rounds until enough is known; without damping the sums say nothing. Collective. */
static kz_status run_rounds(const kz_scene *scene, const kz_run *run, kz_found *found, kz_cycle_list *cycles,
                            kz_index_sums *sums) {
  const bool here = kz_rank(run->ranks) == 0, undamped = scene->parameters.pendulum.beta <= 0;
  int32_t enough = 0;
  for (int round = 0, quiet = 0; round < ROUNDS && !enough; round++) {
    char name[32];
    snprintf(name, sizeof name, "saddles %d", round + 1);
    const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, scene->saddles, round);
    const int64_t before = found->count;
    KZ_TRY(kz_lines_run(run, &lines, name, found));
    quiet = round > 0 && found->count == before ? quiet + 1 : 0;
    const bool last = round == ROUNDS - 1;
    if (here && (quiet == 1 || (last && quiet == 0))) list_cycles(scene, found, cycles, sums);
    enough = last || quiet == QUIET || (quiet > 0 && (undamped || sums->open == 0));
    KZ_TRY(kz_ranks_broadcast(run->ranks, &enough, sizeof enough));
  }
  return KZ_OK;
}

kz_status kz_saddles_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(free_found) kz_found found = {0};
  KZ_AUTOFREE_BY(free_cycles) kz_cycle_list cycles = {0};
  KZ_AUTOFREE_BY(free_sums) kz_index_sums sums = {0};
  KZ_TRY(run_rounds(scene, run, &found, &cycles, &sums));
  if (kz_rank(run->ranks) != 0) return KZ_OK;
  print_saddles(scene, &cycles, &sums, summary);
  return write_saddles(&cycles, &sums, store);
}

kz_status kz_saddles_all(const kz_scene *scene, int64_t max_period, const kz_window *window, kz_catalogue *all,
                         int64_t *open) {
  static const kz_run alone = {NULL, NULL};
  kz_saddles_plan plan = {.theta = {.min = window->theta_min, .max = window->theta_max, .count = 1},
                          .velocity = {.min = window->velocity_min, .max = window->velocity_max, .count = 1},
                          .max_period = max_period};
  kz_scene asked = *scene;
  asked.saddles = &plan;
  KZ_AUTOFREE_BY(free_found) kz_found found = {0};
  KZ_AUTOFREE_BY(free_cycles) kz_cycle_list cycles = {0};
  KZ_AUTOFREE_BY(free_sums) kz_index_sums sums = {0};
  KZ_TRY(run_rounds(&asked, &alone, &found, &cycles, &sums));
  *all = cycles.all;
  cycles.all = (kz_catalogue){0};
  *open = sums.open;
  return KZ_OK;
}

void kz_saddles_free(kz_catalogue *all) {
  kz_catalogue_free(all);
}

/* Messages and records of pieces that a rank holds; pieces with a cycle; least bytes of a piece's checkpoint. */
enum { PIECES_AT_ONCE = 5, PIECES_OF_A_CYCLE = 8, PAGE_BYTES = 4096 };
/* Bytes of a cycle of the catalogue. */
static const double CYCLE_BYTES = 2000;

double kz_saddles_expected(const kz_scene *scene) {
  const double growth = 1 + 3 * kz_stiffness(&scene->parameters.pendulum);
  return fmin(2 * pow(growth, (double)scene->saddles->max_period), KZ_SADDLES_MOST);
}

kz_cost kz_saddles_cost(const kz_scene *scene) {
  const kz_saddles_plan *plan = scene->saddles;
  const double cycles = kz_saddles_expected(scene), bytes = PIECES_OF_A_CYCLE * (double)kz_cycle_bytes(plan);
  double pieces = 0;
  for (int round = 0; round < USUAL_ROUNDS; round++) {
    const kz_lines lines = kz_lines_of(&scene->parameters.pendulum, plan, round);
    pieces += (double)(lines.count * lines.pieces);
  }
  return (kz_cost){.disk_bytes = 1e5 + PAGE_BYTES * pieces + cycles * bytes,
                   .memory_bytes = PIECES_AT_ONCE * (double)kz_piece_bytes(plan),
                   .rank0_bytes = cycles * (CYCLE_BYTES + bytes)};
}
