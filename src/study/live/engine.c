#define _GNU_SOURCE /* pthread_rwlockattr_setkind_np */
#include "live.h"

#include <math.h>
#include <stdlib.h>

#include "numerics/cells.h"
#include "where/where.h"

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

void kz_engine_free(kz_engine *engine) {
  if (!engine) return;
  for (int i = 0; i < KZ_RESIDENTS; i++) kz_resident_free(engine->resident + i);
  kz_kept_series_free(engine->series);
  pthread_rwlock_destroy(&engine->changing);
  free(engine);
}

/* The whole circle, and velocities up to the fastest of the window: what is known of a pendulum does not depend on where one looks. */
static kz_scene searched(const kz_engine *engine, const kz_scene *scene) {
  kz_scene wide = *scene;
  wide.series = engine->series;
  const double fastest = fmax(1, exp2(ceil(log2(kz_axis_fastest(&scene->basin.velocity) * (1 - 1e-9)))));
  wide.basin.theta = (kz_axis){.min = -M_PI, .max = M_PI, .count = scene->basin.theta.count};
  wide.basin.velocity = (kz_axis){.min = -fastest, .max = fastest, .count = scene->basin.velocity.count};
  return wide;
}

static kz_resident *find(kz_engine *engine, const kz_scene *scene, double tolerance) {
  for (int i = 0; i < KZ_RESIDENTS; i++)
    if (kz_resident_serves(engine->resident + i, scene, tolerance)) return engine->resident + i;
  return NULL;
}

/* The moving resident of the nearest pendulum that can be carried to the scene's. */
static kz_resident *nearest(kz_engine *engine, const kz_scene *scene) {
  kz_resident *found = NULL;
  double least = INFINITY;
  for (int i = 0; i < KZ_RESIDENTS; i++) {
    const double distance = kz_resident_distance(engine->resident + i, scene);
    if (distance >= least) continue;
    least = distance;
    found = engine->resident + i;
  }
  return found;
}

/* The place of the one that was used least lately, and of none that is busy. */
static kz_resident *oldest(kz_engine *engine) {
  kz_resident *place = NULL;
  for (int i = 0; i < KZ_RESIDENTS; i++) {
    kz_resident *r = engine->resident + i;
    if (!r->busy && (!place || r->used < place->used)) place = r;
  }
  return place;
}

void kz_engine_list(kz_engine *engine, kz_resident *resident) {
  kz_resident_list(resident, ++engine->versions, engine->shown, &engine->tracks);
  engine->shown = &resident->catalogue;
}

static kz_status make(kz_engine *engine, const kz_scene *scene, double tolerance, kz_resident *place) {
  const kz_scene wide = searched(engine, scene);
  kz_resident fresh;
  const kz_status status = kz_resident_make(&wide, tolerance, &fresh);
  if (status == KZ_OK) kz_resident_list(&fresh, ++engine->versions, engine->shown, &engine->tracks);
  if (engine->shown == &place->catalogue) engine->shown = NULL;
  kz_resident_free(place);
  if (status == KZ_OK)
    *place = fresh;
  else
    kz_resident_free(&fresh);
  return status;
}

kz_status kz_engine_resident(kz_engine *engine, const kz_scene *scene, bool moving, kz_resident **resident) {
  KZ_TRY(kz_drive_check_window(scene));
  kz_resident *near = NULL;
  const double tolerance = moving ? kz_moving_tolerance(scene) : 0;
  *resident = find(engine, scene, tolerance);
  if (!*resident && moving && (near = nearest(engine, scene))) {
    kz_resident_move(near, scene);
    kz_engine_list(engine, near);
    *resident = near;
  } else if (!*resident) {
    *resident = oldest(engine);
    KZ_TRY(make(engine, scene, tolerance, *resident));
  }
  (*resident)->used = ++engine->calls;
  engine->shown = &(*resident)->catalogue;
  return KZ_OK;
}

void kz_engine_rest(kz_engine *engine) {
  for (int i = 0; i < KZ_RESIDENTS; i++) {
    kz_resident *r = engine->resident + i;
    if (r->n_strays > 0 && kz_resident_discover(r)) kz_engine_list(engine, r);
  }
}

kz_status kz_engine_catalogue(kz_engine *engine, const kz_scene *scene, const kz_live_catalogue **catalogue) {
  kz_resident *resident;
  KZ_TRY(kz_engine_resident(engine, scene, false, &resident));
  *catalogue = &resident->catalogue;
  return KZ_OK;
}

/* Labels the starts, which may find attractors. A frame of the resident may be half done: its threads wait. */
static kz_status label(kz_engine *engine, kz_resident *r, kz_question *q) {
  const int64_t known = kz_dynamics_count(r->dynamics);
  pthread_rwlock_wrlock(&engine->changing);
  const kz_status status = kz_question_label(q);
  pthread_rwlock_unlock(&engine->changing);
  if (kz_dynamics_count(r->dynamics) > known) kz_engine_list(engine, r);
  return status;
}

kz_status kz_engine_where(kz_engine *engine, const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                          kz_ending *endings) {
  kz_resident *r;
  kz_endings_clear(n, endings);
  KZ_TRY(kz_engine_resident(engine, scene, false, &r));
  if (!r->dynamics || n == 0) return KZ_OK;
  KZ_FREED_BY(kz_question_free)
  kz_question q = {.scene = &r->scene, .dynamics = r->dynamics, .max_periods = r->search.max_periods, .n = n, .start = start};
  KZ_TRY(label(engine, r, &q));
  return kz_question_answer(&q, &r->catalogue.list, endings);
}
