/* Where starts end: the catalogue of the scene's window, then every start in as much precision as it takes. One rank alone. */
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "labelling/search.h"
#include "where.h"
#include "basin/plan.h"

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
  if (scene->has_basin) kz_dynamics_set_release(q->dynamics, &scene->parameters.release);
  search->max_velocity = kz_dynamics_max_velocity(q->dynamics, &motions);
  search->cells = q->n; /* the window's cells are not labelled */
  return kz_search_window(NULL, q->dynamics, search, label);
}

static kz_status answer(where_job *a, kz_ending *endings) {
  kz_question *q = &a->question;
  kz_search search = kz_search_of(q->scene);
  KZ_FREED_BY(kz_catalogue_free) kz_catalogue catalogue = {0};
  KZ_FREED int32_t *label = kz_malloc((size_t)search.starts * sizeof *label);
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

/* The starts as kz_where takes them, with their endings; job->question.label is what they say. To be closed in every case. */
static kz_status where_label(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], where_job *job,
                             kz_ending *endings) {
  *job = (where_job){.question = {.scene = scene, .n = n, .start = start}};
  kz_endings_clear(n, endings);
  if (!scene->has_basin && !scene->has_attractors)
    return kz_fail(KZ_REFUSED, "scene: has no window to search for attractors; add a basin or attractors study to it");
  if (n == 0 || scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  return answer(job, endings);
}

static void where_close(where_job *a) {
  kz_dynamics_free(a->question.dynamics);
  kz_question_free(&a->question);
  free(a->reached);
}

kz_status kz_where(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], kz_ending *endings) {
  KZ_FREED_BY(where_close) where_job a;
  return where_label(scene, n, start, &a, endings);
}

static kz_status where_bisect(const where_job *a, int64_t digits, const kz_ending *endings, kz_boundary_point *point) {
  const kz_question *q = &a->question;
  kz_bisection bisection;
  if (endings[0].attractor == endings[1].attractor)
    return kz_fail(KZ_REFUSED, "--boundary: both starts end on %s; give two that end on different attractors",
                   endings[0].attractor < 0 ? "no known attractor" : endings[0].name);
  KZ_TRY(kz_bisect(q, digits, &bisection));
  memcpy(point->theta, bisection.theta, sizeof point->theta);
  memcpy(point->velocity, bisection.velocity, sizeof point->velocity);
  KZ_FREED_BY(kz_catalogue_free) kz_catalogue catalogue;
  kz_catalogue_make(q->dynamics, a->reached, &catalogue);
  for (int side = 0; side < 2; side++) {
    const int32_t id = bisection.label[side] > 0 ? catalogue.id_of[bisection.label[side]] : -1;
    point->attractor[side] = id;
    if (id >= 0) memcpy(point->name[side], catalogue.entries[id].name, sizeof point->name[side]);
  }
  return KZ_OK;
}

kz_status kz_where_boundary(const kz_scene *scene, const kz_coordinate (*start)[2], int64_t digits, kz_boundary_point *point) {
  KZ_FREED_BY(where_close) where_job a = {.reached = NULL};
  kz_ending endings[2];
  *point = (kz_boundary_point){.attractor = {-1, -1}};
  kz_status status = where_label(scene, 2, start, &a, endings);
  if (status == KZ_OK) status = where_bisect(&a, digits, endings, point);
  kz_where_free(2, endings);
  return status;
}
