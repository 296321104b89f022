/* Ends of starts: the catalogue of the window, then each start in as much precision as needed. One rank. */
#include "numerics/cells.h"
#include "cells/scene_search.h"
#include "where.h"
#include "window/window.h"

/* A kz_start_fn: a pair of doubles, and what it leaves out of a longer number. */
static kz_status start_of(void *context, int64_t i, kz_precision level, kz_start *start) {
  static const double pair_error = 4e-32;
  const kz_question *q = context;
  const kz_coordinate *theta = &q->start[i][0], *velocity = &q->start[i][1];
  const double rounding = theta->centre || velocity->centre ? pair_error * hypot(theta->high, velocity->high) : 0;
  const double error = fmax(q->start_error, rounding);
  (void)level;
  *start = (kz_start){.theta = {theta->high, theta->low},
                      .velocity = {velocity->high, velocity->low},
                      .error = {error * error, 0, error * error}};
  return KZ_OK;
}

/* Level of kz_added_levels for starts with more digits than pairs; doubles are labelled as exact cells are. */
static kz_status where_decide(void *context, int32_t row, int64_t n, const int64_t *item, kz_decision *decision) {
  const kz_question *q = context;
  (void)row;
  for (int64_t i = 0; i < n; i++) {
    const kz_coordinate *start = q->start[item[i]];
    decision[i] = (kz_decision){.end.label = KZ_DOUBTFUL, .error = NAN};
    if (start[0].centre || start[1].centre)
      KZ_TRY(kz_own_orbit_decide(q->dynamics, &q->scene->parameters.pendulum, start, q->max_periods, decision + i));
  }
  return KZ_OK;
}

/* A kz_note_fn. */
static void where_note(void *context, int64_t i, const kz_decision *decision) {
  ((kz_question *)context)->error[i] = decision->error;
}

static kz_labeller labeller_of(const kz_question *q) {
  static const kz_added_levels own_orbits = {&kz_own_orbit_level, 1, where_decide};
  return (kz_labeller){.dynamics = q->dynamics,
                       .max_periods = q->max_periods,
                       .way = KZ_BY_LEVELS,
                       .turns = true,
                       .open = KZ_OPEN_CANDIDATES,
                       .start = start_of,
                       .added = &own_orbits,
                       .note = where_note,
                       .context = (void *)q};
}

kz_status kz_question_label(kz_question *q) {
  const kz_search_on search = {1, q->n, NULL};
  const kz_labeller labeller = labeller_of(q);
  q->label = kz_malloc(((size_t)q->n + 1) * sizeof *q->label);
  q->error = kz_malloc(((size_t)q->n + 1) * sizeof *q->error);
  return kz_label_and_search(&labeller, &search, q->n, NULL, q->label);
}

void kz_question_free(kz_question *q) {
  free(q->label);
  free(q->error);
}

static void where_describe(const kz_label *d, double error, const kz_catalogue *catalogue, kz_ending *ending) {
  if (d->label <= 0) return;
  ending->end = *d;
  ending->end.label = (int16_t)catalogue->id_of[d->label];
  ending->end.other = -1;
  kz_entry *entry = &ending->entry;
  *entry = catalogue->entries[ending->end.label];
  const size_t bytes = (size_t)entry->row.period * sizeof(double);
  entry->theta = memcpy(kz_malloc(bytes + 1), entry->theta, bytes);
  entry->velocity = memcpy(kz_malloc(bytes + 1), entry->velocity, bytes);
  if (kz_evidence_word(d->evidence) && (entry->row.period > 0 || kz_is_running(&entry->row))) ending->error = error;
  if (d->other > 0) ending->end.other = (int16_t)catalogue->id_of[d->other];
  if (ending->end.other < 0) return;
  memcpy(ending->other_name, catalogue->entries[ending->end.other].name, sizeof ending->other_name);
}

kz_status kz_question_answer(const kz_question *q, const kz_catalogue *catalogue, kz_ending *endings) {
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)q->n * sizeof *state + 1);
  KZ_AUTOFREE int64_t *periods = kz_malloc((size_t)q->n * sizeof *periods + 1);
  for (int64_t i = 0; i < q->n; i++) where_describe(q->label + i, q->error[i], catalogue, endings + i);
  const kz_labeller labeller = labeller_of(q);
  KZ_TRY(kz_item_states(&labeller, q->n, NULL, state, periods));
  kz_endings_approach(q, state, periods, endings);
  return KZ_OK;
}

void kz_endings_clear(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) endings[i] = (kz_ending){{.label = -1, .other = -1}, .near_time = -1, .error = NAN};
}

void kz_where_free(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) {
    free(endings[i].entry.theta);
    free(endings[i].entry.velocity);
  }
}

typedef struct {
  kz_question question;
  int64_t *reached; /* [numbers from 1] starts that end on each attractor */
} where_job;

/* The attractors that the window's starts end on; label [search->starts]. */
static kz_status find_attractors(kz_question *q, kz_search *search, int32_t *label) {
  const kz_scene *scene = q->scene;
  const kz_window motions =
      scene->has_basin ? kz_motions_window(&scene->basin->theta, &scene->basin->velocity) : search->window;
  q->max_periods = search->max_periods;
  q->dynamics = kz_search_dynamics(scene);
  if (scene->has_basin) kz_studies_begin(scene, &scene->parameters.pendulum, NULL, q->dynamics);
  search->max_velocity = kz_dynamics_max_velocity(q->dynamics, &motions);
  search->cells = q->n; /* the window's cells are not labelled */
  return kz_search_window(NULL, q->dynamics, search, label);
}

static kz_status where_answer(where_job *a, kz_ending *endings) {
  kz_question *q = &a->question;
  kz_search search = kz_search_of(q->scene);
  KZ_AUTOFREE_BY(kz_catalogue_free) kz_catalogue catalogue = {0};
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)search.starts * sizeof *label);
  KZ_TRY(find_attractors(q, &search, label));
  KZ_TRY(kz_question_label(q));
  a->reached = kz_calloc((size_t)kz_dynamics_count(q->dynamics) + 1, sizeof *a->reached);
  for (int64_t i = 0; i < search.starts; i++) a->reached[label[i]]++;
  for (int64_t i = 0; i < q->n; i++) {
    a->reached[q->label[i].label]++;
    a->reached[q->label[i].other]++;
  }
  kz_catalogue_make(q->dynamics, a->reached, &catalogue);
  return kz_question_answer(q, &catalogue, endings);
}

/* Starts as kz_where takes them, with results; job->question.label has their labels. To be closed in any case. */
static kz_status where_label(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], where_job *job,
                             kz_ending *endings) {
  *job = (where_job){.question = {.scene = scene, .n = n, .start = start}};
  kz_endings_clear(n, endings);
  if (!scene->has_basin && !scene->has_attractors)
    return kz_fail(KZ_REFUSED, "scene: has no window to search for attractors; add a basin or attractors study to it");
  if (n == 0 || scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  return where_answer(job, endings);
}

static void where_close(where_job *a) {
  kz_dynamics_free(a->question.dynamics);
  kz_question_free(&a->question);
  free(a->reached);
}

kz_status kz_where(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], kz_ending *endings) {
  KZ_AUTOFREE_BY(where_close) where_job a;
  return where_label(scene, n, start, &a, endings);
}

static kz_status where_bisect(const where_job *a, int64_t digits, const kz_ending *endings, kz_boundary_point *point) {
  const kz_question *q = &a->question;
  kz_bisection bisection;
  if (endings[0].end.label == endings[1].end.label)
    return kz_fail(KZ_REFUSED, "--boundary: both starts end on %s; give two that end on different attractors",
                   endings[0].end.label < 0 ? "no known attractor" : endings[0].entry.name);
  KZ_TRY(kz_bisect(q, digits, &bisection));
  memcpy(point->theta, bisection.theta, sizeof point->theta);
  memcpy(point->velocity, bisection.velocity, sizeof point->velocity);
  KZ_AUTOFREE_BY(kz_catalogue_free) kz_catalogue catalogue;
  kz_catalogue_make(q->dynamics, a->reached, &catalogue);
  for (int side = 0; side < 2; side++) {
    const int32_t id = bisection.label[side] > 0 ? catalogue.id_of[bisection.label[side]] : -1;
    point->attractor[side] = id;
    if (id >= 0) memcpy(point->name[side], catalogue.entries[id].name, sizeof point->name[side]);
  }
  return KZ_OK;
}

kz_status kz_where_boundary(const kz_scene *scene, const kz_coordinate (*start)[2], int64_t digits,
                            kz_boundary_point *point) {
  KZ_AUTOFREE_BY(where_close) where_job a = {.reached = NULL};
  kz_ending endings[2];
  *point = (kz_boundary_point){.attractor = {-1, -1}};
  kz_status status = where_label(scene, 2, start, &a, endings);
  if (status == KZ_OK) status = where_bisect(&a, digits, endings, point);
  kz_where_free(2, endings);
  return status;
}
