/* The file's groups /plane and /line, and the summary of measures at many points. */
#include <math.h>
#include <stdio.h>

#include "points.h"

typedef struct {
  const kz_points *points;
  const void *records;
  const kz_classes *classes;
  kz_store *store;
  const char *group;
} writing;

/* One axis with its scale, its key and that key's unit. */
static kz_status write_axis(const char *name, const kz_chart_axis *axis, kz_store *store) {
  KZ_TRY(kz_axis_describe(&axis->values, axis->parameter, name, "plane", store));
  KZ_SCALE(store, "plane", name, axis->values.count, kz_axis_value(&axis->values, i));
  return KZ_OK;
}

kz_status kz_points_write_axes(const kz_sweep_plan *plan, kz_store *store) {
  KZ_TRY(write_axis("y", &plan->y, store));
  return write_axis("x", &plan->x, store);
}

static kz_status write_line(const writing *w) {
  const kz_sweep_plan *plan = w->points->scene->sweep;
  KZ_TRY(kz_axis_describe(&plan->values, plan->parameter, "", "line", w->store));
  KZ_SCALE(w->store, "line", "value", plan->values.count, kz_sweep_value(plan, i));
  return KZ_OK;
}

/* A class where it begins. */
static const kz_branch_point *first_of(const writing *w, int64_t k) {
  return kz_point_at(w->points, w->records, w->classes->first_point[k])->attractor + w->classes->first_place[k];
}

/* How many points have each class. */
static void count_points(const writing *w, int32_t *count) {
  for (int64_t point = 0; point < w->points->columns * w->points->rows; point++)
    for (int64_t place = 0; place < kz_point_at(w->points, w->records, point)->count; place++)
      count[w->classes->of[point * KZ_POINT_MOST + place]]++;
}

static kz_status write_classes(const writing *w, const int32_t *count, FILE *summary) {
  const int64_t n = w->classes->count;
  KZ_FREED char (*names)[KZ_NAME_LENGTH] = kz_calloc((size_t)n + 1, sizeof *names);
  for (int64_t k = 0; k < n; k++) {
    const kz_branch_point *point = first_of(w, k);
    kz_orbit_name(point->period, point->winding, point->centre, names[k]);
  }
  KZ_TRY(kz_store_dimension(w->store, w->group, "attractor", n, NULL));
#define COLUMN(type, name, expression) KZ_COLUMN(w->store, w->group, name, n, type, expression)
  COLUMN(const char *, "name", names[i]);
  COLUMN(int32_t, "period", first_of(w, i)->period);
  COLUMN(int32_t, "winding", first_of(w, i)->winding);
  COLUMN(int8_t, "centre", first_of(w, i)->centre);
  COLUMN(int32_t, "points", count[i]);
  fprintf(summary, "measures of %lld attractors at %lld points\n", (long long)n,
          (long long)(w->points->columns * w->points->rows));
  for (int64_t k = 0; k < n && k < 12; k++)
    fprintf(summary, "  %lld: %s, at %ld points\n", (long long)k, names[k], (long)count[k]);
  return KZ_OK;
}

/* One number of every attractor at every point. */
static kz_status write_number(const writing *w, const char *name, int64_t number) {
  const int64_t points = w->points->columns * w->points->rows, n = w->classes->count * points;
  KZ_FREED double *value = kz_malloc((size_t)n * sizeof *value + 1);
  for (int64_t i = 0; i < n; i++) value[i] = NAN;
  for (int64_t point = 0; point < points; point++) {
    const kz_measured_point *at = kz_point_at(w->points, w->records, point);
    for (int64_t place = 0; place < at->count; place++)
      value[w->classes->of[point * KZ_POINT_MOST + place] * points + point] = at->value[place * w->points->numbers + number];
  }
  return kz_store_variable(w->store, w->group, name, value);
}

static kz_status write_of_pendulum(const writing *w, const char *name, int64_t number) {
  KZ_COLUMN(w->store, w->group, name, w->points->columns * w->points->rows, double,
            kz_point_at(w->points, w->records, i)->count < 0
                ? NAN
                : kz_point_at(w->points, w->records, i)->value[KZ_POINT_MOST * w->points->numbers + number]);
  return KZ_OK;
}

static kz_status write_measures(const writing *w) {
  static const char *const ends[] = {"", "_low", "_high"};
  int64_t number = 0, of_pendulum = 0;
  for (int64_t i = 0; i < w->points->plan.names.count; i++) {
    const kz_measure *measure = kz_measures + w->points->plan.names.values[i];
    if (measure->shape == KZ_PER_PENDULUM) {
      KZ_TRY(write_of_pendulum(w, measure->word, of_pendulum++));
      continue;
    }
    for (int part = 0; part < (measure->shape == KZ_PER_INTERVAL ? 3 : 1); part++) {
      char name[64];
      snprintf(name, sizeof name, "%s%s", measure->word, ends[part]);
      KZ_TRY(write_number(w, name, number++));
    }
  }
  return KZ_OK;
}

kz_status kz_points_write(const kz_points *points, const void *records, const kz_classes *classes, kz_store *store,
                          FILE *summary) {
  const bool plane = kz_sweep_is_plane(points->scene->sweep);
  const writing w = {points, records, classes, store, plane ? "plane" : "line"};
  KZ_FREED int32_t *count = kz_calloc((size_t)classes->count + 1, sizeof *count);
  if (!plane) KZ_TRY(write_line(&w));
  KZ_TRY(kz_store_real(store, w.group, "shock_tolerance", points->plan.options.shock_tolerance));
  count_points(&w, count);
  KZ_TRY(write_classes(&w, count, summary));
  return write_measures(&w);
}
