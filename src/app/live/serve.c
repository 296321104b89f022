/* The command serve: answers requests until their end. Frames and charts are made in parts; between two parts newer
 * requests are read and, unless they are frames or charts themselves, answered. */
#include <signal.h>

#include "commands.h"
#include "kapitza/dynamics_ends.h"
#include "answer.h"
#include "inbox.h"
#include "map.h"
#include "orbit.h"
#include "../../study/sweep/plan.h"

enum { MOST_WAITING = 1000 /* requests */ };

typedef struct {
  kz_scene_tree tree;
  kz_inbox inbox;
  kz_engine *engine;
  kz_map map;
  int64_t shown;       /* version of the catalogue that was sent last */
  kz_request *waiting; /* requests that have not been begun, the oldest first */
  int64_t n_waiting;
  kz_request *drawn; /* the frame or chart that is being made, or NULL */
  kz_request *orbit; /* the orbit that is being computed, maybe between two parts of that, or NULL */
  bool quits;
  int64_t quit; /* sequence of the request quit */
} server;

static bool is_drawn(const kz_request *request) {
  return request->kind == KZ_REQUEST_FRAME || request->kind == KZ_REQUEST_CHART;
}

/* Takes a request out of the list of those that wait. */
static kz_request *take_out(server *s, kz_request **place) {
  kz_request *request = *place;
  *place = request->next;
  s->n_waiting--;
  return request;
}

/* Answers a request that waits with `ended`. */
static kz_status end_waiting(server *s, kz_request **place) {
  kz_request *request = take_out(s, place);
  const int64_t sequence = request->sequence;
  kz_request_free(request);
  return kz_answer_ended(sequence);
}

static bool is_ended_by(const kz_request *old, const kz_request *by) {
  return strcmp(old->view, by->view) == 0 && (by->kind == KZ_REQUEST_CANCEL || is_drawn(old));
}

/* Ends what a request ends: cancel all requests of its view, a frame or chart the older frames and charts of its view.
 */
static kz_status end_older(server *s, const kz_request *by) {
  kz_request *const present[] = {s->drawn, s->orbit};
  for (kz_request **place = &s->waiting; *place;) {
    if (is_ended_by(*place, by))
      KZ_TRY(end_waiting(s, place));
    else
      place = &(*place)->next;
  }
  for (int i = 0; i < 2; i++)
    if (present[i] && is_ended_by(present[i], by)) present[i]->ended = true;
  return KZ_OK;
}

static kz_status serve_append(server *s, kz_request *request) {
  kz_request **end = &s->waiting;
  while (*end) end = &(*end)->next;
  *end = request;
  return ++s->n_waiting > MOST_WAITING ? end_waiting(s, &s->waiting) : KZ_OK;
}

/* A request that has been read, which it takes over: cancel and quit take effect, the others wait. */
static kz_status serve_take(server *s, kz_request *request) {
  if (request->kind == KZ_REQUEST_CANCEL || is_drawn(request)) KZ_TRY(end_older(s, request));
  if (request->kind != KZ_REQUEST_CANCEL && request->kind != KZ_REQUEST_QUIT) return serve_append(s, request);
  const int64_t sequence = request->sequence;
  const bool quits = request->kind == KZ_REQUEST_QUIT && !s->quits;
  kz_request_free(request);
  if (!quits) return kz_answer_ended(sequence);
  s->quits = true;
  s->quit = sequence;
  return KZ_OK;
}

/* Reads one request where there is one, and answers one that is wrong; `waits`: until there is one, or the end of the
 * input. *read: a line was there. */
static kz_status read_next(server *s, bool waits, bool *read) {
  kz_status wrong;
  size_t length;
  const char *line = kz_inbox_line(&s->inbox, waits, &length, &wrong);
  *read = line || wrong != KZ_OK;
  if (!*read) return KZ_OK;
  kz_request *request = NULL;
  if (line) wrong = kz_request_read(s->tree.root, line, length, &request);
  if (wrong == KZ_OK) return serve_take(s, request);
  const kz_status status = kz_answer_error(request ? request->sequence : KZ_UNSET_INTEGER, wrong);
  kz_request_free(request);
  return status;
}

/* Reads what is there. What waits is answered later. */
static kz_status read_ahead(void *context) {
  server *s = context;
  bool read = true;
  for (int i = 0; i < MOST_WAITING && read; i++) KZ_TRY(read_next(s, false, &read));
  if (s->quits && s->orbit) s->orbit->ended = true;
  return KZ_OK;
}

static kz_status answer_where(server *s, const kz_request *request) {
  const kz_coordinate start[1][2] = {
      {kz_decimal_coordinate(&request->theta), kz_decimal_coordinate(&request->velocity)}};
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

static kz_status answer_motions(server *s, const kz_request *request) {
  KZ_AUTOFREE_BY(kz_motions_free) kz_motions motions = {0};
  KZ_TRY(kz_map_open(&s->map, request->atlas));
  KZ_TRY(kz_atlas_motions(s->map.atlas, request->x, request->y, request->states, &motions));
  if (!motions.known)
    return kz_fail(KZ_REFUSED,
                   "request: x: the list of motions is not known at %.10g, %.10g: a curve is missing, as some class of "
                   "attractors has a negative count there",
                   request->x, request->y);
  return kz_answer_motions(request->sequence, &motions);
}

static kz_status answer_line(server *s, const kz_request *request) {
  KZ_AUTOFREE_BY(kz_atlas_branches_free) kz_atlas_branches line = {0};
  const int axis = isnan(request->y);
  KZ_TRY(kz_map_open(&s->map, request->atlas));
  KZ_TRY(kz_atlas_line(s->map.atlas, axis, axis ? request->x : request->y, &line));
  return kz_answer_line(request->sequence, &line);
}

static kz_status answer_orbit(server *s, kz_request *request) {
  s->orbit = request;
  const kz_status status = kz_orbit_answer(request, read_ahead, s);
  s->orbit = NULL;
  return status;
}

/* Answers a request that is no frame or chart, and frees it. */
static kz_status serve_answer(server *s, kz_request *request) {
  kz_status status = request->kind == KZ_REQUEST_WHERE     ? answer_where(s, request)
                     : request->kind == KZ_REQUEST_ORBIT   ? answer_orbit(s, request)
                     : request->kind == KZ_REQUEST_MOTIONS ? answer_motions(s, request)
                     : request->kind == KZ_REQUEST_LINE    ? answer_line(s, request)
                                                           : answer_catalogue(s, request);
  if (status == KZ_FAILED || status == KZ_REFUSED) status = kz_answer_error(request->sequence, status);
  kz_request_free(request);
  return status;
}

/* The first request that waits and is, or is not, a frame or chart. */
static kz_request **find_waiting(server *s, bool drawn) {
  kz_request **place = &s->waiting;
  while (*place && is_drawn(*place) != drawn) place = &(*place)->next;
  return place;
}

/* Answers what waits but frames and charts, then reads one request more, as long as there are any. */
static kz_status catch_up(server *s) {
  bool read = true;
  for (int i = 0; i < MOST_WAITING && read && !s->quits; i++) {
    for (kz_request **place; !s->quits && *(place = find_waiting(s, false));)
      KZ_TRY(serve_answer(s, take_out(s, place)));
    if (!s->quits) KZ_TRY(read_next(s, false, &read));
  }
  return KZ_OK;
}

/* Between two parts of a frame or chart. */
static kz_status pause_drawing(void *context) {
  server *s = context;
  KZ_TRY(catch_up(s));
  return s->drawn->ended || s->quits ? KZ_STOPPED : KZ_OK;
}

static kz_status serve_show(void *context, const kz_live_raster *raster) {
  server *s = context;
  const kz_integers *coarseness = &s->drawn->coarseness;
  if (raster->catalogue->version != s->shown) {
    s->shown = raster->catalogue->version;
    KZ_TRY(kz_answer_catalogue(s->drawn->sequence, false, raster->catalogue));
  }
  return kz_answer_raster(s->drawn, raster->coarseness == coarseness->values[coarseness->count - 1], raster);
}

static kz_status show_plane(void *context, const kz_plane_raster *raster) {
  server *s = context;
  const kz_integers *coarseness = &s->drawn->coarseness;
  return kz_answer_plane(s->drawn->sequence, raster->coarseness == coarseness->values[coarseness->count - 1], raster);
}

static kz_status check_size(const kz_scene *scene) {
  const int64_t most = 1 << 20, points = scene->sweep->x.values.count * scene->sweep->y.values.count;
  if (points <= most) return KZ_OK;
  return kz_fail(KZ_REFUSED, "request: x: %lld points are too many for a chart on request, at most %lld",
                 (long long)points, (long long)most);
}

static kz_status serve_draw(server *s, kz_request *request) {
  if (request->kind == KZ_REQUEST_CHART) {
    KZ_TRY(kz_drive_check_sine(&request->scene, KZ_ENDS_NEED_SINE));
    KZ_TRY(check_size(&request->scene));
    return kz_plane_draw(&request->scene, &request->coarseness, pause_drawing, show_plane, s);
  }
  kz_frame frame = {.moving = request->quality == KZ_QUALITY_MOVING,
                    .coarseness = &request->coarseness,
                    .pause = pause_drawing,
                    .show = serve_show,
                    .context = s,
                    .x = request->x,
                    .y = request->y};
  for (int64_t i = 0; i < request->planes.count; i++) frame.plane[request->planes.values[i]] = true;
  if (*request->atlas) {
    KZ_TRY(kz_map_open(&s->map, request->atlas));
    frame.atlas = s->map.atlas;
  }
  return kz_engine_frame(s->engine, &request->scene, &frame);
}

/* Makes the frame or chart that has waited longest. */
static kz_status draw_next(server *s) {
  kz_request *request = s->drawn = take_out(s, find_waiting(s, true));
  kz_status status = serve_draw(s, request);
  if (status == KZ_STOPPED && (request->ended || s->quits))
    status = kz_answer_ended(request->sequence);
  else if (status == KZ_FAILED || status == KZ_REFUSED)
    status = kz_answer_error(request->sequence, status);
  kz_request_free(request);
  s->drawn = NULL;
  return status;
}

/* After quit: all that waits, or has arrived, is answered with `ended`, and quit at last. */
static kz_status end_all(server *s) {
  KZ_TRY(read_ahead(s));
  while (s->waiting) KZ_TRY(end_waiting(s, &s->waiting));
  return kz_answer_ended(s->quit);
}

static kz_status answer_all(server *s) {
  while (!s->quits) {
    bool read;
    KZ_TRY(catch_up(s));
    if (!s->waiting && s->inbox.ended) return KZ_OK;
    if (!s->waiting && !s->quits) KZ_TRY(read_next(s, true, &read));
    if (!s->quits && *find_waiting(s, true)) KZ_TRY(draw_next(s));
    kz_engine_rest(s->engine); /* also where requests never cease, as those of a dragged slider */
  }
  return end_all(s);
}

static kz_status serve_greet(server *s, const kz_options *options) {
  kz_scene scene;
  char *text;
  size_t length;
  KZ_TRY(kz_scene_load(options->scene, &text, &length));
  kz_status status = kz_scene_tree_read(text, length, options->scene, options->n_sets, options->sets, &s->tree);
  free(text);
  if (status == KZ_OK) status = kz_scene_of_tree(s->tree.root, &scene);
  if (status != KZ_OK) return status;
  if (!scene.has_basin)
    status =
        kz_fail(KZ_REFUSED, "%s: scene: has no study basin, which gives the first window; add one", options->scene);
  if (status == KZ_OK) status = kz_answer_ready(&scene);
  kz_scene_free(&scene);
  return status;
}

static kz_status serve_run(const kz_options *options) {
  server s = {0};
  if (!options->prints) return KZ_OK;
  if (strcmp(options->scene, "-") == 0)
    return kz_fail(KZ_REFUSED, "serve: -: standard input is for requests; give the name of a scene file");
  signal(SIGPIPE, SIG_IGN); /* the reader of the answers may leave at any time */
  KZ_TRY(kz_answer_watch());
  kz_inbox_open(&s.inbox);
  s.engine = kz_engine_create();
  kz_status status = serve_greet(&s, options);
  if (status == KZ_OK) status = answer_all(&s);
  while (s.waiting) kz_request_free(take_out(&s, &s.waiting));
  kz_engine_free(s.engine);
  kz_map_close(&s.map);
  kz_inbox_close(&s.inbox);
  kz_scene_tree_free(&s.tree);
  return status == KZ_STOPPED ? KZ_OK : status;
}

const kz_command kz_serve_command = {
    "serve",   " SCENE",
    1,         1,
    serve_run, "answer requests of other programs (JSON lines on standard input) for frames, orbits and ends of starts",
    "set|help"};
