/* Curves: traced to both ends, known by a signature. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curves.h"
#include "cycles.h"

enum { MOST_ROWS = 1500, MOST_SPECIAL = 32, SAMPLES = 12 };
/* A point may lie on a curve if it is this near to one of its steps, in lengths of the step; it does if Newton's method
 * finds it from there, within so many sides of the plane, rad. Points of a cycle that are this near to each other may
 * be those of a shorter one, rad. */
static const double NEAR = 0.1, WEIGHT = 0.2, ROUNDING = 1e-9, SAME_PLACE = 1e-8, SAME = 1e-5, BLURRED = 1e-3;

void kz_atlas_curve_free(kz_atlas_curve *curve) {
  free(curve->row);
  free(curve->special);
  free(curve->signature);
  *curve = (kz_atlas_curve){0};
}

void kz_atlas_point_of(const kz_atlas_curve *curve, int64_t row, double *y) {
  const int n = 2 * curve->kind.of.points;
  const double *from = curve->row + row * kz_atlas_width(&curve->kind);
  memcpy(y, from + KZ_ROW_POINTS, (size_t)n * sizeof *y);
  y[n] = from[0], y[n + 1] = from[1];
}

void kz_atlas_complete(const kz_atlas *atlas, kz_atlas_curve *curve, int64_t row) {
  const int n = curve->kind.of.points;
  double state[2 * KZ_CURVE_POINTS + 2], *at = curve->row + row * kz_atlas_width(&curve->kind);
  memcpy(state, at + KZ_ROW_POINTS, 2 * sizeof *state);
  if (!kz_curve_orbit(&atlas->plane, at, 2, n - 1, state)) return;
  memcpy(state + 2 * n, at, 2 * sizeof *state);
  const kz_curve_kind of = kz_kind_of(&atlas->plane, curve->kind.of.side, n, curve->kind.of.stride, 1, state);
  const double lift = of.side < 0 ? M_PI * (curve->kind.of.turns - of.turns) : 0; /* a file has angles from -pi to pi */
  for (int i = 0; i < 2 * n; i++) at[KZ_ROW_POINTS + i] = state[i] + (i % 2 ? 0 : lift);
}

void kz_atlas_between(const kz_atlas_curve *curve, int64_t row, double share, double *y) {
  enum { TURNED = 1 }; /* rad: largest move of a point in a step; a closed curve may end in another point */
  const int n = 2 * curve->kind.of.points;
  double to[KZ_ATLAS_UNKNOWNS];
  kz_atlas_point_of(curve, row, y);
  kz_atlas_point_of(curve, row + 1, to);
  const double lift = 2 * M_PI * rint((to[0] - y[0]) / (2 * M_PI)); /* where two parts of a curve were put together */
  bool other = false;
  for (int i = 0; i < n; i++) other = other || fabs(to[i] - (i % 2 ? 0 : lift) - y[i]) > TURNED;
  for (int i = 0; i < n && !other; i++) y[i] += share * (to[i] - (i % 2 ? 0 : lift) - y[i]);
}

/* One direction of a curve: its rows, and its special points, of which *n_special are there already. */
static int64_t trace_side(const kz_atlas *atlas, const kz_plane_cycle *seed, int32_t direction, double *row,
                          double *special, int64_t *n_special, int32_t *ending) {
  int64_t more;
  const int64_t n = kz_curve_trace(
      &atlas->plane, &seed->kind.of, seed->y, direction, atlas->longest, MOST_ROWS, row, MOST_SPECIAL - *n_special,
      special + *n_special * (KZ_SPECIAL_POINTS + 2 * seed->kind.of.points), &more, ending);
  *n_special += more;
  return n;
}

static void trace_both(const kz_atlas *atlas, const kz_plane_cycle *seed, kz_atlas_curve *curve) {
  const int64_t width = kz_atlas_width(&seed->kind), special_width = KZ_SPECIAL_POINTS + 2 * seed->kind.of.points;
  KZ_AUTOFREE double *back = kz_malloc(MOST_ROWS * (size_t)width * sizeof *back);
  KZ_AUTOFREE double *on = kz_malloc(MOST_ROWS * (size_t)width * sizeof *on);
  int64_t n_back = 0, n_on;
  *curve = (kz_atlas_curve){.kind = seed->kind};
  curve->special = kz_malloc(MOST_SPECIAL * (size_t)special_width * sizeof *curve->special);
  n_on = trace_side(atlas, seed, 1, on, curve->special, &curve->n_special, &curve->ending[1]);
  curve->ending[0] = curve->ending[1];
  if (n_on > 0 && curve->ending[1] != KZ_TRACE_CLOSED)
    n_back = trace_side(atlas, seed, -1, back, curve->special, &curve->n_special, &curve->ending[0]);
  curve->row = kz_malloc((size_t)((n_on + n_back + 1) * width) * sizeof *curve->row);
  for (int64_t i = n_back - 1; i > 0; i--) { /* the seed's own row is also the first of the other direction */
    double *to = memcpy(curve->row + curve->n++ * width, back + i * width, (size_t)width * sizeof *to);
    to[KZ_ROW_TANGENT] = -to[KZ_ROW_TANGENT];
    to[KZ_ROW_TANGENT + 1] = -to[KZ_ROW_TANGENT + 1];
  }
  memcpy(curve->row + curve->n * width, on, (size_t)(n_on * width) * sizeof *on);
  curve->n += n_on;
  if (curve->ending[1] == KZ_TRACE_CLOSED) /* the last step has passed the start: it ends there */
    memcpy(curve->row + (curve->n - 1) * width, curve->row, (size_t)width * sizeof *curve->row);
}

/* Traces the seed's curve, or the curve of shorter cycles beside it, along which the longer cycle has few digits. */
void kz_atlas_trace(const kz_atlas *atlas, const kz_plane_cycle *seed, kz_atlas_curve *curve) {
  kz_atlas_seeds one = {0};
  trace_both(atlas, seed, curve);
  if (curve->n == 0 || seed->kind.rest >= 0) return;
  kz_plane_cycle middle = {.kind = seed->kind};
  kz_atlas_point_of(curve, curve->n / 2, middle.y);
  if (!kz_atlas_reduce(atlas, BLURRED, &middle.kind, middle.y)) return;
  kz_atlas_curve_free(curve);
  *curve = (kz_atlas_curve){.kind = seed->kind,
                            .ending = {KZ_TRACE_MERGED, KZ_TRACE_MERGED},
                            .row = kz_calloc(1, sizeof *curve->row),
                            .special = kz_calloc(1, sizeof *curve->special)};
  if (kz_atlas_add(atlas, middle.kind, middle.y, &one)) {
    kz_atlas_curve_free(curve);
    trace_both(atlas, one.list, curve);
  }
  kz_atlas_seeds_free(&one);
}

/* A cycle that is not its own image half a period later has other strobe points than this: both count. */
static void signature_of(const kz_atlas *atlas, const kz_cycle_kind *kind, const double *place, const double *y,
                         double *signature) {
  double cosine = 0, energy = 0, both = 0, point[4 * KZ_CURVE_POINTS];
  int n = atlas->plane.half_period ? kz_atlas_points(atlas, kind, place, y, point) : kind->of.points;
  if (!atlas->plane.half_period) memcpy(point, y, 2 * (size_t)n * sizeof *point);
  for (int i = 0; i < kind->of.points && atlas->plane.half_period && kind->of.side > 0; i++)
    n += kz_atlas_image_state(atlas, place, y + 2 * i, point + 2 * n);
  for (int i = 0; i < n; i++) {
    const double c = cos(point[2 * i]), v = point[2 * i + 1];
    cosine += c;
    energy += v * v;
    both += v * v * c;
  }
  const double scale = WEIGHT / fmax(n, 1);
  const double all[KZ_SIGNATURE] = {place[0], place[1], scale * cosine, scale * energy, scale * both};
  memcpy(signature, all, sizeof all);
}

void kz_atlas_sign(const kz_atlas *atlas, kz_atlas_curve *curve) {
  const int64_t width = kz_atlas_width(&curve->kind);
  curve->signature = kz_malloc((size_t)(curve->n + 1) * sizeof *curve->signature);
  for (int64_t i = 0; i < curve->n; i++)
    signature_of(atlas, &curve->kind, curve->row + i * width, curve->row + i * width + KZ_ROW_POINTS,
                 curve->signature[i]);
}

/* Whether a point lies on a step of a curve: Newton's method from the step's own cycle there ends at it. */
static bool is_of_step(const kz_atlas *atlas, const kz_atlas_curve *curve, int64_t row, double share,
                       const kz_plane_cycle *seed) {
  const int n = 2 * curve->kind.of.points;
  const double *a = curve->row + row * kz_atlas_width(&curve->kind), *b = a + kz_atlas_width(&curve->kind);
  const double step[2] = {b[0] - a[0], b[1] - a[1]};
  const double along[2] = {fabs(step[0]) < fabs(step[1]), fabs(step[0]) >= fabs(step[1])};
  double y[KZ_ATLAS_UNKNOWNS], at_image[2];
  kz_atlas_between(curve, row, share, y);
  memcpy(y + n, seed->y + n, 2 * sizeof *y);
  kz_plane_cycle found = {.kind = curve->kind};
  if (!kz_curve_locate(&atlas->plane, &curve->kind.of, y, along)) return false;
  memcpy(found.y, y, ((size_t)n + 2) * sizeof *y);
  const double *image = kz_atlas_image_state(atlas, seed->y + n, seed->y, at_image) ? at_image : NULL;
  return hypot(y[n] - seed->y[n], y[n + 1] - seed->y[n + 1]) < SAME_PLACE &&
         kz_atlas_same(&found, seed->y, image, SAME);
}

/* Whether a point lies on a curve. */
static bool is_on(const kz_atlas *atlas, const kz_atlas_curve *curve, const kz_plane_cycle *seed,
                  const double *signature) {
  for (int64_t i = 0; i + 1 < curve->n; i++) {
    const double *a = curve->signature[i], *b = curve->signature[i + 1];
    double length = 1e-30, along = 0, off = 0;
    if (fabs(a[0] - signature[0]) > 0.1 || fabs(a[1] - signature[1]) > 0.1) continue;
    for (int c = 0; c < KZ_SIGNATURE; c++) {
      length += (b[c] - a[c]) * (b[c] - a[c]);
      along += (signature[c] - a[c]) * (b[c] - a[c]);
    }
    const double share = fmin(1, fmax(0, along / length));
    for (int c = 0; c < KZ_SIGNATURE; c++) {
      const double d = signature[c] - a[c] - share * (b[c] - a[c]);
      off += d * d;
    }
    if (sqrt(off) < NEAR * sqrt(length) + ROUNDING && is_of_step(atlas, curve, i, share, seed)) return true;
  }
  return false;
}

static bool is_alike(const kz_cycle_kind *a, const kz_cycle_kind *b) {
  return !memcmp(a, b, sizeof *a);
}

int64_t kz_atlas_known(const kz_atlas *atlas, const kz_plane_cycle *seed) {
  double signature[KZ_SIGNATURE];
  signature_of(atlas, &seed->kind, seed->y + 2 * seed->kind.of.points, seed->y, signature);
  for (int64_t i = 0; i < atlas->n_curves; i++)
    if (is_alike(&atlas->curve[i].kind, &seed->kind) && is_on(atlas, atlas->curve + i, seed, signature)) return i;
  return -1;
}

/* Number of some points of a curve that lie on another one. */
static int64_t curve_common(const kz_atlas *atlas, const kz_atlas_curve *curve, const kz_atlas_curve *other,
                            int64_t *tried) {
  const int64_t step = curve->n > SAMPLES ? curve->n / SAMPLES : 1;
  kz_plane_cycle at = {.kind = curve->kind};
  int64_t on = 0;
  *tried = 0;
  for (int64_t row = 0; row < curve->n; row += step, ++*tried) {
    kz_atlas_point_of(curve, row, at.y);
    on += is_on(atlas, other, &at, curve->signature[row]);
  }
  return on;
}

bool kz_atlas_keep(kz_atlas *atlas, kz_atlas_curve *curve) {
  kz_atlas_sign(atlas, curve);
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    int64_t tried;
    if (!is_alike(&atlas->curve[i].kind, &curve->kind)) continue;
    if (10 * curve_common(atlas, curve, atlas->curve + i, &tried) <= 6 * tried) continue;
    kz_atlas_curve_free(curve);
    return false;
  }
  atlas->curve = kz_list_reserve(atlas->curve, &atlas->curve_capacity, atlas->n_curves + 1, sizeof *atlas->curve);
  atlas->curve[atlas->n_curves++] = *curve;
  return true;
}

/* The nearest degenerate point of any curve to a place, within a few steps; NULL = none. */
static const double *degenerate_near(const kz_atlas *atlas, const double *place) {
  const double *nearest = NULL;
  double least = 2.5 * atlas->longest;
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    const kz_atlas_curve *curve = atlas->curve + i;
    const int64_t width = KZ_SPECIAL_POINTS + 2 * curve->kind.of.points;
    for (int64_t s = 0; s < curve->n_special && curve->kind.of.multiplier < 0; s++) {
      const double *at = curve->special + s * width + 1, d = hypot(at[0] - place[0], at[1] - place[1]);
      if (d < least) least = d, nearest = at;
    }
  }
  return nearest;
}

static void curve_extend(kz_atlas_curve *curve, bool at_end, const double *place) {
  const int64_t width = kz_atlas_width(&curve->kind), bytes = width * (int64_t)sizeof *curve->row;
  curve->row = kz_realloc(curve->row, (size_t)((curve->n + 1) * bytes));
  double *to = curve->row + (at_end ? curve->n * width : 0);
  if (!at_end) memmove(curve->row + width, curve->row, (size_t)(curve->n * bytes));
  if (at_end) memcpy(to, to - width, (size_t)bytes);
  to[KZ_ROW_PLACE] = place[0];
  to[KZ_ROW_PLACE + 1] = place[1];
  to[KZ_ROW_TANGENT] = to[KZ_ROW_TANGENT + 1] = 0; /* the last step is straight */
  curve->n++;
}

void kz_atlas_join(kz_atlas *atlas) {
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    kz_atlas_curve *curve = atlas->curve + i;
    for (int end = 0; end < 2; end++) {
      if (curve->kind.of.multiplier < 0 ||
          (curve->ending[end] != KZ_TRACE_MERGED && curve->ending[end] != KZ_TRACE_STUCK))
        continue;
      const double *last = curve->row + (end ? curve->n - 1 : 0) * kz_atlas_width(&curve->kind);
      const double *place = degenerate_near(atlas, last);
      if (!place) continue;
      curve_extend(curve, end, place);
      curve->ending[end] = KZ_ATLAS_JOINED;
    }
  }
}

int kz_atlas_open_ends(const kz_atlas_curve *curve) {
  int open = 0;
  for (int end = 0; end < 2; end++) {
    const double *place = curve->row + (end ? curve->n - 1 : 0) * kz_atlas_width(&curve->kind);
    const bool within = place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 1;
    open += within && curve->ending[end] != KZ_TRACE_CLOSED && curve->ending[end] != KZ_TRACE_THIN &&
            curve->ending[end] != KZ_ATLAS_JOINED;
  }
  return open;
}
