/* Curves: traced to both ends, known by a signature. */
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

void kz_atlas_complete(const kz_atlas *atlas, kz_cycle *row) {
  const int n = row->kind.points, turns = row->kind.turns;
  if (!kz_curve_orbit(&atlas->plane, row->place, 2, n - 1, row->point[0])) return;
  const bool closes = kz_cycle_close(&atlas->plane, row);
  const double lift =
      closes && row->kind.side < 0 ? M_PI * (turns - row->kind.turns) : 0; /* a file has angles from -pi to pi */
  row->kind.turns = turns;
  for (int i = 0; i < n; i++) row->point[i][0] += lift;
}

kz_cycle kz_atlas_between(const kz_curve_row *row, double share) {
  enum {
    TURNED = 1
  }; /* rad: no point moves so far in a step; the last row of a closed curve may begin with another point */
  const kz_cycle *from = &row[0].at, *to = &row[1].at;
  const double lift =
      2 * M_PI * rint((to->point[0][0] - from->point[0][0]) / (2 * M_PI)); /* where two parts were put together */
  kz_cycle at = *from;
  bool other = false;
  for (int i = 0; i < from->kind.points; i++)
    other = other || fabs(to->point[i][0] - lift - from->point[i][0]) > TURNED ||
            fabs(to->point[i][1] - from->point[i][1]) > TURNED;
  for (int i = 0; i < from->kind.points && !other; i++)
    for (int c = 0; c < 2; c++) at.point[i][c] += share * (to->point[i][c] - (c ? 0 : lift) - at.point[i][c]);
  return at;
}

/* One direction of a curve: its rows, and its special points, of which the curve has some already. Returns how many
 * rows. */
static int64_t trace_side(const kz_atlas *atlas, const kz_cycle *seed, int32_t direction, kz_curve_row *row,
                          kz_atlas_curve *curve) {
  const kz_branch_way way = {
      .longest = atlas->longest, .most = MOST_ROWS, .most_events = MOST_SPECIAL - curve->n_special, .side = direction};
  kz_branch_end end;
  kz_curve_trace(&atlas->plane, seed, &way, row, curve->special + curve->n_special, &end);
  curve->n_special += end.events;
  curve->ending[direction > 0] = end.ending;
  return end.rows;
}

static void trace_both(const kz_atlas *atlas, const kz_cycle *seed, kz_atlas_curve *curve) {
  KZ_AUTOFREE kz_curve_row *back = kz_malloc(MOST_ROWS * sizeof *back), *on = kz_malloc(MOST_ROWS * sizeof *on);
  int64_t n_back = 0;
  *curve = (kz_atlas_curve){.kind = seed->kind, .special = kz_malloc(MOST_SPECIAL * sizeof *curve->special)};
  const int64_t n_on = trace_side(atlas, seed, 1, on, curve);
  curve->ending[0] = curve->ending[1];
  const bool closed = curve->ending[1] == KZ_TRACE_CLOSED;
  if (n_on > 0 && !closed) n_back = trace_side(atlas, seed, -1, back, curve);
  curve->row = kz_malloc((size_t)(n_on + n_back + 1) * sizeof *curve->row);
  for (int64_t i = n_back - 1; i > 0; i--) { /* the seed's own row is also the first of the other direction */
    curve->row[curve->n] = back[i];
    for (int c = 0; c < 2; c++) curve->row[curve->n].tangent[c] = -back[i].tangent[c];
    curve->n++;
  }
  memcpy(curve->row + curve->n, on, (size_t)n_on * sizeof *on);
  curve->n += n_on;
  if (closed) curve->row[curve->n - 1] = curve->row[0]; /* the last step has passed the start: it ends there */
}

/* The seed may lie beside a curve of shorter cycles: that curve is traced then. As a longer cycle its points have few
 * digits. */
void kz_atlas_trace(const kz_atlas *atlas, const kz_cycle *seed, kz_atlas_curve *curve) {
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds one = {0};
  trace_both(atlas, seed, curve);
  if (curve->n == 0 || seed->kind.rest) return;
  kz_cycle middle = curve->row[curve->n / 2].at;
  if (!kz_atlas_reduce(atlas, BLURRED, &middle)) return;
  kz_atlas_curve_free(curve);
  *curve = (kz_atlas_curve){.kind = seed->kind,
                            .ending = {KZ_TRACE_MERGED, KZ_TRACE_MERGED},
                            .row = kz_calloc(1, sizeof *curve->row),
                            .special = kz_calloc(1, sizeof *curve->special)};
  if (!kz_atlas_add(atlas, &middle, &one)) return;
  kz_atlas_curve_free(curve);
  trace_both(atlas, one.list, curve);
}

/* A cycle that is not its own image half a period later has other strobe points than this: both count. */
static void signature_of(const kz_atlas *atlas, const kz_cycle *cycle, double *signature) {
  double cosine = 0, energy = 0, both = 0, point[2 * KZ_CURVE_POINTS][2];
  const bool half = atlas->plane.half_period;
  int n = half ? kz_atlas_points(atlas, cycle, point) : cycle->kind.points;
  if (!half) memcpy(point, cycle->point, (size_t)n * sizeof *point);
  for (int i = 0; i < cycle->kind.points && half && cycle->kind.side > 0; i++)
    n += kz_atlas_image_state(atlas, cycle->place, cycle->point[i], point[n]);
  for (int i = 0; i < n; i++) {
    const double c = cos(point[i][0]), v = point[i][1];
    cosine += c;
    energy += v * v;
    both += v * v * c;
  }
  const double scale = WEIGHT / fmax(n, 1);
  const double all[KZ_SIGNATURE] = {cycle->place[0], cycle->place[1], scale * cosine, scale * energy, scale * both};
  memcpy(signature, all, sizeof all);
}

void kz_atlas_sign(const kz_atlas *atlas, kz_atlas_curve *curve) {
  curve->signature = kz_malloc((size_t)(curve->n + 1) * sizeof *curve->signature);
  for (int64_t i = 0; i < curve->n; i++) signature_of(atlas, &curve->row[i].at, curve->signature[i]);
}

/* Whether a point lies on a step of a curve: Newton's method, begun at the step's own cycle at that place, ends at the
 * point. */
static bool is_of_step(const kz_atlas *atlas, const kz_curve_row *row, double share, const kz_cycle *seed) {
  const double *a = row[0].at.place, *b = row[1].at.place;
  const bool steep = fabs(b[0] - a[0]) < fabs(b[1] - a[1]);
  kz_cycle at = kz_atlas_between(row, share);
  memcpy(at.place, seed->place, sizeof at.place);
  return kz_cycle_locate(&atlas->plane, &at, (double[]){steep, !steep}) &&
         hypot(at.place[0] - seed->place[0], at.place[1] - seed->place[1]) < SAME_PLACE &&
         kz_atlas_has(atlas, 1, &at, seed, SAME);
}

/* Whether a point lies on a curve. */
static bool is_on(const kz_atlas *atlas, const kz_atlas_curve *curve, const kz_cycle *seed, const double *signature) {
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
    if (sqrt(off) < NEAR * sqrt(length) + ROUNDING && is_of_step(atlas, curve->row + i, share, seed)) return true;
  }
  return false;
}

static bool is_alike(const kz_cycle_kind *a, const kz_cycle_kind *b) {
  return !memcmp(a, b, sizeof *a);
}

int64_t kz_atlas_known(const kz_atlas *atlas, const kz_cycle *seed) {
  double signature[KZ_SIGNATURE];
  signature_of(atlas, seed, signature);
  for (int64_t i = 0; i < atlas->n_curves; i++)
    if (is_alike(&atlas->curve[i].kind, &seed->kind) && is_on(atlas, atlas->curve + i, seed, signature)) return i;
  return -1;
}

/* Number of some points of a curve that lie on another one. */
static int64_t curve_common(const kz_atlas *atlas, const kz_atlas_curve *curve, const kz_atlas_curve *other,
                            int64_t *tried) {
  const int64_t step = curve->n > SAMPLES ? curve->n / SAMPLES : 1;
  int64_t on = 0;
  *tried = 0;
  for (int64_t row = 0; row < curve->n; row += step, ++*tried)
    on += is_on(atlas, other, &curve->row[row].at, curve->signature[row]);
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
    for (int64_t s = 0; s < curve->n_special && curve->kind.multiplier < 0; s++) {
      const double *at = curve->special[s].place, d = hypot(at[0] - place[0], at[1] - place[1]);
      if (d < least) least = d, nearest = at;
    }
  }
  return nearest;
}

static void curve_extend(kz_atlas_curve *curve, bool at_end, const double *place) {
  curve->row = kz_realloc(curve->row, (size_t)(curve->n + 1) * sizeof *curve->row);
  if (!at_end) memmove(curve->row + 1, curve->row, (size_t)curve->n * sizeof *curve->row);
  if (at_end) curve->row[curve->n] = curve->row[curve->n - 1];
  kz_curve_row *to = curve->row + (at_end ? curve->n : 0);
  memcpy(to->at.place, place, sizeof to->at.place);
  to->tangent[0] = to->tangent[1] = 0; /* the last step is straight */
  curve->n++;
}

static const double *end_of(const kz_atlas_curve *curve, int end) {
  return curve->row[end ? curve->n - 1 : 0].at.place;
}

void kz_atlas_join(kz_atlas *atlas) {
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    kz_atlas_curve *curve = atlas->curve + i;
    for (int end = 0; end < 2; end++) {
      if (curve->kind.multiplier < 0 || (curve->ending[end] != KZ_TRACE_MERGED && curve->ending[end] != KZ_TRACE_STUCK))
        continue;
      const double *place = degenerate_near(atlas, end_of(curve, end));
      if (!place) continue;
      curve_extend(curve, end, place);
      curve->ending[end] = KZ_ATLAS_JOINED;
    }
  }
}

int kz_atlas_open_ends(const kz_atlas_curve *curve) {
  int open = 0;
  for (int end = 0; end < 2; end++) {
    const double *place = end_of(curve, end);
    const bool within = place[0] > 0 && place[0] < 1 && place[1] > 0 && place[1] < 1;
    open += within && curve->ending[end] != KZ_TRACE_CLOSED && curve->ending[end] != KZ_TRACE_THIN &&
            curve->ending[end] != KZ_ATLAS_JOINED;
  }
  return open;
}
