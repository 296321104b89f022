/* Frames and charts on request, shown in parts. */
#include "../library.h"
#include "kapitza/dynamics_ends.h"
#include "kapitza/study_basin.h"

enum { MOST_CELLS = 1 << 24, MOST_POINTS = 1 << 20, MOST_PARTS = 4 };
_Static_assert((int)KAPITZA_PLANES == (int)KZ_PLANES && (int)KAPITZA_PLANE_EVIDENCE == (int)KZ_PLANE_EVIDENCE,
               "planes are numbered as in study_live.h");

/* ---- catalogues ---- */

static size_t catalogue_bytes(const kz_live_catalogue *own) {
  return kz_library_rounded(sizeof(kapitza_catalogue)) + kz_library_rounded((size_t)own->list.count * sizeof(int64_t)) +
         kz_library_cycles_bytes(&own->list);
}

static void catalogue_put(const kz_live_catalogue *own, void *place) {
  char *piece = place;
  kapitza_catalogue *catalogue = kz_library_part(&piece, sizeof *catalogue);
  const size_t bytes = (size_t)own->list.count * sizeof(int64_t);
  int64_t *track = kz_library_part(&piece, bytes);
  memcpy(track, own->track, bytes);
  kz_library_cycles_put(&own->list, true, piece);
  *catalogue = (kapitza_catalogue){.version = own->version,
                                   .parameters = kz_library_parameters(&own->parameters),
                                   .attractors = *(kapitza_cycles *)(void *)piece,
                                   .track = track};
}

typedef struct {
  const char *change;
  kapitza_catalogue *catalogue;
} catalogue_job;

static kz_status work_catalogue(kapitza_pendulum *p, void *context) {
  catalogue_job *j = context;
  const kz_live_catalogue *own;
  KZ_AUTOFREE_BY(kz_scene_free) kz_scene scene;
  KZ_TRY(kz_scene_open(&p->text, j->change, &scene));
  KZ_TRY(kz_engine_catalogue(p->engine, &scene, &own));
  j->catalogue = kz_border_give(catalogue_bytes(own));
  catalogue_put(own, j->catalogue);
  return KZ_OK;
}

kapitza_status kapitza_catalogue_of(kapitza_pendulum *pendulum, const char *change, kapitza_catalogue **catalogue) {
  catalogue_job job = {.change = change};
  const kapitza_status status = kz_library_call(pendulum, work_catalogue, &job);
  *catalogue = status == KAPITZA_OK ? job.catalogue : NULL;
  return status;
}

/* ---- frames ---- */

typedef struct {
  const kapitza_frame_request *request;
  kapitza_show show;
  kapitza_pause between;
  void *context;
  kapitza_pendulum *pendulum;
} frame_job;

static kz_status frame_pause(void *context) {
  const frame_job *j = context;
  return kz_library_between(j->pendulum, j->between, j->context);
}

static kz_status stopped_if(int stops) {
  return stops ? kz_fail(KZ_STOPPED, "stopped by the caller") : KZ_OK;
}

static kz_status frame_show(void *context, const kz_live_raster *r) {
  const frame_job *j = context;
  const kapitza_frame_request *request = j->request;
  KZ_AUTOFREE void *catalogue = kz_malloc(catalogue_bytes(r->catalogue));
  catalogue_put(r->catalogue, catalogue);
  kapitza_frame_part part = {.catalogue = catalogue,
                             .coarseness = (int32_t)r->coarseness,
                             .rows = (int32_t)r->rows,
                             .columns = (int32_t)r->columns,
                             .last = r->coarseness == request->coarseness[request->n_parts - 1],
                             .seconds = r->seconds};
  memcpy(part.plane, r->plane, sizeof part.plane);
  return stopped_if(j->show(j->context, &part));
}

/* The coarseness of all parts, checked. */
static kz_status take_coarseness(int32_t n, const int32_t *given, kz_integers *coarseness) {
  if (n < 1 || n > MOST_PARTS) return kz_fail(KZ_REFUSED, "n_parts: %d: must be from 1 to %d", (int)n, (int)MOST_PARTS);
  coarseness->count = n;
  for (int32_t i = 0; i < n; i++) {
    const int32_t step = given[i];
    if (step < 1 || step > 8 || (step & (step - 1)) != 0 || (i > 0 && step >= given[i - 1]))
      return kz_fail(KZ_REFUSED, "coarseness: %d is out of place; it must be a list from 8, 4, 2, 1 in falling order",
                     (int)step);
    coarseness->values[i] = step;
  }
  return KZ_OK;
}

static kz_status frame_make(const frame_job *j, kz_scene *scene) {
  const kapitza_frame_request *request = j->request;
  kz_integers coarseness;
  KZ_TRY(take_coarseness(request->n_parts, request->coarseness, &coarseness));
  if (scene->basin->theta.count * scene->basin->velocity.count > MOST_CELLS)
    return kz_fail(KZ_REFUSED, "basin.velocity.count: %lld times %lld are more than %d cells",
                   (long long)scene->basin->velocity.count, (long long)scene->basin->theta.count, (int)MOST_CELLS);
  kz_frame frame = {.moving = request->moving != 0,
                    .coarseness = &coarseness,
                    .pause = frame_pause,
                    .show = frame_show,
                    .context = (void *)j,
                    .x = request->x,
                    .y = request->y};
  for (int plane = 0; plane < KZ_PLANES; plane++) frame.plane[plane] = request->planes >> plane & 1;
  if (request->atlas) KZ_TRY(kz_library_atlas_of(j->pendulum, request->atlas, &frame.atlas));
  return kz_engine_frame(j->pendulum->engine, scene, &frame);
}

static kz_status work_frame(kapitza_pendulum *p, void *context) {
  frame_job *j = context;
  KZ_AUTOFREE_BY(kz_scene_free) kz_scene scene;
  j->pendulum = p;
  KZ_TRY(kz_scene_open(&p->text, j->request->change, &scene));
  const kz_status status = frame_make(j, &scene);
  kz_engine_rest(p->engine);
  return status;
}

kapitza_status kapitza_frame(kapitza_pendulum *pendulum, const kapitza_frame_request *request, kapitza_show show,
                             kapitza_pause between, void *context) {
  frame_job job = {.request = request, .show = show, .between = between, .context = context};
  return kz_library_call(pendulum, work_frame, &job);
}

/* ---- charts ---- */

typedef struct {
  const char *change;
  int32_t n_parts;
  const int32_t *coarseness;
  kapitza_show_chart show;
  kapitza_pause between;
  void *context;
  kapitza_pendulum *pendulum;
} chart_job;

static kz_status chart_pause(void *context) {
  const chart_job *j = context;
  return kz_library_between(j->pendulum, j->between, j->context);
}

static kz_status chart_show(void *context, const kz_plane_raster *r) {
  const chart_job *j = context;
  const kapitza_chart_part part = {.period = r->period,
                                   .centre = r->centre,
                                   .coarseness = (int32_t)r->coarseness,
                                   .rows = (int32_t)r->rows,
                                   .columns = (int32_t)r->columns,
                                   .last = r->coarseness == j->coarseness[j->n_parts - 1]};
  return stopped_if(j->show(j->context, &part));
}

static kz_status work_chart(kapitza_pendulum *p, void *context) {
  chart_job *j = context;
  kz_integers coarseness;
  int64_t points;
  KZ_AUTOFREE_BY(kz_scene_free) kz_scene scene = {0};
  j->pendulum = p;
  KZ_TRY(take_coarseness(j->n_parts, j->coarseness, &coarseness));
  KZ_TRY(kz_scene_open(&p->text, j->change, &scene));
  if (!scene.has_sweep) return kz_fail(KZ_REFUSED, "sweep: is missing; a chart needs its axes x and y");
  KZ_TRY(kz_drive_check_sine(&scene, KZ_ENDS_NEED_SINE));
  KZ_TRY(kz_plane_points(&scene, &points));
  if (points > MOST_POINTS)
    return kz_fail(KZ_REFUSED, "sweep.x: %lld points are too many for a chart on request, at most %d",
                   (long long)points, (int)MOST_POINTS);
  return kz_plane_draw(&scene, &coarseness, chart_pause, chart_show, j);
}

kapitza_status kapitza_chart(kapitza_pendulum *pendulum, const char *change, int32_t n_parts, const int32_t *coarseness,
                             kapitza_show_chart show, kapitza_pause between, void *context) {
  chart_job job = {change, n_parts, coarseness, show, between, context, NULL};
  return kz_library_call(pendulum, work_chart, &job);
}

/* ---- the pivot ---- */

typedef struct {
  int64_t n;
  const double *time;
  double *place;
} pivot_job;

static kz_status work_pivot(kapitza_pendulum *p, void *context) {
  const pivot_job *j = context;
  for (int64_t i = 0; i < j->n; i++) kz_pivot_at(&p->scene.parameters, j->time[i], j->place + 2 * i);
  return KZ_OK;
}

kapitza_status kapitza_pivot(kapitza_pendulum *pendulum, int64_t n, const double *time, double *place) {
  pivot_job job = {n, time, place};
  return kz_library_call(pendulum, work_pivot, &job);
}
