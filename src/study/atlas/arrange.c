/* The arrangement of the curves: which attractors a place has, by counting crossings of its column from below. */
#include "lines.h"
#include "curves.h"
#include "cycles.h"
#include "seeds.h"

/* Tangents shorter than this end at a cusp: steps beside it are straight. */
static const double AT_CUSP = 0.02;
/* The band of what branches off, in those of what it branches off from: of x^2 + c, where bands are narrow. */
static const double GROWN = 0.5;
/* No rest attracts without drive where abs(k) is smaller; how far beside such a place a column is counted. */
static const double NO_GRAVITY = 1e-9, BESIDE = 1e-8;

static void arrange_add(kz_atlas_crossings *crossings, kz_atlas_crossing crossing) {
  crossings->list =
      kz_list_reserve(crossings->list, &crossings->capacity, crossings->count + 1, sizeof *crossings->list);
  crossings->list[crossings->count++] = crossing;
}

/* A step of a curve as a cubic; component c at s: p[c][0] + p[c][1] s + .. */
typedef struct {
  double p[2][4];
} cubic;

static double cubic_value(const double *p, double s) {
  return p[0] + s * (p[1] + s * (p[2] + s * p[3]));
}

static double arrange_slope(const double *p, double s) {
  return p[1] + s * (2 * p[2] + s * 3 * p[3]);
}

static cubic cubic_of(const kz_curve_row *row) {
  const double *a = row[0].at.place, *b = row[1].at.place, *ta = row[0].tangent, *tb = row[1].tangent;
  const double chord[2] = {b[0] - a[0], b[1] - a[1]};
  const double la = hypot(ta[0], ta[1]), lb = hypot(tb[0], tb[1]), length = hypot(chord[0], chord[1]);
  const bool straight = la <= AT_CUSP || lb <= AT_CUSP || ta[0] * tb[0] + ta[1] * tb[1] < 0;
  cubic c;
  for (int i = 0; i < 2; i++) {
    const double from = straight ? chord[i] : ta[i] / la * length, to = straight ? chord[i] : tb[i] / lb * length;
    c.p[i][0] = a[i];
    c.p[i][1] = from;
    c.p[i][2] = 3 * chord[i] - 2 * from - to;
    c.p[i][3] = from + to - 2 * chord[i];
  }
  return c;
}

/* The root of a monotone piece, by bisection and secants. */
static double root_between(const double *p, double target, double low, double high) {
  double at_low = cubic_value(p, low) - target;
  for (int i = 0; i < 60 && high - low > 1e-15; i++) {
    const double middle = 0.5 * (low + high), at = cubic_value(p, middle) - target;
    if ((at < 0) == (at_low < 0))
      low = middle, at_low = at;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

/* Parameters at which a cubic has the value, in its monotone pieces between turns. Ends belong to the side < . */
static int roots_of(const double *p, double target, double *root) {
  double cut[4] = {0}, d = p[2] * p[2] - 3 * p[3] * p[1];
  int cuts = 1, n = 0;
  if (d > 0) {
    const double q = -(p[2] + (p[2] > 0 ? sqrt(d) : -sqrt(d)));
    double turn[2] = {p[3] != 0 ? q / (3 * p[3]) : -1, q != 0 ? p[1] / q : -1};
    if (turn[0] > turn[1]) {
      const double swap = turn[0];
      turn[0] = turn[1], turn[1] = swap;
    }
    for (int i = 0; i < 2; i++)
      if (turn[i] > 0 && turn[i] < 1) cut[cuts++] = turn[i];
  }
  cut[cuts++] = 1;
  for (int i = 0; i + 1 < cuts; i++)
    if ((cubic_value(p, cut[i]) < target) != (cubic_value(p, cut[i + 1]) < target))
      root[n++] = root_between(p, target, cut[i], cut[i + 1]);
  return n;
}

/* End of a step that determines the side, at a point with this normal form. At a cusp a fold turns back with its side.
 * It goes straight on where its side changes at a place without a drive: from there two folds begin on either side,
 * between which a rotation is held. */
static const kz_curve_row *side_of(const kz_curve_row *row, double form) {
  const double *ta = row[0].tangent, *tb = row[1].tangent, a = row[0].form.coefficient, b = row[1].form.coefficient;
  const bool changes = row->at.kind.multiplier > 0 && a * b < 0 && ta[0] * tb[0] + ta[1] * tb[1] > 0;
  if (changes) return (form > 0) == (a > 0) ? row : row + 1;
  return fabs(a) >= fabs(b) ? row : row + 1;
}

/* Records the change of attractors where a step of a curve crosses the line. */
static void arrange_cross(kz_atlas *atlas, int64_t number, int64_t row, int axis, double target, bool classes,
                          kz_atlas_crossings *crossings) {
  const kz_atlas_curve *curve = atlas->curve + number;
  const kz_curve_row *a = curve->row + row, *b = a + 1;
  const int other = 1 - axis;
  const cubic c = cubic_of(a);
  double root[3];
  const int n = roots_of(c.p[axis], target, root);
  for (int i = 0; i < n; i++) {
    if (!classes) {
      arrange_add(
          crossings,
          (kz_atlas_crossing){.at = cubic_value(c.p[other], root[i]), .curve = number, .row = row, .share = root[i]});
      continue;
    }
    const double s = root[i], form = a->form.coefficient + s * (b->form.coefficient - a->form.coefficient);
    const kz_curve_row *by = side_of(a, form);
    const double end = by == a ? 0 : 1;
    /* Normal turned from the tangent, with the sign that it has where the side is known */
    const double known = -arrange_slope(c.p[1], end) * by->form.side[0] + arrange_slope(c.p[0], end) * by->form.side[1];
    const double normal[2] = {-arrange_slope(c.p[1], s), arrange_slope(c.p[0], s)};
    const int change = (normal[other] > 0) == (known > 0) ? 1 : -1;
    const kz_atlas_class own = kz_atlas_class_of(&curve->kind);
    kz_pendulum pendulum;
    const bool there =
        kz_atlas_pendulum(atlas->scene, a->at.place, &pendulum); /* a little outside of the plane there may be none */
    const double d = there ? kz_kind_determinant(&curve->kind, pendulum.beta) : 0;
    const double wide[2] = {kz_atlas_band(&curve->kind, d, a->form.coefficient, fabs(a->form.side[other])),
                            kz_atlas_band(&curve->kind, d, b->form.coefficient, fabs(b->form.side[other]))};
    kz_atlas_crossing crossing = {.at = cubic_value(c.p[other], s),
                                  .width = exp((1 - s) * log(wide[0]) + s * log(wide[1])),
                                  .class = kz_atlas_class_number(atlas, &own),
                                  .change = change,
                                  .curve = number,
                                  .row = row,
                                  .share = s};
    arrange_add(crossings, crossing);
    if (curve->kind.multiplier > 0 || form <= 0) continue;
    const kz_cycle_kind child = kz_child_kind(&curve->kind);
    if (kz_kind_period(&child) > atlas->scene->atlas->max_period) continue;
    const kz_atlas_class grown = kz_atlas_class_of(&child);
    crossing.class = kz_atlas_class_number(atlas, &grown);
    crossing.change = -change;
    crossing.width *= GROWN;
    arrange_add(crossings, crossing);
  }
}

void kz_atlas_crossings_of(kz_atlas *atlas, int axis, double target, bool classes, kz_atlas_crossings *crossings) {
  crossings->count = 0;
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    const kz_atlas_curve *curve = atlas->curve + i;
    for (int64_t row = 0; row + 1 < curve->n; row++) {
      const double a = curve->row[row].at.place[axis], b = curve->row[row + 1].at.place[axis];
      const double beyond = fabs(b - a) + 1e-3;
      if (fmin(a, b) - beyond <= target && target <= fmax(a, b) + beyond)
        arrange_cross(atlas, i, row, axis, target, classes, crossings);
    }
  }
  if (crossings->count > 0)
    qsort(crossings->list, (size_t)crossings->count, sizeof *crossings->list, kz_atlas_compare_crossings);
  if (classes) kz_atlas_pair(crossings);
}

bool kz_atlas_crossing_point(const kz_atlas *atlas, int axis, double value, const kz_atlas_crossing *crossing,
                             kz_cycle *at) {
  const kz_atlas_curve *curve = atlas->curve + crossing->curve;
  for (int i = 0; i < 2 && !curve->signature; i++) kz_atlas_complete(atlas, &curve->row[crossing->row + i].at);
  *at = kz_atlas_between(curve->row + crossing->row, crossing->share);
  at->place[axis] = crossing->at, at->place[1 - axis] = value;
  if (!curve->kind.rest) kz_cycle_close(&atlas->plane, at);
  return kz_cycle_locate(&atlas->plane, at, (double[]){axis == 0, axis == 1}) &&
         fabs(at->place[axis] - crossing->at) < 1e-3;
}

double kz_atlas_floor(const kz_atlas *atlas) {
  return atlas->undriven ? 0 : atlas->reference[1];
}

/* Adds the changes between two values of a line, up (1) or down (-1). */
void kz_atlas_changes(const kz_atlas_crossings *crossings, double from, double to, int32_t *counts) {
  for (int64_t i = 0; i < crossings->count; i++) {
    const kz_atlas_crossing *c = crossings->list + i;
    if (c->at > from && c->at <= to) counts[c->class] += c->change;
    if (c->at > to && c->at <= from) counts[c->class] -= c->change;
  }
}

void kz_atlas_crossings_free(kz_atlas_crossings *crossings) {
  free(crossings->list);
}

double kz_atlas_column(const kz_atlas *atlas, double x) {
  kz_pendulum pendulum;
  const double place[2] = {x, 0};
  if (!atlas->undriven || !kz_atlas_pendulum(atlas->scene, place, &pendulum) || fabs(pendulum.k) > NO_GRAVITY) return x;
  return x < 0.5 ? x + BESIDE : x - BESIDE;
}

void kz_atlas_base(kz_atlas *atlas, double x, int32_t *counts) {
  memset(counts, 0, KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  if (!atlas->undriven) {
    KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings crossings = {0};
    memcpy(counts, atlas->at_reference, KZ_ATLAS_MOST_CLASSES * sizeof *counts);
    kz_atlas_crossings_of(atlas, 1, atlas->reference[1], true, &crossings);
    kz_atlas_changes(&crossings, atlas->reference[0], x, counts);
    return;
  }
  kz_pendulum pendulum;
  const double place[2] = {x, 0};
  if (!kz_atlas_pendulum(atlas->scene, place, &pendulum)) return;
  const kz_atlas_class rest =
      kz_atlas_class_with(kz_atlas_paired(atlas), 1, 0, pendulum.k < 0 ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN);
  counts[kz_atlas_class_number(atlas, &rest)] = 1;
}

bool kz_atlas_plausible(const kz_atlas *atlas, const int32_t *counts) {
  for (int32_t c = 0; c < atlas->n_classes; c++)
    if (counts[c] < 0) return false;
  return true;
}

void kz_atlas_count(kz_atlas *atlas, const double place[2], int32_t *counts) {
  KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings crossings = {0};
  const double x = kz_atlas_column(atlas, place[0]);
  kz_atlas_base(atlas, x, counts);
  kz_atlas_crossings_of(atlas, 0, x, true, &crossings);
  kz_atlas_changes(&crossings, kz_atlas_floor(atlas), place[1], counts);
}
