/* The command serve: answers requests until their end. Frames and charts are made in parts, between which newer requests are heard. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "../app.h"
#include "answer.h"
#include "inbox.h"

typedef struct {
  kz_scene_tree tree;
  kz_inbox inbox;
  kz_engine *engine;
  int64_t shown;       /* version of the catalogue that was sent last */
  kz_request *waiting; /* frames and charts, the oldest first */
  kz_request *present; /* of those, the one that is being made */
  bool present_ended;  /* a newer one, or cancel, ended it */
  bool quits;
} server;

static bool is_drawn(const kz_request *request) {
  return request->kind == KZ_REQUEST_FRAME || request->kind == KZ_REQUEST_CHART;
}

/* Ends the frames and charts of a view. */
static kz_status end_view(server *s, const char *view) {
  for (kz_request **place = &s->waiting; *place;) {
    kz_request *old = *place;
    if (strcmp(old->view, view) != 0) {
      place = &old->next;
      continue;
    }
    *place = old->next;
    const int64_t sequence = old->sequence;
    kz_request_free(old);
    KZ_TRY(kz_answer_ended(sequence));
  }
  s->present_ended = s->present_ended || (s->present && strcmp(s->present->view, view) == 0);
  return KZ_OK;
}

static kz_status answer_where(server *s, const kz_request *request) {
  const kz_coordinate start[1][2] = {{kz_decimal_coordinate(&request->theta), kz_decimal_coordinate(&request->velocity)}};
  kz_ending ending;
  kz_status status = kz_engine_where(s->engine, &request->scene, 1, start, &ending);
  if (status == KZ_OK)
    status = kz_answer_where(request->sequence, start[0], &ending, request->scene.parameters.pivot_frequency);
  kz_where_free(1, &ending);
  return status;
}

static kz_status answer_catalogue(server *s, const kz_request *request) {
  const kz_live_catalogue *catalogue;
  KZ_TRY(kz_engine_catalogue(s->engine, &request->scene, &catalogue));
  s->shown = catalogue->version;
  return kz_answer_catalogue(request->sequence, true, catalogue);
}

static kz_status answer_orbit(const kz_request *request) {
  int64_t samples;
  KZ_FREED double *theta = NULL, *velocity = NULL;
  if (kz_release_strobes(&request->scene.parameters.release) > 0)
    return kz_fail(
        KZ_REFUSED,
        "request: orbit: a motion begins at phase 0 and without a ramp; leave out basin.start_phase and pendulum.ramp");
  KZ_TRY(kz_orbit_record(&request->scene, &samples, &theta, &velocity));
  return kz_answer_orbit(request, samples, theta, velocity);
}

/* What is answered at once. After KZ_REFUSED and KZ_FAILED no answer has been written. */
static kz_status answer(server *s, const kz_request *request) {
  switch (request->kind) {
    case KZ_REQUEST_WHERE:
      return answer_where(s, request);
    case KZ_REQUEST_ORBIT:
      return answer_orbit(request);
    case KZ_REQUEST_CATALOGUE:
      return answer_catalogue(s, request);
    default: /* cancel, quit */
      s->quits = s->quits || request->kind == KZ_REQUEST_QUIT;
      if (request->kind == KZ_REQUEST_CANCEL) KZ_TRY(end_view(s, request->view));
      return kz_answer_ended(request->sequence);
  }
}

/* A request that has been read: frames and charts wait, the others are answered at once. Takes it over. */
static kz_status take(server *s, kz_request *request) {
  if (is_drawn(request)) {
    const kz_status status = end_view(s, request->view);
    kz_request **end = &s->waiting;
    while (*end) end = &(*end)->next;
    *end = request;
    return status;
  }
  kz_status status = answer(s, request);
  if (status == KZ_FAILED || status == KZ_REFUSED) status = kz_answer_error(request->sequence, status);
  kz_request_free(request);
  return status;
}

/* Takes the requests that are there; `waits`: at least one, or the end of the input. */
static kz_status listen(server *s, bool waits) {
  kz_status status = KZ_OK, wrong;
  size_t length;
  do {
    const char *line = kz_inbox_line(&s->inbox, waits, &length, &wrong);
    if (!line && wrong == KZ_OK) return KZ_OK;
    kz_request *request = NULL;
    if (line) wrong = kz_request_read(s->tree.root, line, length, &request);
    if (wrong == KZ_OK) {
      status = take(s, request);
    } else {
      status = kz_answer_error(request ? request->sequence : KZ_UNSET_INTEGER, wrong);
      kz_request_free(request);
    }
    waits = false;
  } while (status == KZ_OK && !s->quits);
  return status;
}

/* Between two parts of a frame or chart. */
static kz_status pause_drawing(void *context) {
  server *s = context;
  KZ_TRY(listen(s, false));
  return s->present_ended || s->quits ? KZ_STOPPED : KZ_OK;
}

static kz_status show(void *context, const kz_live_level *level) {
  server *s = context;
  const kz_integers *levels = &s->present->levels;
  if (level->catalogue->version != s->shown) {
    s->shown = level->catalogue->version;
    KZ_TRY(kz_answer_catalogue(s->present->sequence, false, level->catalogue));
  }
  return kz_answer_level(s->present, level->level == levels->values[levels->count - 1], level);
}

static kz_status show_chart(void *context, const kz_chart_level *level) {
  server *s = context;
  const kz_integers *levels = &s->present->levels;
  return kz_answer_chart(s->present->sequence, level->level == levels->values[levels->count - 1], level);
}

static kz_status check_size(const kz_scene *scene) {
  const int64_t most = 1 << 20, points = scene->chart.x.values.count * scene->chart.y.values.count;
  if (points <= most) return KZ_OK;
  return kz_fail(KZ_REFUSED, "request: x: %lld points are too many for a chart on request, at most %lld", (long long)points,
                 (long long)most);
}

static kz_status draw(server *s, kz_request *request) {
  if (request->kind == KZ_REQUEST_CHART) {
    KZ_TRY(kz_drive_check_chart(&request->scene));
    KZ_TRY(check_size(&request->scene));
    return kz_chart_draw(&request->scene, &request->levels, pause_drawing, show_chart, s);
  }
  kz_frame frame = {.moving = request->quality == KZ_QUALITY_MOVING,
                    .levels = &request->levels,
                    .pause = pause_drawing,
                    .show = show,
                    .context = s};
  for (int64_t i = 0; i < request->planes.count; i++) frame.plane[request->planes.values[i]] = true;
  return kz_engine_frame(s->engine, &request->scene, &frame);
}

/* Makes the frame or chart that has waited longest. */
static kz_status draw_next(server *s) {
  s->present = s->waiting;
  s->waiting = s->present->next;
  s->present_ended = false;
  kz_status status = draw(s, s->present);
  if (status == KZ_STOPPED && (s->present_ended || s->quits))
    status = kz_answer_ended(s->present->sequence);
  else if (status == KZ_FAILED || status == KZ_REFUSED)
    status = kz_answer_error(s->present->sequence, status);
  kz_request_free(s->present);
  s->present = NULL;
  return status;
}

static kz_status answer_all(server *s) {
  while (!s->quits) {
    KZ_TRY(listen(s, false));
    if (!s->waiting && s->inbox.ended) return KZ_OK;
    if (!s->waiting && !s->quits) KZ_TRY(listen(s, true));
    if (!s->quits && s->waiting) KZ_TRY(draw_next(s));
    kz_engine_rest(s->engine); /* also where requests never cease, as those of a dragged slider */
  }
  return KZ_OK;
}

static kz_status greet(server *s, const kz_options *options) {
  kz_scene scene;
  char *text;
  size_t length;
  KZ_TRY(kz_scene_load(options->scene, &text, &length));
  kz_status status = kz_scene_tree_read(text, length, options->scene, options->n_sets, options->sets, &s->tree);
  free(text);
  if (status == KZ_OK) status = kz_scene_of_tree(s->tree.root, &scene);
  if (status != KZ_OK) return status;
  if (!scene.has_basin)
    status = kz_fail(KZ_REFUSED, "%s: scene: has no study basin, which gives the first window; add one", options->scene);
  if (status == KZ_OK) status = kz_answer_ready(&scene);
  kz_scene_free(&scene);
  return status;
}

kz_status kz_app_serve(const kz_options *options) {
  server s = {0};
  if (!options->speaks) return KZ_OK;
  if (strcmp(options->scene, "-") == 0)
    return kz_fail(KZ_REFUSED, "serve: -: standard input is for requests; give the name of a scene file");
  signal(SIGPIPE, SIG_IGN); /* whoever asks may leave at any time */
  KZ_TRY(kz_answer_watch());
  kz_inbox_open(&s.inbox);
  s.engine = kz_engine_create();
  kz_status status = greet(&s, options);
  if (status == KZ_OK) status = answer_all(&s);
  while (s.waiting) {
    kz_request *next = s.waiting->next;
    kz_request_free(s.waiting);
    s.waiting = next;
  }
  kz_engine_free(s.engine);
  kz_inbox_close(&s.inbox);
  kz_scene_tree_free(&s.tree);
  return status == KZ_STOPPED ? KZ_OK : status;
}
