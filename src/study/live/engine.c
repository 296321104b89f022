#define _GNU_SOURCE /* pthread_rwlockattr_setkind_np */
#include "live.h"

#include "numerics/cells.h"
#include "where/where.h"
#include "kapitza/common_border.h"

kz_engine *kz_engine_create(void) {
  kz_engine *engine = kz_calloc(1, sizeof *engine);
  pthread_rwlockattr_t attributes;
  pthread_rwlockattr_init(&attributes);
  pthread_rwlockattr_setkind_np(&attributes,
                                PTHREAD_RWLOCK_PREFER_WRITER_NONRECURSIVE_NP); /* it waits for one tile, not for all */
  pthread_rwlock_init(&engine->changing, &attributes);
  pthread_rwlockattr_destroy(&attributes);
  engine->series = kz_kept_series_create();
  return engine;
}

/* The whole circle, and velocities up to the fastest of the window: what is known of a pendulum does not depend on
 * where one looks. The caller frees its plans. */
static kz_scene engine_searched(const kz_engine *engine, const kz_scene *scene) {
  kz_scene wide = *scene;
  wide.series = engine->series;
  kz_plans_copy(&wide);
  const double fastest = fmax(1, exp2(ceil(log2(kz_axis_fastest(&scene->basin->velocity) * (1 - 1e-9)))));
  wide.basin->theta = (kz_axis){.min = -M_PI, .max = M_PI, .count = scene->basin->theta.count};
  wide.basin->velocity = (kz_axis){.min = -fastest, .max = fastest, .count = scene->basin->velocity.count};
  return wide;
}

static kz_prepared *engine_find(kz_engine *engine, const kz_scene *scene, double tolerance) {
  for (int i = 0; i < KZ_MOST_PREPARED; i++)
    if (kz_prepared_serves(engine->prepared + i, scene, tolerance)) return engine->prepared + i;
  return NULL;
}

/* Returns the nearest pendulum for moving frames that can be carried to the scene's. */
static kz_prepared *engine_nearest(kz_engine *engine, const kz_scene *scene) {
  kz_prepared *found = NULL;
  double least = INFINITY;
  for (int i = 0; i < KZ_MOST_PREPARED; i++) {
    const double distance = kz_prepared_distance(engine->prepared + i, scene);
    if (distance >= least) continue;
    least = distance;
    found = engine->prepared + i;
  }
  return found;
}

/* The place of the one that was used least lately, and of none that is busy. */
static kz_prepared *engine_oldest(kz_engine *engine) {
  kz_prepared *place = NULL;
  for (int i = 0; i < KZ_MOST_PREPARED; i++) {
    kz_prepared *r = engine->prepared + i;
    if (!r->busy && (!place || r->used < place->used)) place = r;
  }
  return place;
}

void kz_engine_list(kz_engine *engine, kz_prepared *prepared) {
  kz_prepared_list(prepared, ++engine->versions, engine->shown, &engine->tracks);
  engine->shown = &prepared->catalogue;
}

static void engine_forget(kz_engine *engine, kz_prepared *place) {
  if (engine->shown == &place->catalogue) engine->shown = NULL;
  kz_prepared_free(place);
}

static kz_status engine_make(kz_engine *engine, const kz_scene *scene, double tolerance, const kz_frame *frame,
                             kz_prepared *place) {
  kz_scene wide = engine_searched(engine, scene);
  kz_prepared fresh;
  const kz_status status = kz_prepared_make(&wide, tolerance, frame, &fresh);
  kz_plans_free(&wide);
  if (status == KZ_OK) kz_prepared_list(&fresh, ++engine->versions, engine->shown, &engine->tracks);
  engine_forget(engine, place);
  if (status == KZ_OK)
    *place = fresh;
  else
    kz_prepared_free(&fresh);
  return status;
}

kz_status kz_engine_prepared(kz_engine *engine, const kz_scene *scene, const kz_frame *frame, kz_prepared **prepared) {
  kz_prepared *near = NULL;
  const bool moving = frame && frame->moving;
  const double tolerance = moving ? kz_moving_tolerance(scene) : 0;
  *prepared = engine_find(engine, scene, tolerance);
  if (!*prepared && moving && (near = engine_nearest(engine, scene))) {
    const kz_status status = kz_prepared_move(near, scene, frame);
    if (status != KZ_OK) {
      engine_forget(engine, near);
      return status;
    }
    kz_engine_list(engine, near);
    *prepared = near;
  } else if (!*prepared) {
    *prepared = engine_oldest(engine);
    KZ_TRY(engine_make(engine, scene, tolerance, frame, *prepared));
  }
  (*prepared)->used = ++engine->calls;
  engine->shown = &(*prepared)->catalogue;
  return KZ_OK;
}

void kz_engine_rest(kz_engine *engine) {
  for (int i = 0; i < KZ_MOST_PREPARED; i++) {
    kz_prepared *r = engine->prepared + i;
    if (kz_prepared_misses(r) && kz_prepared_discover(r)) kz_engine_list(engine, r);
  }
}

kz_status kz_engine_catalogue(kz_engine *engine, const kz_scene *scene, const kz_live_catalogue **catalogue) {
  kz_prepared *prepared;
  KZ_TRY(kz_engine_prepared(engine, scene, NULL, &prepared));
  *catalogue = &prepared->catalogue;
  return KZ_OK;
}

static kz_status question_label(void *question) {
  return kz_question_label(question);
}

/* Labels the starts, which may find attractors. A frame of this pendulum may be half done: its threads wait. */
static kz_status engine_label(kz_engine *engine, kz_prepared *r, kz_question *q) {
  const int64_t known = kz_dynamics_count(r->dynamics);
  pthread_rwlock_wrlock(&engine->changing);
  const kz_status status = kz_border_guard(question_label, q);
  pthread_rwlock_unlock(&engine->changing);
  kz_border_leave();
  if (kz_dynamics_count(r->dynamics) > known) kz_engine_list(engine, r);
  return status;
}

/* Labels a part of the starts, whose numbers of attractors become ids later. */
static kz_status label_part(kz_engine *engine, kz_prepared *r, int64_t n, const double (*start)[2], double start_error,
                            kz_label *found, double *error) {
  KZ_AUTOFREE kz_coordinate(*coordinate)[2] = kz_calloc((size_t)n, sizeof *coordinate);
  for (int64_t i = 0; i < 2 * n; i++) coordinate[i / 2][i % 2].high = start[i / 2][i % 2];
  KZ_AUTOFREE_BY(kz_question_free)
  kz_question q = {.scene = &r->scene,
                   .dynamics = r->dynamics,
                   .max_periods = r->search.max_periods,
                   .n = n,
                   .start = coordinate,
                   .start_error = start_error};
  KZ_TRY(engine_label(engine, r, &q));
  memcpy(found, q.label, (size_t)n * sizeof *found);
  memcpy(error, q.error, (size_t)n * sizeof *error);
  return KZ_OK;
}

kz_status kz_engine_labels(kz_engine *engine, const kz_scene *scene, int64_t n, const double (*start)[2],
                           double start_error, kz_label *label, double *error, const kz_live_catalogue **catalogue) {
  enum { PART = 1 << 15 }; /* starts that are labelled together */
  kz_prepared *r;
  KZ_TRY(kz_engine_prepared(engine, scene, NULL, &r));
  for (int64_t done = 0; done < n; done += PART) {
    const int64_t part = n - done < PART ? n - done : PART;
    if (r->dynamics)
      KZ_TRY(label_part(engine, r, part, start + done, start_error, label + done, error + done));
    else /* without damping nothing attracts */
      for (int64_t i = done; i < done + part; i++) label[i] = (kz_label){.turns = KZ_NO_TURNS};
  }
  const int32_t *id_of = r->catalogue.list.id_of;
  for (int64_t i = 0; i < n; i++) {
    const bool bounded = label[i].label > 0 && kz_evidence_word(label[i].evidence);
    if (!bounded) error[i] = NAN;
    label[i].label = (int16_t)(label[i].label > 0 ? id_of[label[i].label] : -1);
    label[i].other = (int16_t)(label[i].other > 0 ? id_of[label[i].other] : -1);
    label[i].evidence = kz_file_evidence(label + i, label[i].label >= 0);
  }
  *catalogue = &r->catalogue;
  return KZ_OK;
}

kz_status kz_engine_where(kz_engine *engine, const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                          kz_ending *endings) {
  kz_prepared *r;
  kz_endings_clear(n, endings);
  KZ_TRY(kz_engine_prepared(engine, scene, NULL, &r));
  if (!r->dynamics || n == 0) return KZ_OK;
  KZ_AUTOFREE_BY(kz_question_free)
  kz_question q = {
      .scene = &r->scene, .dynamics = r->dynamics, .max_periods = r->search.max_periods, .n = n, .start = start};
  KZ_TRY(engine_label(engine, r, &q));
  return kz_question_answer(&q, &r->catalogue.list, endings);
}
