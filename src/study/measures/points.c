/* A stage whose tiles are points: each process measures its own pendulums. */
#include "points.h"

/* ---- the file's groups /plane and /line, and the summary ---- */

typedef struct {
  const kz_points *points;
  const void *records;
  const kz_classes *classes;
  kz_store *store;
  const char *group;
} writing;

static kz_status write_line(const writing *w) {
  const kz_sweep_plan *plan = w->points->scene->sweep;
  KZ_TRY(kz_axis_describe(&plan->values, plan->parameter, "", "line", w->store));
  KZ_SCALE(w->store, "line", "value", plan->values.count, kz_sweep_value(plan, i));
  return KZ_OK;
}

/* A class where it begins. */
static const kz_attractor *first_of(const writing *w, int64_t k) {
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
  KZ_AUTOFREE char (*names)[KZ_NAME_LENGTH] = kz_calloc((size_t)n + 1, sizeof *names);
  for (int64_t k = 0; k < n; k++) {
    const kz_attractor *point = first_of(w, k);
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
  KZ_AUTOFREE double *value = kz_malloc((size_t)n * sizeof *value + 1);
  for (int64_t i = 0; i < n; i++) value[i] = NAN;
  for (int64_t point = 0; point < points; point++) {
    const kz_measured_point *at = kz_point_at(w->points, w->records, point);
    for (int64_t place = 0; place < at->count; place++)
      value[w->classes->of[point * KZ_POINT_MOST + place] * points + point] =
          at->value[place * w->points->numbers + number];
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

/* Writes the group /plane, or /line, and the summary. Rank 0. */
static kz_status write_points(const kz_points *points, const void *records, const kz_classes *classes, kz_store *store,
                              FILE *summary) {
  const bool plane = kz_sweep_is_plane(points->scene->sweep);
  const writing w = {points, records, classes, store, plane ? "plane" : "line"};
  KZ_AUTOFREE int32_t *count = kz_calloc((size_t)classes->count + 1, sizeof *count);
  if (!plane) KZ_TRY(write_line(&w));
  KZ_TRY(kz_store_real(store, w.group, "shock_tolerance", points->plan.options.shock_tolerance));
  count_points(&w, count);
  KZ_TRY(write_classes(&w, count, summary));
  return write_measures(&w);
}

kz_cost kz_points_cost(const kz_points *points) {
  const double n = (double)(points->columns * points->rows), bytes = n * (double)kz_point_bytes(points);
  return (kz_cost){.cells = (int64_t)n * points->plan.starts,
                   .disk_bytes = 1.5 * bytes,
                   .memory_bytes = bytes,
                   .rank0_bytes = bytes + n * KZ_POINT_MOST * 40};
}

/* The values of all measures, side by side for each attractor. */
static void points_fill(const kz_points *points, const kz_measured *measured, kz_measured_point *out) {
  const int64_t n = measured->catalogue.count;
  KZ_AUTOFREE double *value = kz_malloc((size_t)(3 * n + 1) * sizeof *value);
  int64_t number = 0, of_pendulum = 0;
  for (int64_t i = 0; i < points->plan.names.count; i++) {
    const kz_measure *measure = kz_measures + points->plan.names.values[i];
    measure->fill(measured, value);
    if (measure->shape == KZ_PER_PENDULUM) {
      out->value[KZ_POINT_MOST * points->numbers + of_pendulum++] = value[0];
      continue;
    }
    for (int part = 0; part < (measure->shape == KZ_PER_INTERVAL ? 3 : 1); part++, number++)
      for (int64_t id = 0; id < n; id++) out->value[id * points->numbers + number] = value[part * n + id];
  }
}

static kz_status measure_point(void *context, int64_t tile, void *record) {
  const kz_points *points = context;
  kz_measured_point *out = record;
  kz_pendulum pendulum;
  out->count = -1;
  if (!kz_points_pendulum(points, tile, tile, 0, &pendulum) || !(pendulum.beta > 0)) return KZ_OK;
  KZ_AUTOFREE_BY(kz_measured_free) kz_measured measured = {0};
  KZ_TRY(kz_measured_make(&pendulum, &points->scene->numerics, &points->plan, KZ_BY_STATES,
                          kz_measures_need(&points->plan.names), NULL, &measured));
  if (measured.catalogue.count > KZ_POINT_MOST)
    return kz_fail(KZ_REFUSED, "sweep: more than %d attractors at one point; use more damping or a smaller window",
                   KZ_POINT_MOST);
  out->count = measured.catalogue.count;
  for (int64_t id = 0; id < out->count; id++) {
    const kz_entry *entry = measured.catalogue.entries + id;
    out->attractor[id] = entry->row;
  }
  points_fill(points, &measured, out);
  return KZ_OK;
}

kz_status kz_points_run(const kz_points *points, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_stage stage =
      kz_stage_for_all("points", points->columns * points->rows, kz_point_bytes(points), measure_point, (void *)points);
  KZ_AUTOFREE void *records = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  KZ_AUTOFREE_BY(kz_classes_free) kz_classes classes = {0};
  KZ_TRY(kz_stage_run(run, &stage, records));
  KZ_TRY(kz_classes_make(points, run, records, &classes));
  return kz_ranks_agree(run->ranks, store ? write_points(points, records, &classes, store, summary) : KZ_OK);
}
