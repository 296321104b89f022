/* Flutter: the period-2 cycle about inverted that takes over where the inverted state loses its stability by multiplier -1. */
#include <math.h>
#include <stdlib.h>

#include "kapitza/analysis.h"
#include "sweep.h"

enum {
  PIECES = 300, /* of the range and as far again on both sides: in each a critical value is looked for */
  GROUP = 15,   /* pieces that are tried before flutter is followed from what they hold */
  LEG = 32      /* values of a tile */
};
/* Flutter is first looked for at this share of the range from the critical value, then farther. */
static const double FIRST_SHARE = 1e-4, LAST_SHARE = 0.05;

/* Flutter beside a critical value. */
typedef struct {
  int32_t found;
  double at; /* the value where it was found */
  kz_attractor flutter;
} beginning;

/* Flutter carried along some values. */
typedef struct {
  double at;
  kz_attractor flutter;  /* there */
  int32_t lost;          /* 1 = it ends before the next value */
  double amplitude[LEG]; /* NaN = none */
} leg;

typedef struct {
  const kz_scene *scene;
  const kz_run *run;
  kz_path path;
  double critical; /* NaN = none */
  double *amplitude;
  /* what tiles work on */
  int side; /* of the critical value: 1 above, -1 below */
  int way;  /* in which flutter is followed: 1 up, -1 down */
  beginning begun;
  leg before;
  int64_t piece; /* the first of the group */
  int64_t step;  /* the first value of the leg, counted in that direction */
} flutter_job;

/* The range and its neighbourhood, kept on one side of zero where the range is. */
static void neighbourhood(const kz_axis *range, double *low, double *high) {
  const double width = range->max - range->min;
  *low = range->min - width;
  *high = range->max + width;
  if (range->min > 0 && *low <= 0) *low = range->min / 16;
  if (range->max < 0 && *high >= 0) *high = range->max / 16;
}

static kz_status find_critical(void *context, int64_t tile, void *record) {
  const flutter_job *f = context;
  const double piece = (double)(f->piece + tile);
  double low, high;
  neighbourhood(&f->scene->sweep->values, &low, &high);
  *(double *)record =
      kz_flutter_critical(&f->path, low + (high - low) * piece / PIECES, low + (high - low) * (piece + 1) / PIECES);
  return KZ_OK;
}

/* Flutter beside the critical value, on one side. */
static kz_status begin(void *context, int64_t tile, void *record) {
  const flutter_job *f = context;
  const kz_axis *range = &f->scene->sweep->values;
  beginning *out = record;
  kz_pendulum pendulum;
  (void)tile;
  for (double share = FIRST_SHARE; share < LAST_SHARE && !out->found; share *= 2) {
    out->at = f->critical + f->side * share * (range->max - range->min);
    out->found = f->path.pendulum(f->path.context, out->at, &pendulum) && kz_flutter_find(&pendulum, &out->flutter);
  }
  return KZ_OK;
}

/* The value at a step of the way. */
static int64_t value_at(const flutter_job *f, int64_t step) {
  return f->way > 0 ? step : f->scene->sweep->values.count - 1 - step;
}

/* Carries flutter on to the next values of the range, at most to the critical one. */
static kz_status follow_leg(void *context, int64_t tile, void *record) {
  const flutter_job *f = context;
  const kz_sweep_plan *plan = f->scene->sweep;
  leg *out = record;
  int32_t end_kind;
  (void)tile;
  *out = f->before;
  for (int64_t i = 0; i < LEG; i++) out->amplitude[i] = NAN;
  for (int64_t i = 0; i < LEG && f->step + i < plan->values.count; i++) {
    const double value = kz_sweep_value(plan, value_at(f, f->step + i));
    if (f->way > 0 ? value < out->at : value > out->at) continue;
    out->lost = f->side > 0 ? value <= f->critical : value >= f->critical;
    if (out->lost) return KZ_OK;
    out->at = kz_walk(&f->path, out->at, value, &out->flutter, &end_kind);
    out->lost = out->at != value;
    if (out->lost) return KZ_OK;
    out->amplitude[i] = out->flutter.amplitude;
  }
  return KZ_OK;
}

static kz_status run_stage(flutter_job *f, const char *name, kz_tile_fn work, int64_t n_tiles, size_t bytes, void *records) {
  kz_stage stage = kz_stage_for_all(name, n_tiles, bytes, work, f);
  return kz_stage_run(f->run, &stage, records);
}

/* From where flutter was found one way. */
static kz_status follow_on(flutter_job *f, int way) {
  leg after;
  f->way = way;
  f->before = (leg){.at = f->begun.at, .flutter = f->begun.flutter};
  for (f->step = 0; f->step < f->scene->sweep->values.count && !f->before.lost; f->step += LEG) {
    KZ_TRY(run_stage(f, "flutter", follow_leg, 1, sizeof after, &after));
    for (int64_t i = 0; i < LEG; i++)
      if (!isnan(after.amplitude[i])) f->amplitude[value_at(f, f->step + i)] = after.amplitude[i];
    f->before = after;
  }
  return KZ_OK;
}

/* Follows all the flutter that begins at a critical value; *reaches = whether it comes to the range. */
static kz_status follow(flutter_job *f, bool *reaches) {
  for (f->side = 1; f->side >= -1; f->side -= 2) {
    KZ_TRY(run_stage(f, "flutter's beginning", begin, 1, sizeof f->begun, &f->begun));
    if (!f->begun.found) continue;
    KZ_TRY(follow_on(f, f->side));
    KZ_TRY(follow_on(f, -f->side));
  }
  *reaches = false;
  for (int64_t i = 0; i < f->scene->sweep->values.count; i++) *reaches = *reaches || !isnan(f->amplitude[i]);
  return KZ_OK;
}

/* The lowest critical value whose flutter reaches the range; the lowest of all where none does. */
static kz_status find_flutter(flutter_job *f) {
  double critical[GROUP], first = NAN;
  bool reaches = false;
  for (f->piece = 0; f->piece < PIECES && !reaches; f->piece += GROUP) {
    KZ_TRY(run_stage(f, "critical values", find_critical, GROUP, sizeof *critical, critical));
    for (int i = 0; i < GROUP && !reaches; i++) {
      f->critical = critical[i];
      if (isnan(f->critical)) continue;
      if (isnan(first)) first = f->critical;
      KZ_TRY(follow(f, &reaches));
    }
  }
  if (!reaches) f->critical = first;
  return KZ_OK;
}

/* Points of the fit: (distance from the critical value, amplitude^2); returns how many. */
static int64_t gather(const flutter_job *f, double *x, double *y) {
  int64_t n = 0;
  for (int64_t i = 0; i < f->scene->sweep->values.count; i++) {
    if (isnan(f->amplitude[i])) continue;
    x[n] = kz_sweep_value(f->scene->sweep, i) - f->critical;
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

/* x, y [n] points; workspace [2 n]. */
static power_law fit(int64_t n, const double *x, const double *y, double *workspace) {
  double farthest = 0;
  for (int64_t i = 0; i < n; i++) farthest = fmax(farthest, fabs(x[i]));
  const double half = exponent(n, x, y, farthest / 2, workspace, workspace + n);
  return (power_law){kz_fit_line(n, x, y), half, fabs(half - exponent(n, x, y, farthest, workspace, workspace + n))};
}

static kz_status write_flutter(const flutter_job *f, kz_store *store, FILE *summary) {
  const kz_axis *values = &f->scene->sweep->values;
  const size_t n = (size_t)values->count;
  KZ_FREED double *x = kz_malloc(4 * n * sizeof *x);
  const power_law law = fit(gather(f, x, x + n), x, x + n, x + 2 * n);
  if (isnan(f->critical))
    fprintf(summary, "no flutter begins in the range or near it\n");
  else
    fprintf(summary, "flutter begins at %.12g (multiplier -1)\n", kz_axis_written(values, f->critical));
  if (!isnan(law.line.slope)) {
    const double distance = kz_axis_written(values, 1);
    fprintf(summary, "amplitude^2 = (%.6g +- %.2g) rad^2 times the distance", law.line.slope / distance,
            law.line.slope_stderr / distance);
    if (!isnan(law.exponent)) fprintf(summary, "; exponent %.5f +- %.5f", law.exponent, law.exponent_error);
    fputc('\n', summary);
  }
  KZ_TRY(kz_store_variable(store, "sweep", "flutter_amplitude", f->amplitude));
  KZ_TRY(kz_store_real(store, "sweep", "critical_value", f->critical));
  KZ_TRY(kz_store_real(store, "sweep", "fit_slope", law.line.slope));
  KZ_TRY(kz_store_real(store, "sweep", "fit_slope_stderr", law.line.slope_stderr));
  KZ_TRY(kz_store_real(store, "sweep", "fit_exponent", law.exponent));
  return kz_store_real(store, "sweep", "fit_exponent_error", law.exponent_error);
}

/* The scene's flutter by this rank, or by all; amplitude [values]. */
static kz_status follow_scene(const kz_scene *scene, const kz_run *run, double *amplitude, flutter_job *f) {
  *f = (flutter_job){scene, run, kz_sweep_path(scene, NULL), NAN, amplitude};
  for (int64_t i = 0; i < scene->sweep->values.count; i++) amplitude[i] = NAN;
  return find_flutter(f);
}

kz_status kz_sweep_flutter(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_FREED double *amplitude = kz_malloc((size_t)scene->sweep->values.count * sizeof *amplitude);
  flutter_job f;
  KZ_TRY(follow_scene(scene, run, amplitude, &f));
  return kz_ranks_agree(run->ranks, store ? write_flutter(&f, store, summary) : KZ_OK);
}
