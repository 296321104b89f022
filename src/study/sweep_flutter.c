/* Flutter: the period-2 cycle about inverted that takes over where the inverted state loses its stability by multiplier -1. */
#include <math.h>
#include <stdlib.h>

#include "kapitza/analysis.h"
#include "sweep.h"

/* The critical value is looked for within the range and as far again on both sides, in so many pieces. */
enum { PIECES = 300 };
/* Flutter is first looked for at this share of the range from the critical value, then farther. */
static const double FIRST_SHARE = 1e-4, LAST_SHARE = 0.05;

typedef struct {
  const kz_scene *scene;
  kz_path path;
  double critical; /* NaN = none */
  double *amplitude;
} fluttering;

/* The range and its neighbourhood, kept on one side of zero where the range is. */
static void neighbourhood(const kz_axis *range, double *low, double *high) {
  const double width = range->max - range->min;
  *low = range->min - width;
  *high = range->max + width;
  if (range->min > 0 && *low <= 0) *low = range->min / 16;
  if (range->max < 0 && *high >= 0) *high = range->max / 16;
}

/* Carries flutter to every value of the range beyond `from`, upwards or downwards. */
static void fill_from(fluttering *f, double from, kz_branch_point flutter, bool up) {
  const kz_sweep_plan *plan = &f->scene->sweep;
  const int64_t n = plan->values.count;
  for (int64_t step = 0; step < n; step++) {
    const int64_t i = up ? step : n - 1 - step;
    const double value = kz_sweep_value(plan, i);
    if (up ? value < from : value > from) continue;
    from = kz_walk(&f->path, from, value, &flutter);
    if (from != value) return;
    f->amplitude[i] = flutter.amplitude;
  }
}

/* Flutter beside the critical value, on the side where there is any; *at = where. */
static bool begin(const fluttering *f, double side, kz_branch_point *flutter, double *at) {
  const kz_axis *range = &f->scene->sweep.values;
  kz_pendulum pendulum;
  for (double share = FIRST_SHARE; share < LAST_SHARE; share *= 2) {
    *at = f->critical + side * share * (range->max - range->min);
    if (f->path.pendulum(f->path.context, *at, &pendulum) && kz_flutter_find(&pendulum, flutter)) return true;
  }
  return false;
}

/* From a critical value to all the flutter that it begins; true where that reaches the range. */
static bool follow(fluttering *f) {
  const kz_axis *range = &f->scene->sweep.values;
  kz_branch_point flutter, back;
  double at;
  for (int side = 1; side >= -1; side -= 2) {
    if (!begin(f, side, &flutter, &at)) continue;
    back = flutter;
    fill_from(f, at, flutter, side > 0);
    /* values that lie between the critical one and the place where flutter was found */
    const double birth = kz_walk(&f->path, at, f->critical, &back);
    for (int64_t i = 0; i < range->count; i++) {
      const double value = kz_sweep_value(&f->scene->sweep, i);
      if ((value - birth) * (value - at) >= 0) continue;
      back = flutter;
      if (kz_walk(&f->path, at, value, &back) == value) f->amplitude[i] = back.amplitude;
    }
  }
  for (int64_t i = 0; i < range->count; i++)
    if (!isnan(f->amplitude[i])) return true;
  return false;
}

/* The lowest critical value whose flutter reaches the range; the lowest of all where none does. */
static void find_critical(fluttering *f) {
  double low, high, first = NAN;
  neighbourhood(&f->scene->sweep.values, &low, &high);
  for (int piece = 0; piece < PIECES; piece++) {
    f->critical = kz_flutter_critical(&f->path, low + (high - low) * piece / PIECES, low + (high - low) * (piece + 1) / PIECES);
    if (isnan(f->critical)) continue;
    if (isnan(first)) first = f->critical;
    if (follow(f)) return;
  }
  f->critical = first;
}

/* Points of the fit: (distance from the critical value, amplitude^2); returns how many. */
static int64_t gather(const fluttering *f, double *x, double *y) {
  int64_t n = 0;
  for (int64_t i = 0; i < f->scene->sweep.values.count; i++) {
    if (isnan(f->amplitude[i])) continue;
    x[n] = kz_sweep_value(&f->scene->sweep, i) - f->critical;
    y[n++] = f->amplitude[i] * f->amplitude[i];
  }
  return n;
}

/* Exponent of the amplitude at the critical value: the slopes of ln(amplitude) over ln(distance) between neighbours, as a
 * line over the distance (its logarithmic mean), carried to distance 0. Neighbours farther than `farthest` do not count. */
static double exponent(int64_t n, const double *x, const double *y, double farthest, double *distance, double *slope) {
  int64_t used = 0;
  for (int64_t i = 0; i + 1 < n; i++) {
    const double ratio = log(x[i + 1] / x[i]);
    distance[used] = (x[i + 1] - x[i]) / ratio;
    slope[used] = 0.5 * log(y[i + 1] / y[i]) / ratio;
    if (fabs(distance[used]) <= farthest) used++;
  }
  return kz_fit_line(used, distance, slope).intercept;
}

typedef struct {
  kz_line line;
  double exponent, exponent_error; /* of the nearer half; its difference from that of all */
} power_law;

/* x, y [n] points; room [2 n]. */
static power_law fit(int64_t n, const double *x, const double *y, double *room) {
  double farthest = 0;
  for (int64_t i = 0; i < n; i++) farthest = fmax(farthest, fabs(x[i]));
  const double half = exponent(n, x, y, farthest / 2, room, room + n);
  return (power_law){kz_fit_line(n, x, y), half, fabs(half - exponent(n, x, y, farthest, room, room + n))};
}

static kz_status write_fit(const fluttering *f, kz_store *store, FILE *summary) {
  const size_t n = (size_t)f->scene->sweep.values.count;
  double *x = malloc(4 * n * sizeof *x);
  if (!x) return kz_fail(KZ_FAILED, "no memory for the fit of a sweep");
  const power_law law = fit(gather(f, x, x + n), x, x + n, x + 2 * n);
  free(x);
  if (isnan(f->critical))
    fprintf(summary, "no flutter begins in the range or near it\n");
  else
    fprintf(summary, "flutter begins at %.12g (multiplier -1)\n", f->critical);
  if (!isnan(law.line.slope)) {
    fprintf(summary, "amplitude^2 = (%.6g +- %.2g) rad^2 times the distance", law.line.slope, law.line.slope_stderr);
    if (!isnan(law.exponent)) fprintf(summary, "; exponent %.5f +- %.5f", law.exponent, law.exponent_error);
    fputc('\n', summary);
  }
  KZ_TRY(kz_store_real(store, "sweep", "critical_value", f->critical));
  KZ_TRY(kz_store_real(store, "sweep", "fit_slope", law.line.slope));
  KZ_TRY(kz_store_real(store, "sweep", "fit_slope_stderr", law.line.slope_stderr));
  KZ_TRY(kz_store_real(store, "sweep", "fit_exponent", law.exponent));
  return kz_store_real(store, "sweep", "fit_exponent_error", law.exponent_error);
}

kz_status kz_sweep_flutter(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary) {
  if (kz_team_rank(team) != 0) return kz_team_agree(team, KZ_OK);
  const int64_t n = scene->sweep.values.count;
  fluttering f = {
      .scene = scene, .path = kz_sweep_path(scene), .critical = NAN, .amplitude = malloc((size_t)n * sizeof(double))};
  kz_status status = f.amplitude ? KZ_OK : kz_fail(KZ_FAILED, "no memory for the flutter of a sweep");
  for (int64_t i = 0; status == KZ_OK && i < n; i++) f.amplitude[i] = NAN;
  if (status == KZ_OK) {
    find_critical(&f);
    status = kz_store_variable(store, "sweep", "flutter_amplitude", f.amplitude);
  }
  if (status == KZ_OK) status = write_fit(&f, store, summary);
  free(f.amplitude);
  return kz_team_agree(team, status);
}
