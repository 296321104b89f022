#include "drawing.h"

#include <stdlib.h>

#include "answer.h"

void kz_drawing_open(kz_drawing *drawing) {
  *drawing = (kz_drawing){.engine = kz_engine_create()};
}

void kz_drawing_close(kz_drawing *drawing) {
  kz_engine_free(drawing->engine);
  *drawing = (kz_drawing){0};
}

static kz_status answer_where(kz_drawing *d, const kz_request *request) {
  const kz_coordinate start[1][2] = {{kz_decimal_coordinate(&request->theta), kz_decimal_coordinate(&request->velocity)}};
  kz_ending ending;
  kz_status status = kz_engine_where(d->engine, &request->scene, 1, start, &ending);
  if (status == KZ_OK)
    status = kz_answer_where(request->sequence, start[0], &ending, request->scene.parameters.pivot_frequency);
  kz_where_free(1, &ending);
  return status;
}

static kz_status answer_catalogue(kz_drawing *d, const kz_request *request) {
  const kz_live_catalogue *catalogue;
  KZ_TRY(kz_engine_catalogue(d->engine, &request->scene, &catalogue));
  d->shown = catalogue->version;
  return kz_answer_catalogue(request->sequence, true, catalogue);
}

static kz_status answer_orbit(const kz_request *request) {
  int64_t samples;
  double *theta, *velocity;
  if (kz_release_strobes(&request->scene.parameters.release) > 0)
    return kz_fail(
        KZ_REFUSED,
        "request: orbit: a motion begins at phase 0 and without a ramp; leave out basin.start_phase and pendulum.ramp");
  kz_status status = kz_orbit_record(&request->scene, &samples, &theta, &velocity);
  if (status == KZ_OK) status = kz_answer_orbit(request, samples, theta, velocity);
  free(theta);
  free(velocity);
  return status;
}

kz_status kz_drawing_answer(kz_drawing *drawing, kz_request *request) {
  if (request->kind == KZ_REQUEST_ORBIT) return answer_orbit(request);
  return request->kind == KZ_REQUEST_WHERE ? answer_where(drawing, request) : answer_catalogue(drawing, request);
}

typedef struct {
  kz_drawing *drawing;
  const kz_request *request;
  kz_status (*pause)(void *);
  void *context;
} making;

static kz_status pause_making(void *context) {
  const making *m = context;
  return m->pause(m->context);
}

static kz_status show(void *context, const kz_live_level *level) {
  const making *m = context;
  const kz_integers *levels = &m->request->levels;
  if (level->catalogue->version != m->drawing->shown) {
    m->drawing->shown = level->catalogue->version;
    KZ_TRY(kz_answer_catalogue(m->request->sequence, false, level->catalogue));
  }
  return kz_answer_level(m->request, level->level == levels->values[levels->count - 1], level);
}

static kz_status show_chart(void *context, const kz_chart_level *level) {
  const making *m = context;
  const kz_integers *levels = &m->request->levels;
  return kz_answer_chart(m->request->sequence, level->level == levels->values[levels->count - 1], level);
}

static kz_status check_size(const kz_scene *scene) {
  const int64_t most = 1 << 20, points = scene->chart.x.values.count * scene->chart.y.values.count;
  if (points <= most) return KZ_OK;
  return kz_fail(KZ_REFUSED, "request: x: %lld points are too many for a chart on request, at most %lld", (long long)points,
                 (long long)most);
}

kz_status kz_drawing_make(kz_drawing *drawing, kz_request *request, kz_status (*pause)(void *), void *context) {
  making m = {.drawing = drawing, .request = request, .pause = pause, .context = context};
  if (request->kind == KZ_REQUEST_CHART) {
    KZ_TRY(kz_drive_check_chart(&request->scene));
    KZ_TRY(check_size(&request->scene));
    return kz_chart_draw(&request->scene, &request->levels, pause_making, show_chart, &m);
  }
  kz_frame frame = {.moving = request->quality == KZ_QUALITY_MOVING,
                    .levels = &request->levels,
                    .pause = pause_making,
                    .show = show,
                    .context = &m};
  for (int64_t i = 0; i < request->planes.count; i++) frame.plane[request->planes.values[i]] = true;
  return kz_engine_frame(drawing->engine, &request->scene, &frame);
}
