/* The command serve: answers requests until their end. Frames and charts are made in parts, between which newer requests are heard. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "../app.h"
#include "answer.h"
#include "drawing.h"
#include "inbox.h"
#include "watch.h"

typedef struct {
  kz_scene_tree tree;
  kz_inbox inbox;
  kz_drawing drawing;  /* the engine, and what has been shown */
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

static void append(server *s, kz_request *request) {
  kz_request **end = &s->waiting;
  while (*end) end = &(*end)->next;
  *end = request;
}

/* A request that has been read: frames and charts wait, the others are answered at once. Takes it over. */
static kz_status take(server *s, kz_request *request) {
  kz_status status = KZ_OK;
  if (is_drawn(request)) {
    status = end_view(s, request->view);
    append(s, request);
    return status;
  }
  if (request->kind == KZ_REQUEST_QUIT)
    s->quits = true;
  else if (request->kind == KZ_REQUEST_CANCEL)
    status = end_view(s, request->view);
  else
    status = kz_drawing_answer(&s->drawing, request);
  if (status == KZ_OK && (request->kind == KZ_REQUEST_QUIT || request->kind == KZ_REQUEST_CANCEL))
    status = kz_answer_ended(request->sequence);
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

/* Between two parts of a frame. */
static kz_status pause_frame(void *context) {
  server *s = context;
  KZ_TRY(listen(s, false));
  return s->present_ended || s->quits ? KZ_STOPPED : KZ_OK;
}

/* Makes the frame or chart that has waited longest. */
static kz_status draw_next(server *s) {
  s->present = s->waiting;
  s->waiting = s->present->next;
  s->present_ended = false;
  kz_status status = kz_drawing_make(&s->drawing, s->present, pause_frame, s);
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
    kz_engine_rest(s->drawing.engine); /* also where requests never cease, as those of a dragged slider */
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
  KZ_TRY(kz_output_watch());
  kz_inbox_open(&s.inbox);
  kz_drawing_open(&s.drawing);
  kz_status status = greet(&s, options);
  if (status == KZ_OK) status = answer_all(&s);
  while (s.waiting) {
    kz_request *next = s.waiting->next;
    kz_request_free(s.waiting);
    s.waiting = next;
  }
  kz_drawing_close(&s.drawing);
  kz_inbox_close(&s.inbox);
  kz_scene_tree_free(&s.tree);
  return status == KZ_STOPPED ? KZ_OK : status;
}
