/* Branches of a sweep into the file, and a table of them for people. */
#include <math.h>
#include <stdlib.h>

#include "numerics/share.h"
#include "kapitza/analysis.h"
#include "sweep.h"

static const char *const END_NAMES[] = {"end of range",      "fold",       "period doubling", "Neimark-Sacker",
                                        "symmetry breaking", "not located"};

typedef struct {
  const kz_scene *scene;
  const kz_sweep_catalogue *catalogue;
  const kz_sweep_branches *branches;
  kz_store *store;
} writing;

static const kz_sweep_node *first_of(const kz_sweep_branches *b, int64_t branch) {
  return b->nodes + b->first_node[branch];
}

static const kz_sweep_node *last_of(const kz_sweep_branches *b, int64_t branch) {
  const kz_sweep_node *node = first_of(b, branch);
  while (node->next >= 0) node = b->nodes + node->next;
  return node;
}

static void name_of(const kz_sweep_branches *b, int64_t branch, char *text) {
  const kz_branch_point *point = &first_of(b, branch)->entry.point;
  kz_orbit_name(point->period, point->winding, point->centre, text);
}

static bool mirrors(const kz_scene *scene, const kz_sweep_node *node, const kz_branch_point *image) {
  kz_pendulum pendulum;
  const kz_branch_point *point = &node->entry.point;
  if (image->period == 0)
    return point->period == 0 && fabs(point->velocity - image->velocity) < 1e-3 && fabs(point->theta - image->theta) < 1e-3;
  return kz_sweep_pendulum(scene, kz_sweep_value(&scene->sweep, node->value), &pendulum) &&
         kz_branch_same(&pendulum, point, image);
}

/* The branch that holds the mirror image of this one's first cycle; -1 where none does. */
static int32_t mirror_of(const writing *w, int64_t branch) {
  const kz_sweep_node *first = first_of(w->branches, branch);
  kz_branch_point image = first->entry.point;
  if (image.symmetric) return (int32_t)branch;
  image.theta = -image.theta;
  image.velocity = -image.velocity;
  image.winding = -image.winding;
  for (int64_t other = 0; other < w->branches->n_branches; other++) {
    const kz_sweep_node *node = first_of(w->branches, other);
    while (node->value < first->value && node->next >= 0) node = w->branches->nodes + node->next;
    if (node->value == first->value && mirrors(w->scene, node, &image)) return (int32_t)other;
  }
  return -1;
}

#define COLUMN(type, name, expression) KZ_COLUMN(w->store, "sweep", name, b->n_branches, type, expression)

static kz_status write_columns(const writing *w) {
  const kz_sweep_branches *b = w->branches;
  COLUMN(int32_t, "branch_period", first_of(b, i)->entry.point.period);
  COLUMN(int32_t, "branch_winding", first_of(b, i)->entry.point.winding);
  COLUMN(int8_t, "branch_centre", first_of(b, i)->entry.point.centre);
  COLUMN(int8_t, "branch_symmetric", first_of(b, i)->entry.point.symmetric);
  COLUMN(int32_t, "branch_mirror", mirror_of(w, i));
  COLUMN(double, "branch_start", first_of(b, i)->first);
  COLUMN(double, "branch_end", last_of(b, i)->last);
  COLUMN(int8_t, "branch_start_kind", first_of(b, i)->first_kind);
  COLUMN(int8_t, "branch_end_kind", last_of(b, i)->last_kind);
  return KZ_OK;
}

static kz_status write_names(const writing *w) {
  const int64_t n = w->branches->n_branches;
  char (*names)[KZ_NAME_LENGTH] = kz_calloc((size_t)n + 1, sizeof *names);
  const char **pointers = kz_calloc((size_t)n + 1, sizeof *pointers);
  for (int64_t i = 0; i < n; i++) {
    name_of(w->branches, i, names[i]);
    pointers[i] = names[i];
  }
  const kz_status status = kz_store_variable(w->store, "sweep", "branch_name", pointers);
  free(names);
  free(pointers);
  return status;
}

/* The entry (value, branch) of a matrix. */
typedef double (*cell_fn)(const kz_sweep_node *node, int64_t samples);

static double amplitude_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.point.centre > 1 ? NAN : node->entry.point.amplitude;
}

static double multiplier_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  const kz_branch_point *point = &node->entry.point;
  return point->period == 0 ? NAN : hypot(point->multiplier_re[0], point->multiplier_im[0]);
}

static double theta_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.point.theta;
}

static double velocity_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.point.velocity;
}

static double fraction_of(const kz_sweep_node *node, int64_t samples) {
  return (double)node->entry.hits / (double)samples;
}

static double low_of(const kz_sweep_node *node, int64_t samples) {
  return kz_share_of(node->entry.hits, samples).low;
}

static double high_of(const kz_sweep_node *node, int64_t samples) {
  return kz_share_of(node->entry.hits, samples).high;
}

static double shock_angle_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.shock[0];
}

static double shock_kick_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.shock[1];
}

static double shock_size_of(const kz_sweep_node *node, int64_t samples) {
  (void)samples;
  return node->entry.shock[2];
}

static kz_status write_matrix(const writing *w, const char *name, cell_fn cell) {
  const kz_sweep_branches *b = w->branches;
  const int64_t n = w->scene->sweep.values.count * b->n_branches;
  double *matrix = kz_malloc((size_t)(n + 1) * sizeof *matrix);
  for (int64_t i = 0; i < n; i++) matrix[i] = NAN;
  for (int64_t branch = 0; branch < b->n_branches; branch++)
    for (int64_t i = b->first_node[branch]; i >= 0; i = b->nodes[i].next) {
      const int64_t value = b->nodes[i].value, samples = w->catalogue[value].samples;
      if (samples > 0) matrix[value * b->n_branches + branch] = cell(b->nodes + i, samples);
    }
  const kz_status status = kz_store_variable(w->store, "sweep", name, matrix);
  free(matrix);
  return status;
}

static kz_status write_matrices(const writing *w) {
  static const struct {
    const char *name;
    cell_fn cell;
    int measure; /* that asks for it; the attractors come with all of them */
  } matrices[] = {
      {"branch_amplitude", amplitude_of, KZ_SWEEP_ATTRACTORS}, {"branch_multiplier", multiplier_of, KZ_SWEEP_ATTRACTORS},
      {"branch_theta", theta_of, KZ_SWEEP_ATTRACTORS},         {"branch_velocity", velocity_of, KZ_SWEEP_ATTRACTORS},
      {"fraction", fraction_of, KZ_SWEEP_BASIN_FRACTIONS},     {"fraction_low", low_of, KZ_SWEEP_BASIN_FRACTIONS},
      {"fraction_high", high_of, KZ_SWEEP_BASIN_FRACTIONS},    {"shock_angle", shock_angle_of, KZ_SWEEP_RESILIENCE},
      {"shock_kick", shock_kick_of, KZ_SWEEP_RESILIENCE},      {"shock_size", shock_size_of, KZ_SWEEP_RESILIENCE}};
  for (size_t i = 0; i < sizeof matrices / sizeof matrices[0]; i++)
    if (matrices[i].measure == KZ_SWEEP_ATTRACTORS || kz_sweep_measures(&w->scene->sweep, matrices[i].measure))
      KZ_TRY(write_matrix(w, matrices[i].name, matrices[i].cell));
  return KZ_OK;
}

/* The lowest and the highest share of a branch along its values. */
static void print_share(const writing *w, int64_t branch, FILE *summary) {
  double low = 1, high = 0;
  for (int64_t i = w->branches->first_node[branch]; i >= 0; i = w->branches->nodes[i].next) {
    const kz_sweep_node *node = w->branches->nodes + i;
    const double share = fraction_of(node, w->catalogue[node->value].samples);
    low = fmin(low, share);
    high = fmax(high, share);
  }
  fprintf(summary, "  %6.2f to %6.2f %%", 100 * low, 100 * high);
}

static void print_table(const writing *w, FILE *summary) {
  const kz_sweep_branches *b = w->branches;
  const bool shares = kz_sweep_measures(&w->scene->sweep, KZ_SWEEP_BASIN_FRACTIONS);
  if (b->n_branches == 0) {
    fprintf(summary, "no attractor at any value (without damping there are none)\n");
    return;
  }
  fprintf(summary, "branch  name                   from           begins by          to             ends by%s\n",
          shares ? "            share" : "");
  for (int64_t branch = 0; branch < b->n_branches; branch++) {
    char name[KZ_NAME_LENGTH];
    const kz_sweep_node *first = first_of(b, branch), *last = last_of(b, branch);
    name_of(b, branch, name);
    fprintf(summary, "%6lld  %-21s  %-13.9g  %-17s  %-13.9g  %-*s", (long long)branch, name, first->first,
            END_NAMES[first->first_kind], last->last, shares ? 17 : 0, END_NAMES[last->last_kind]);
    if (shares) print_share(w, branch, summary);
    fputc('\n', summary);
  }
}

kz_status kz_sweep_branches_write(const kz_scene *scene, const kz_sweep_catalogue *catalogue, const kz_sweep_branches *branches,
                                  kz_store *store, FILE *summary) {
  const writing w = {scene, catalogue, branches, store};
  KZ_TRY(kz_store_dimension(store, "sweep", "branch", branches->n_branches, NULL));
  KZ_TRY(write_names(&w));
  KZ_TRY(write_columns(&w));
  KZ_TRY(write_matrices(&w));
  print_table(&w, summary);
  return KZ_OK;
}
