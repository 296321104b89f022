#include "live.h"

#include "cells/scene_search.h"
#include "numerics/cells.h"
#include "numerics/resolve.h"

/* rad: the error of a period that moving frames bear where their cells are wider than SMALL, and where they are not,
 * which at any depth are some 1e-7 wide when they are handed over; and the starts of the search. */
static const double COARSE = 1e-6, FINE = 1e-10, SMALL = 3e-5;
/* Step error of frames whose motions take more than SLOW periods on average: basins too fine for any error. */
static const double COARSEST = 1e-4, SLOW = 2000;
enum { MOVING_STARTS = 1024, MOVING_SOUGHT = 64 };
/* Trapping regions are grown as for this many cells, whatever the size of a frame: more saves no time. */
enum { CELLS = 130000 };
/* rad: strobe points that moved by more between two catalogues belong to different attractors. */
static const double NEAR = 0.5;

/* Relative changes of a pendulum: of the sum of its parameters, and of its damping. Beyond FARTHEST it is not moved,
 * because too many attractors would be lost; beyond RECHOSEN its numerics are chosen anew; beyond REGROWN, or REDAMPED
 * of the damping, or after OLDEST moves its trapping regions are grown anew. (Regions that are carried lose their rim.
 * On drags along a line, a circle and a wavy curve over the plane of Fig. 12, and in steps of 1 % from epsilon = 0.30
 * to 0.55, at most 12 of 100,000 labels of a frame differ from those by regions that are grown anew for each.) */
static const double FARTHEST = 0.3, RECHOSEN = 0.1, REGROWN = 0.012, REDAMPED = 0.1;
/* Factor by which a torque may drive motions faster than those for which the numerics were chosen. */
static const double FASTER = 1.01;
/* Share of the cells that must not settle before attractors are looked for between moving frames: following fewer costs
 * less than a search, whose cycles of many periods are often lost at the next pendulum. */
static const double MISSED = 0.01;
/* rad: how near unsettled states must come back to themselves for a search. */
static const double CLOSENESS = 0.02;
enum { OLDEST = 5, MOVING_CELLS = 192 };
/* Limits of moving frames: least drive periods that cells are followed; lifetimes 1/(2 pi beta). */
static const double LEAST_PERIODS = 400, LIFETIMES = 24;
/* Orbits that extend the trapping regions of moving frames (kz_dynamics_learn_regions). ORBITS: their number; VISITS:
 * drive periods of all of them together, about; WEAK: drive periods that motions take on average, from which on this
 * saves time. More orbits save no more: measured at Q = 20, 50 and 200 of Fig. 12, whose frames take a quarter of the
 * time. */
static const double ORBITS = 2048, WEAK = 60;
enum { VISITS = 500000 };

double kz_moving_tolerance(const kz_scene *scene) {
  const kz_axis *theta = &scene->basin->theta, *velocity = &scene->basin->velocity;
  const double cells[2] = {(double)kz_axis_width(theta) / (double)theta->count,
                           (double)kz_axis_width(velocity) / (double)velocity->count};
  if (fmin(cells[0], cells[1]) < SMALL) return FINE;
  return kz_settling_mean(scene->parameters.pendulum.beta) < SLOW ? COARSE : COARSEST;
}

/* Whether damping is so weak that motions take many periods on average. */
static bool is_weak(const kz_prepared *r) {
  return kz_settling_mean(r->scene.parameters.pendulum.beta) >= WEAK;
}

kz_stepper kz_prepared_late_stepper(const kz_prepared *prepared) {
  if (!is_weak(prepared)) return KZ_FOLLOW_DIRECT;
  return prepared->tolerance < COARSEST ? KZ_FOLLOW_SPARSE : KZ_FOLLOW_SINGLE;
}

static kz_window window_of(const kz_scene *scene) {
  return kz_window_of(&scene->basin->theta, &scene->basin->velocity);
}

/* Steps and terms: those of a scene of method exact, or the cheapest to the tolerance of moving frames. */
static void choose_numerics(kz_prepared *r) {
  kz_scene *scene = &r->scene;
  scene->basin->method = KZ_METHOD_EXACT;
  if (!kz_prepared_moves(r)) {
    kz_numerics_resolve(scene);
    return;
  }
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  scene->numerics = kz_processed_or_split(pendulum, scene->series, KZ_METHOD_DIRECT, r->tolerance,
                                          kz_fastest_motion(pendulum, &r->search.window, 0));
}

/* Whether an attractor has a cover: a motion counts as captured there only after many periods. */
static bool has_cover(const kz_prepared *r) {
  for (int64_t a = 1; a <= kz_dynamics_count(r->dynamics); a++) {
    kz_attractor attractor;
    kz_dynamics_attractor(r->dynamics, a, &attractor);
    if (attractor.period == 0 && (!kz_is_running(&attractor) || attractor.averaged)) return true;
  }
  return false;
}

/* Extends the trapping regions of moving frames by orbits, where damping is so weak that this saves time. */
static void prepared_learn(kz_prepared *r) {
  const double mean = kz_settling_mean(r->scene.parameters.pendulum.beta);
  if (!kz_prepared_moves(r) || (!is_weak(r) && !has_cover(r))) return;
  const int64_t n = (int64_t)fmin(ORBITS, VISITS / fmax(mean, has_cover(r) ? (double)r->periods : 0));
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)(n + 1) * sizeof *state);
  kz_dynamics_starts(&r->search.window, r->search.seed, n, state);
  kz_dynamics_learn_regions(r->dynamics, n, state, r->periods, 2 * VISITS);
}

static kz_status search_frame(kz_prepared *r, const kz_frame *frame) {
  r->dynamics = kz_dynamics_create(&r->scene.parameters.pendulum, &r->scene.numerics, r->scene.basin->max_period);
  r->search.max_velocity = kz_dynamics_max_velocity(r->dynamics, &r->search.window);
  if (kz_prepared_moves(r) && frame->atlas) {
    kz_dynamics_regions(r->dynamics, 0, r->search.max_velocity);
    KZ_TRY(kz_prepared_take_listed(r, frame));
    kz_regions_grow(r->dynamics, CELLS, r->search.max_velocity);
  } else {
    KZ_TRY(kz_search_window(NULL, r->dynamics, &r->search, NULL));
  }
  kz_dynamics_set_release(r->dynamics, &r->release);
  prepared_learn(r);
  return KZ_OK;
}

static int64_t periods_of(const kz_scene *scene, bool moving) {
  const double enough = fmax(LEAST_PERIODS, LIFETIMES / (2 * M_PI * scene->parameters.pendulum.beta));
  return moving ? (int64_t)fmin(enough, (double)scene->basin->max_periods) : scene->basin->max_periods;
}

kz_status kz_prepared_make(const kz_scene *scene, double tolerance, const kz_frame *frame, kz_prepared *prepared) {
  const bool moving = tolerance > 0;
  *prepared = (kz_prepared){.scene = *scene, .tolerance = tolerance};
  prepared->release = kz_release_of(scene, &scene->parameters.pendulum);
  prepared->chosen = prepared->grown = scene->parameters.pendulum;
  prepared->periods = periods_of(scene, moving);
  prepared->scene.title = NULL;
  kz_plans_copy(&prepared->scene);
  prepared->search = kz_search_of(scene);
  prepared->search.cells = CELLS;
  if (moving) {
    if (prepared->search.starts > MOVING_STARTS) prepared->search.starts = MOVING_STARTS;
    prepared->search.sought = MOVING_SOUGHT; /* idle time finds the rest */
  }
  if (scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  choose_numerics(prepared);
  return search_frame(prepared, frame);
}

static void free_catalogue(kz_live_catalogue *catalogue) {
  kz_catalogue_free(&catalogue->list);
  free(catalogue->track);
  *catalogue = (kz_live_catalogue){0};
}

void kz_prepared_free(kz_prepared *prepared) {
  kz_dynamics_free(prepared->dynamics);
  kz_images_free(prepared->images);
  kz_plans_free(&prepared->scene);
  free_catalogue(&prepared->catalogue);
  *prepared = (kz_prepared){0};
}

bool kz_prepared_misses(const kz_prepared *r) {
  return r->n_unsettled > 0 && (double)r->left >= MISSED * (double)r->ended;
}

bool kz_prepared_discover(kz_prepared *r) {
  const int64_t known = kz_dynamics_count(r->dynamics);
  KZ_AUTOFREE double *found = kz_calloc((size_t)kz_dynamics_find_size(r->dynamics, KZ_FIND_CYCLE), sizeof *found);
  KZ_AUTOFREE double *covered = kz_calloc((size_t)kz_dynamics_find_size(r->dynamics, KZ_FIND_CHAOS), sizeof *covered);
  while ((int)found[0] < r->n_unsettled) {
    kz_dynamics_find(r->dynamics, KZ_FIND_CYCLE, r->n_unsettled, r->unsettled, CLOSENESS, found);
    kz_dynamics_adopt(r->dynamics, found);
  }
  if (kz_dynamics_count(r->dynamics) == known && r->n_unsettled == KZ_MOST_UNSETTLED) {
    kz_dynamics_find(r->dynamics, KZ_FIND_RUNNING, r->n_unsettled, r->unsettled, (double)r->periods, covered);
    if (covered[1] == 0) kz_dynamics_find(r->dynamics, KZ_FIND_CHAOS, 1, r->unsettled, 0, covered);
    kz_dynamics_adopt(r->dynamics, covered);
  }
  r->ended = r->left = r->n_unsettled = 0;
  if (kz_dynamics_count(r->dynamics) == known) return false;
  kz_dynamics_update(r->dynamics);
  return true;
}

static bool same_search(const kz_prepared *prepared, const kz_scene *scene) {
  const kz_basin_plan *mine = prepared->scene.basin, *plan = scene->basin;
  const kz_window own = window_of(&prepared->scene), asked = window_of(scene);
  return asked.velocity_min >= own.velocity_min && asked.velocity_max <= own.velocity_max &&
         mine->max_period == plan->max_period && mine->starts == plan->starts && mine->seed == plan->seed;
}

/* How far the damping of two pendulums is apart, of the larger one. */
static double damped_apart(const kz_pendulum *a, const kz_pendulum *b) {
  return fabs(a->beta - b->beta) / fmax(a->beta, b->beta);
}

double kz_prepared_distance(const kz_prepared *prepared, const kz_scene *scene) {
  if (prepared->used == 0 || !kz_prepared_moves(prepared) || !prepared->dynamics || prepared->busy) return INFINITY;
  if (!(scene->parameters.pendulum.beta > 0) || !same_search(prepared, scene)) return INFINITY;
  const kz_pendulum *own = &prepared->scene.parameters.pendulum, *other = &scene->parameters.pendulum;
  const double prepared_distance = kz_pendulums_parted(own, other);
  return prepared_distance < FARTHEST && damped_apart(own, other) < FARTHEST ? prepared_distance : INFINITY;
}

kz_status kz_prepared_move(kz_prepared *r, const kz_scene *scene, const kz_frame *frame) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  const double tolerance = kz_moving_tolerance(scene);
  int64_t lost;
  r->scene.parameters = scene->parameters;
  r->release = kz_release_of(scene, &scene->parameters.pendulum);
  r->scene.basin->max_periods = scene->basin->max_periods;
  r->search.max_periods = scene->basin->max_periods;
  r->periods = periods_of(scene, true);
  const bool faster = fabs(pendulum->torque) * r->chosen.beta > FASTER * fabs(r->chosen.torque) * pendulum->beta;
  if (faster || kz_pendulums_parted(&r->chosen, pendulum) > RECHOSEN || tolerance != r->tolerance) {
    r->tolerance = tolerance;
    choose_numerics(r);
    r->chosen = *pendulum;
  }
  kz_dynamics *moved = kz_dynamics_continue(r->dynamics, pendulum, &r->scene.numerics, r->tolerance, &lost);
  kz_dynamics_free(r->dynamics);
  r->dynamics = moved;
  r->ended = r->left = r->n_unsettled = 0;
  kz_dynamics_set_release(moved, &r->release);
  if (frame->atlas) KZ_TRY(kz_prepared_take_listed(r, frame));
  if (faster) r->search.max_velocity = kz_dynamics_max_velocity(moved, &r->search.window);
  const bool far =
      faster || kz_pendulums_parted(&r->grown, pendulum) > REGROWN || damped_apart(&r->grown, pendulum) > REDAMPED;
  if (lost > 0 || far || ++r->age >= OLDEST) {
    kz_dynamics_regions(moved, MOVING_CELLS, r->search.max_velocity);
    prepared_learn(r);
    r->grown = *pendulum;
    r->age = 0;
  } else if (has_cover(r)) {
    prepared_learn(r);
  }
  return KZ_OK;
}

bool kz_prepared_serves(const kz_prepared *prepared, const kz_scene *scene, double tolerance) {
  const kz_release release = kz_release_of(scene, &scene->parameters.pendulum);
  return prepared->used > 0 && prepared->tolerance == tolerance &&
         memcmp(&prepared->scene.parameters.pendulum, &scene->parameters.pendulum, sizeof(kz_pendulum)) == 0 &&
         kz_release_is_same(&prepared->release, &release) &&
         prepared->scene.basin->max_periods == scene->basin->max_periods && same_search(prepared, scene);
}

/* rad: how far the nearest strobe point of `b` lies from the first one of `a`. Chaotic attractors have none. */
static double entries_distance(const kz_entry *a, const kz_entry *b) {
  double nearest = a->row.period == 0 ? 0 : INFINITY;
  for (int i = 0; i < b->row.period; i++)
    nearest = fmin(nearest, hypot(remainder(a->theta[0] - b->theta[i], 2 * M_PI), a->velocity[0] - b->velocity[i]));
  return nearest;
}

static bool is_taken(const int64_t *track, int64_t count, int64_t number) {
  for (int64_t i = 0; i < count; i++)
    if (track[i] == number) return true;
  return false;
}

/* The track of attractor i: that of the nearest one of its kind. */
static int64_t track_of(const kz_live_catalogue *catalogue, int64_t i, const kz_live_catalogue *before,
                        int64_t *tracks) {
  const kz_entry *a = catalogue->list.entries + i;
  double nearest = NEAR;
  int64_t number = -1;
  for (int64_t j = 0; before && j < before->list.count; j++) {
    const kz_entry *b = before->list.entries + j;
    if (a->row.period != b->row.period || a->row.winding != b->row.winding || a->row.centre != b->row.centre) continue;
    const double d = entries_distance(a, b);
    if (d >= nearest || is_taken(catalogue->track, i, before->track[j])) continue;
    nearest = d;
    number = before->track[j];
  }
  return number >= 0 ? number : (*tracks)++;
}

void kz_prepared_list(kz_prepared *r, int64_t version, const kz_live_catalogue *before, int64_t *tracks) {
  kz_live_catalogue own = r->catalogue;
  r->catalogue = (kz_live_catalogue){.version = version, .parameters = r->scene.parameters};
  if (r->dynamics) kz_catalogue_make(r->dynamics, NULL, &r->catalogue.list);
  r->catalogue.track = kz_calloc((size_t)r->catalogue.list.count + 1, sizeof *r->catalogue.track);
  for (int64_t i = 0; i < r->catalogue.list.count; i++)
    r->catalogue.track[i] = track_of(&r->catalogue, i, own.list.count > 0 ? &own : before, tracks);
  free_catalogue(&own);
}
