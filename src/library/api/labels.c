/* Labels of starts, and of the cells of a window. */
#include "../library.h"
#include "kapitza/study_basin.h"

static const double MOST_ANGLE = 1e6; /* rad, as of the windows of a scene */

/* ---- starts ---- */

typedef struct {
  int64_t n;
  const double *theta, *velocity;
  double start_error;
  int16_t *attractor, *other;
  uint8_t *evidence;
  int64_t *settling_time;
  int32_t *turns;
  double *error;
  kapitza_cycles **list;
} labels_job;

/* The starts, and the largest speed among them. */
static kz_status take_starts(const labels_job *j, double (*start)[2], double *fastest) {
  if (!(j->start_error >= 0 && j->start_error <= 1))
    return kz_fail(KZ_REFUSED, "start_error: %g: must be from 0 to 1", j->start_error);
  for (int64_t i = 0; i < j->n; i++) {
    const double theta = j->theta[i], velocity = j->velocity[i];
    if (!(fabs(theta) <= MOST_ANGLE) || !(fabs(velocity) <= KZ_MOST_SPEED))
      return kz_fail(KZ_REFUSED,
                     "start %lld: theta %g, velocity %g: must be numbers of at most %g rad and %g rad per drive radian",
                     (long long)i, theta, velocity, MOST_ANGLE, KZ_MOST_SPEED);
    start[i][0] = theta;
    start[i][1] = velocity;
    *fastest = fmax(*fastest, fabs(velocity));
  }
  return KZ_OK;
}

static void give_labels(const labels_job *j, const kz_label *label, const double *error) {
  for (int64_t i = 0; i < j->n; i++) {
    if (j->attractor) j->attractor[i] = label[i].label;
    if (j->other) j->other[i] = label[i].other;
    if (j->evidence) j->evidence[i] = label[i].evidence;
    if (j->settling_time) j->settling_time[i] = label[i].periods;
    if (j->turns) j->turns[i] = label[i].turns;
    if (j->error) j->error[i] = error[i];
  }
}

static kz_status work_labels(kapitza_pendulum *p, void *context) {
  const labels_job *j = context;
  const kz_axis *own = &p->scene.basin->velocity;
  const kz_live_catalogue *catalogue;
  double fastest = fmax(fabs(own->min), fabs(own->max));
  KZ_TRY(kz_memory_ask("n", (size_t)j->n * (2 * sizeof(double) + sizeof(kz_label) + sizeof(double))));
  KZ_AUTOFREE double (*start)[2] = kz_malloc((size_t)j->n * sizeof *start + 1);
  KZ_AUTOFREE kz_label *label = kz_malloc((size_t)j->n * sizeof *label + 1);
  KZ_AUTOFREE double *error = kz_malloc((size_t)j->n * sizeof *error + 1);
  KZ_TRY(take_starts(j, start, &fastest));
  kz_scene scene = p->scene;
  kz_plans_copy(&scene);
  scene.basin->velocity = (kz_axis){.min = -fastest, .max = fastest, .count = own->count};
  const kz_status status =
      kz_engine_labels(p->engine, &scene, j->n, (const double (*)[2])start, j->start_error, label, error, &catalogue);
  kz_plans_free(&scene);
  KZ_TRY(status);
  if (j->list) *j->list = kz_library_cycles(&catalogue->list, true);
  give_labels(j, label, error);
  return KZ_OK;
}

kapitza_status kapitza_labels(kapitza_pendulum *pendulum, int64_t n, const double *theta, const double *velocity,
                              double start_error, int16_t *attractor, int16_t *other, uint8_t *evidence,
                              int64_t *settling_time, int32_t *turns, double *error, kapitza_cycles **list) {
  labels_job job = {n, theta, velocity, start_error, attractor, other, evidence, settling_time, turns, error, list};
  if (list) *list = NULL;
  return kz_library_call(pendulum, work_labels, &job);
}

/* ---- cells of a window ---- */

typedef struct {
  const char *window;
  kapitza_pendulum *pendulum;
  const kz_scene *scene;
  kapitza_basin *basin; /* NULL: not made yet */
} basin_job;

static void put_ids(int64_t cells, const uint8_t *from, int16_t *to) {
  for (int64_t i = 0; i < cells; i++) to[i] = from[i] == KZ_NO_LABEL ? -1 : from[i];
}

/* Puts the frame into one piece of memory. */
static kz_status take_frame(void *context, const kz_live_raster *r) {
  basin_job *j = context;
  const int64_t cells = r->rows * r->columns;
  const size_t n = (size_t)cells,
               sides = kz_library_rounded((size_t)r->columns * 8) + kz_library_rounded((size_t)r->rows * 8);
  const size_t planes =
      2 * kz_library_rounded(n * sizeof(int16_t)) + kz_library_rounded(n) + 2 * kz_library_rounded(n * sizeof(float));
  char *piece = kz_border_give(kz_library_rounded(sizeof *j->basin) + sides + planes +
                               kz_library_cycles_bytes(&r->catalogue->list));
  kapitza_basin *b = j->basin = kz_library_part(&piece, sizeof *b);
  double *theta = kz_library_part(&piece, (size_t)r->columns * sizeof *theta);
  double *velocity = kz_library_part(&piece, (size_t)r->rows * sizeof *velocity);
  int16_t *attractor = kz_library_part(&piece, n * sizeof *attractor),
          *other = kz_library_part(&piece, n * sizeof *other);
  uint8_t *evidence = kz_library_part(&piece, n);
  float *settling = kz_library_part(&piece, n * sizeof *settling), *turns = kz_library_part(&piece, n * sizeof *turns);
  for (int64_t i = 0; i < r->columns; i++) theta[i] = kz_frame_centre(&j->scene->basin->theta, i);
  for (int64_t i = 0; i < r->rows; i++) velocity[i] = kz_frame_centre(&j->scene->basin->velocity, i);
  put_ids(cells, r->plane[KZ_PLANE_LABELS], attractor);
  put_ids(cells, r->plane[KZ_PLANE_OTHER], other);
  memcpy(evidence, r->plane[KZ_PLANE_EVIDENCE], n);
  memcpy(settling, r->plane[KZ_PLANE_SETTLING_TIME], n * sizeof *settling);
  memcpy(turns, r->plane[KZ_PLANE_TURNS], n * sizeof *turns);
  kz_library_cycles_put(&r->catalogue->list, true, piece);
  *b =
      (kapitza_basin){r->columns, r->rows, theta, velocity, attractor, other, evidence, settling, turns, (void *)piece};
  return KZ_OK;
}

static kz_status pause_frame(void *context) {
  return kz_library_between(((basin_job *)context)->pendulum, NULL, NULL);
}

static kz_status label_window(kapitza_pendulum *p, basin_job *j) {
  static const kz_integers all = {1, {1}};
  const kz_frame frame = {.coarseness = &all,
                          .plane = {[KZ_PLANE_LABELS] = true,
                                    [KZ_PLANE_SETTLING_TIME] = true,
                                    [KZ_PLANE_OTHER] = true,
                                    [KZ_PLANE_TURNS] = true,
                                    [KZ_PLANE_EVIDENCE] = true},
                          .pause = pause_frame,
                          .show = take_frame,
                          .context = j};
  return kz_engine_frame(p->engine, j->scene, &frame);
}

static kz_status work_basin(kapitza_pendulum *p, void *context) {
  enum { MOST_CELLS = 1 << 26 };
  basin_job *j = context;
  const size_t bytes = (j->window ? strlen(j->window) : 0) + 16;
  KZ_AUTOFREE char *change = kz_malloc(bytes);
  KZ_AUTOFREE_BY(kz_scene_free) kz_scene scene;
  snprintf(change, bytes, "basin: {%s}", j->window ? j->window : "");
  KZ_TRY(kz_scene_open(&p->text, change, &scene));
  const int64_t columns = scene.basin->theta.count, rows = scene.basin->velocity.count;
  if (columns * rows > MOST_CELLS)
    return kz_fail(KZ_REFUSED, "%lld times %lld are more than %d cells; run a scene, which writes them to a file",
                   (long long)columns, (long long)rows, MOST_CELLS);
  j->scene = &scene;
  j->pendulum = p;
  return label_window(p, j);
}

kapitza_status kapitza_basin_of(kapitza_pendulum *pendulum, const char *window, kapitza_basin **basin) {
  basin_job job = {.window = window};
  const kapitza_status status = kz_library_call(pendulum, work_basin, &job);
  *basin = status == KAPITZA_OK ? job.basin : NULL;
  return status;
}
