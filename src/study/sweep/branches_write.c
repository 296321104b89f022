/* Branches of a sweep into the file, and a table of them for people. */
#include "numerics/share.h"
#include "sweep.h"

static const char *const END_NAMES[] = {"end of range",      "fold",        "period doubling", "Neimark-Sacker",
                                        "symmetry breaking", "not located", "homoclinic"};

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
  const kz_attractor *point = &first_of(b, branch)->entry.point;
  kz_orbit_name(point->period, point->winding, point->centre, text);
}

static bool branches_write_mirrors(const writing *w, const kz_pendulum *pendulum, const kz_sweep_node *node,
                                   const kz_attractor *image) {
  const kz_attractor *point = &node->entry.point;
  if (image->period == 0)
    return kz_branch_alike(point, image) && fabs(point->velocity - image->velocity) < 1e-3 &&
           fabs(point->theta - image->theta) < 1e-3;
  return kz_branch_same(w->branches->maps, pendulum, point, image);
}

/* The branch that holds the image of this one's first cycle; -1 where none does. */
static int32_t mirror_of(const writing *w, int64_t branch) {
  const kz_sweep_node *first = first_of(w->branches, branch);
  kz_pendulum pendulum;
  if (first->entry.point.symmetric) return (int32_t)branch;
  if (first->between || !kz_sweep_pendulum(w->scene, kz_sweep_value(w->scene->sweep, first->value), &pendulum) ||
      !kz_pairing_symmetry(&pendulum))
    return -1;
  const kz_attractor image = kz_branch_point_image(&pendulum, first->entry.point);
  for (int64_t other = 0; other < w->branches->n_branches; other++) {
    const kz_sweep_node *node = first_of(w->branches, other);
    while (node->value < first->value && node->next >= 0) node = w->branches->nodes + node->next;
    if (node->value == first->value && !node->between && branches_write_mirrors(w, &pendulum, node, &image))
      return (int32_t)other;
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
  COLUMN(int8_t, "branch_stable", first_of(b, i)->attracts);
  COLUMN(int32_t, "branch_mirror", mirror_of(w, i));
  COLUMN(double, "branch_start", first_of(b, i)->first);
  COLUMN(double, "branch_end", last_of(b, i)->last);
  COLUMN(int8_t, "branch_start_kind", first_of(b, i)->first_kind);
  COLUMN(int8_t, "branch_end_kind", last_of(b, i)->last_kind);
  return KZ_OK;
}

static kz_status write_names(const writing *w) {
  const int64_t n = w->branches->n_branches;
  KZ_AUTOFREE char (*names)[KZ_NAME_LENGTH] = kz_calloc((size_t)n + 1, sizeof *names);
  for (int64_t i = 0; i < n; i++) name_of(w->branches, i, names[i]);
  KZ_COLUMN(w->store, "sweep", "branch_name", n, const char *, names[i]);
  return KZ_OK;
}

/* The entry of each branch at each value, [values][branches]; NULL = not there. */
static const kz_sweep_entry **branches_write_arrange(const writing *w, int64_t n) {
  const kz_sweep_branches *b = w->branches;
  const kz_sweep_entry **at = kz_calloc((size_t)n + 1, sizeof *at);
  for (int64_t branch = 0; branch < b->n_branches; branch++)
    for (int64_t i = b->first_node[branch]; i >= 0; i = b->nodes[i].next)
      if (w->catalogue[b->nodes[i].value].samples > 0 && !b->nodes[i].between)
        at[b->nodes[i].value * b->n_branches + branch] = &b->nodes[i].entry;
  return at;
}

#define MATRIX(name, expression) KZ_COLUMN(w->store, "sweep", name, n, double, at[i] ? (expression) : NAN)
#define SHARED(name, expression) MATRIX(name, is_stable[i % n_branches] ? (expression) : NAN)
#define SHARE kz_share_of(at[i]->hits, w->catalogue[i / w->branches->n_branches].samples)

static kz_status write_matrices(const writing *w) {
  const kz_sweep_plan *plan = w->scene->sweep;
  const int64_t n_branches = w->branches->n_branches, n = plan->values.count * n_branches;
  KZ_AUTOFREE bool *is_stable = kz_malloc((size_t)n_branches + 1);
  for (int64_t i = 0; i < n_branches; i++) is_stable[i] = first_of(w->branches, i)->attracts;
  KZ_AUTOFREE const kz_sweep_entry **at = branches_write_arrange(w, n);
  MATRIX("branch_amplitude", at[i]->point.centre > 1 ? NAN : at[i]->point.amplitude);
  MATRIX("branch_multiplier",
         at[i]->point.period == 0 ? NAN : hypot(at[i]->point.multiplier_re[0], at[i]->point.multiplier_im[0]));
  MATRIX("branch_theta", kz_is_running(&at[i]->point) ? NAN : at[i]->point.theta);
  MATRIX("branch_velocity", at[i]->point.velocity);
  if (kz_sweep_measures(plan, KZ_SWEEP_BASIN_FRACTIONS)) {
    SHARED("fraction", SHARE.share);
    SHARED("fraction_low", SHARE.low);
    SHARED("fraction_high", SHARE.high);
  }
  const kz_sweep_part *part;
  for (int p = 0; (part = kz_sweep_part_next(plan, true, &p)); p++)
    for (int k = 0; part->numbers && part->numbers[k]; k++) MATRIX(part->numbers[k], at[i]->number[k]);
  return KZ_OK;
}

#define OF_VALUE(name, expression) \
  KZ_COLUMN(w->store, "sweep", name, plan->values.count, double, w->catalogue[i].samples > 0 ? (expression) : NAN)
#define UNSETTLED ((double)w->catalogue[i].unsettled / (double)w->catalogue[i].samples)

/* Measures of the values themselves: lifetimes, and shares that end alike at all phases. */
static kz_status write_values(const writing *w) {
  const kz_sweep_plan *plan = w->scene->sweep;
  if (kz_sweep_measures(plan, KZ_SWEEP_LIFETIME)) {
    OF_VALUE("lifetime", w->catalogue[i].lifetime.mean);
    OF_VALUE("lifetime_low", w->catalogue[i].lifetime.low);
    OF_VALUE("lifetime_high", w->catalogue[i].lifetime.high);
    OF_VALUE("lifetime_after", w->catalogue[i].lifetime.from);
    OF_VALUE("lifetime_open", w->catalogue[i].lifetime.open);
  }
  OF_VALUE("fraction_unsettled", UNSETTLED);
  const kz_sweep_part *part;
  for (int p = 0; (part = kz_sweep_part_next(plan, true, &p)); p++)
    for (int k = 0; part->of_values && part->of_values[k]; k++)
      OF_VALUE(part->of_values[k], w->catalogue[i].of_value[k]);
  return KZ_OK;
}

/* The lowest and the highest share of a branch along its values. */
static void print_share(const writing *w, int64_t branch, FILE *summary) {
  double low = 1, high = 0;
  for (int64_t i = w->branches->first_node[branch]; i >= 0; i = w->branches->nodes[i].next) {
    const kz_sweep_node *node = w->branches->nodes + i;
    const double share = (double)node->entry.hits / (double)w->catalogue[node->value].samples;
    low = fmin(low, share);
    high = fmax(high, share);
  }
  fprintf(summary, "  %6.2f to %6.2f %%", 100 * low, 100 * high);
}

/* The share of what ends on no branch, at the values where there is any. */
static void print_unsettled(const writing *w, FILE *summary) {
  double low = 1, high = 0;
  int64_t values = 0;
  for (int64_t i = 0; i < w->scene->sweep->values.count; i++) {
    if (w->catalogue[i].unsettled == 0) continue;
    values++;
    low = fmin(low, UNSETTLED);
    high = fmax(high, UNSETTLED);
  }
  if (values > 0)
    fprintf(
        summary,
        "at %lld values %.2f to %.2f %% of the starts or cells end on nothing known (fraction_unsettled in the file)\n",
        (long long)values, 100 * low, 100 * high);
}

static void print_table(const writing *w, FILE *summary) {
  const kz_sweep_branches *b = w->branches;
  const kz_axis *values = &w->scene->sweep->values;
  const bool shares = kz_sweep_measures(w->scene->sweep, KZ_SWEEP_BASIN_FRACTIONS);
  if (b->n_branches == 0) {
    fprintf(summary, "no attractor at any value (without damping there are none)\n");
    return;
  }
  fprintf(summary, "branch  name                   from           begins by          to             ends by%s\n",
          shares ? "            share" : "");
  int64_t repelling = 0;
  for (int64_t branch = 0; branch < b->n_branches; branch++) {
    char name[KZ_NAME_LENGTH];
    const kz_sweep_node *first = first_of(b, branch), *last = last_of(b, branch);
    if (!first->attracts) {
      repelling++;
      continue;
    }
    name_of(b, branch, name);
    fprintf(summary, "%6lld  %-21s  %-13.9g  %-17s  %-13.9g  %-*s", (long long)branch, name,
            kz_axis_written(values, first->first), END_NAMES[first->first_kind], kz_axis_written(values, last->last),
            shares ? 17 : 0, END_NAMES[last->last_kind]);
    if (shares && !first->between) print_share(w, branch, summary);
    fputc('\n', summary);
  }
  if (repelling > 0)
    fprintf(summary, "and %lld that %s (branch_stable = 0 in the file)\n", (long long)repelling,
            repelling == 1 ? "repels" : "repel");
}

kz_status kz_sweep_branches_write(const kz_scene *scene, const kz_sweep_catalogue *catalogue,
                                  const kz_sweep_branches *branches, kz_store *store, FILE *summary) {
  const writing w = {scene, catalogue, branches, store};
  KZ_TRY(kz_store_dimension(store, "sweep", "branch", branches->n_branches, NULL));
  KZ_TRY(write_names(&w));
  KZ_TRY(write_columns(&w));
  KZ_TRY(write_matrices(&w));
  print_table(&w, summary);
  print_unsettled(&w, summary);
  return write_values(&w);
}
