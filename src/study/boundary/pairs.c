/* Pairs of starts beside each other: how many of them end differently, by their distance. */
#include <float.h>

#include "boundary.h"

enum {
  STARTS = 64, /* Starts of a tile, each with a partner at every distance */
  POINTS = STARTS * (1 + KZ_PAIR_DISTANCES)
};

/* Nearest pairs resolved by doubles and by pairs, rad, and by images of a window, share of its width. */
static const double nearest_of_doubles = 1e-12, nearest_of_pairs = 1e-25, nearest_of_images = 1e-18;

typedef struct {
  const kz_boundary_plan *pairs;
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
  const kz_part *deep; /* Part that makes starts whose partners lie in or about a deep window; else NULL */
  void *starts;        /* its own */
} pairing;

typedef struct {
  int64_t pairs[KZ_PAIR_DISTANCES], uncertain[KZ_PAIR_DISTANCES];
} pair_record;

/* Shares of the window from its lower left corner, and a distance more, rad and rad per drive radian. */
typedef struct {
  double share[2], offset[2];
} point;

/* The starts of a tile and their partners, and where they end. */
typedef struct {
  const pairing *pairing;
  point point[POINTS];
  kz_label end[POINTS];
} pair_tile;

int kz_distances_of(const kz_boundary_plan *plan) {
  return (int)plan->decades + 1;
}

/* Distance d, rad. */
static double distance_of(const kz_boundary_plan *plan, int d) {
  return pow(10, log10(plan->farthest) - d);
}

static double narrower_side(const kz_basin_plan *plan) {
  return fmin((double)kz_axis_width(&plan->theta), (double)kz_axis_width(&plan->velocity));
}

static bool is_exact(const kz_basin_plan *plan) {
  return isnan(plan->accuracy) && plan->method == KZ_METHOD_EXACT;
}

/* Whether doubles merge the window's cells and partners are within its width, so that images serve them. */
static bool is_within(const kz_basin_plan *plan, double farthest) {
  const bool is_deep = kz_axis_is_deep(&plan->theta) || kz_axis_is_deep(&plan->velocity);
  return is_exact(plan) && is_deep && farthest <= narrower_side(plan);
}

kz_status kz_boundary_check(const kz_scene *scene) {
  static const double rounding = 1.01;
  const kz_boundary_plan *pairs = scene->boundary;
  const kz_basin_plan *plan = scene->basin;
  const bool exact = is_exact(plan), within = is_within(plan, pairs->farthest);
  const double least = within  ? fmax(nearest_of_images * narrower_side(plan), DBL_MIN)
                       : exact ? nearest_of_pairs
                               : nearest_of_doubles,
               nearest = distance_of(pairs, (int)pairs->decades);
  const int most = (int)floor(log10(rounding * pairs->farthest / least));
  if (!(scene->parameters.pendulum.beta > 0) || rounding * nearest >= least) return KZ_OK;
  const char *what = within  ? "the images of this window do"
                     : exact ? "a pair of doubles does"
                             : "double precision does",
             *or = within  ? ""
                   : exact ? ", or farthest at most the width of a window whose cells doubles do not distinguish"
                           : ", or basin.method exact";
  if (most < KZ_BOUNDARY_FEWEST_DECADES)
    return kz_fail(KZ_REFUSED,
                   "basin.boundary.farthest: %g rad is too near: %s not distinguish starts that are nearer than %.0e "
                   "rad; it must be "
                   "%.0e at least%s",
                   pairs->farthest, what, least, least * pow(10, KZ_BOUNDARY_FEWEST_DECADES), or);
  return kz_fail(KZ_REFUSED,
                 "basin.boundary.decades: %lld go down to %.0e rad, which %s not distinguish; it must be %d at most%s",
                 (long long)pairs->decades, nearest, what, most, or);
}

/* Start i of an evenly spread sequence, its partners at n distances from `first` on, directions spread too. */
static void pairs_spread(const kz_boundary_plan *plan, int64_t i, int first, int n, point *p) {
  const double angle = 2 * M_PI * fmod((double)i * 0.61803398874989484820, 1);
  *p = (point){.share = {0}};
  kz_even_share(i, p->share);
  for (int d = 0; d < n; d++) {
    const double distance = distance_of(plan, first + d);
    p[1 + d] = (point){{p->share[0], p->share[1]}, {distance * cos(angle), distance * sin(angle)}};
  }
}

/* A kz_start_fn. What quad precision does not decide is labelled in it without its error, which acts like a change of
 * the start that is far below the smallest distance: such pairs would otherwise be missed among the uncertain. */
static kz_status start_at(void *context, int64_t i, kz_precision level, kz_start *start) {
  const pair_tile *t = context;
  const pairing *p = t->pairing;
  const kz_axis *const axes[] = {&p->plan->theta, &p->plan->velocity};
  const point *at = t->point + i;
  *start = (kz_start){.periods = 0};
  if (p->starts) {
    __float128 place[2];
    for (int axis = 0; axis < 2; axis++)
      place[axis] = ((__float128)at->share[axis] - 0.5) + at->offset[axis] / kz_axis_width(axes[axis]);
    p->deep->part->start_at(p->starts, level, place[0], place[1], start);
  } else {
    kz_axis_at(axes[0], at->share[0], at->offset[0], start->theta);
    kz_axis_at(axes[1], at->share[1], at->offset[1], start->velocity);
  }
  return KZ_OK;
}

static kz_labeller labeller_of(const pairing *p, pair_tile *t, bool exact) {
  return (kz_labeller){.dynamics = p->dynamics,
                       .max_periods = p->plan->max_periods,
                       .way = exact ? KZ_BY_LEVELS : KZ_BY_STATES,
                       .open = KZ_OPEN_IN_QUADS,
                       .start = start_at,
                       .context = t};
}

/* How many of the distances, the farthest first, doubles serve. Their map is one that is off by the error of a step,
 * for both starts of a pair alike, and rounding moves the starts by less than a hundredth of these distances: the
 * shares are right, whatever the labels of single starts are. In a window that is hardly wider than that error the
 * boundary itself would be moved. */
static int distances_of_doubles(const pairing *p) {
  static const double narrowest = 1e-9;
  int n = 0;
  if (p->plan->method == KZ_METHOD_EXACT && narrower_side(p->plan) < narrowest) return 0;
  while (n < kz_distances_of(p->pairs) && 1.01 * distance_of(p->pairs, n) >= nearest_of_doubles) n++;
  return n;
}

/* The pairs of n starts at distances first .. last - 1. */
static kz_status count_distances(pair_tile *t, int64_t from, int64_t n, int first, int last, bool exact,
                                 pair_record *out) {
  const int stride = 1 + last - first;
  const kz_labeller labeller = labeller_of(t->pairing, t, exact);
  if (first == last) return KZ_OK;
  for (int64_t i = 0; i < n; i++) pairs_spread(t->pairing->pairs, from + i, first, last - first, t->point + stride * i);
  KZ_TRY(kz_label_items(&labeller, 1, n * stride, NULL, t->end));
  for (int64_t i = 0; i < n; i++)
    for (int d = first; d < last; d++) {
      const int32_t own = t->end[stride * i].label, other = t->end[stride * i + 1 + d - first].label;
      out->pairs[d] += own > 0 && other > 0;
      out->uncertain[d] += own > 0 && other > 0 && own != other;
    }
  return KZ_OK;
}

static kz_status count_some(void *context, int64_t first, int64_t n, void *record) {
  const pairing *p = context;
  KZ_AUTOFREE pair_tile *t = kz_malloc(sizeof *t);
  const int doubles = distances_of_doubles(p);
  t->pairing = p;
  KZ_TRY(count_distances(t, first, n, 0, doubles, false, record));
  return count_distances(t, first, n, doubles, kz_distances_of(p->pairs), p->plan->method == KZ_METHOD_EXACT, record);
}

static pairing pairing_of(const kz_boundary_plan *plan, const kz_window_labels *labelling) {
  pairing p = {.pairs = plan, .plan = labelling->plan, .dynamics = labelling->dynamics};
  const double reach = 0.5 + plan->farthest / narrower_side(p.plan);
  for (int i = 0; is_within(p.plan, plan->farthest) && i < labelling->n_parts && !p.starts; i++) {
    p.deep = labelling->parts + i;
    if (p.deep->part->starts) p.starts = p.deep->part->starts(p.deep->own, reach);
  }
  return p;
}

kz_status kz_pairs_count(const kz_boundary_plan *plan, const kz_window_labels *labelling, kz_uncertain *uncertain) {
  pairing p = pairing_of(plan, labelling);
  const int64_t starts = (plan->pairs + STARTS - 1) / STARTS * STARTS; /* the last tile is whole */
  const kz_stage stage = kz_stage_of_items("pairs", starts, STARTS, sizeof(pair_record), count_some, &p);
  KZ_AUTOFREE pair_record *records = kz_malloc((size_t)stage.n_tiles * sizeof *records);
  kz_status status = kz_stage_run(labelling->run, &stage, records);
  for (int d = 0; d < kz_distances_of(plan); d++) {
    uncertain[d] = (kz_uncertain){.distance = distance_of(plan, d)};
    for (int64_t tile = 0; status == KZ_OK && tile < stage.n_tiles; tile++) {
      uncertain[d].pairs += records[tile].pairs[d];
      uncertain[d].uncertain += records[tile].uncertain[d];
    }
  }
  free(p.starts);
  return status;
}
