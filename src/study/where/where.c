/* Where starts end: the catalogue of the scene's window, then every start in as much precision as it takes. One rank alone. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "attractors/search.h"
#include "labelling/starts.h"
#include "question.h"

typedef struct {
  kz_question question;
  kz_search search;
  double *state;    /* [the larger of n and the search's starts][2] */
  int32_t *found;   /* [the same] */
  int64_t *reached; /* [numbers from 1] */
} where_job;

static void where_allocate(where_job *a) {
  kz_question *q = &a->question;
  const int64_t most = q->n > a->search.starts ? q->n : a->search.starts;
  const kz_scene *scene = q->scene;
  q->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics,
                                   scene->has_basin ? scene->basin.max_period : scene->attractors.max_period);
  a->state = kz_malloc(2 * (size_t)most * sizeof *a->state);
  a->found = kz_malloc((size_t)most * sizeof *a->found);
}

/* The attractors that the window's starts, and then those asked for, end on. */
static kz_status where_discover(where_job *a) {
  const kz_question *q = &a->question;
  a->search.max_velocity = kz_dynamics_max_velocity(q->dynamics, &a->search.window);
  KZ_TRY(kz_search_window(NULL, q->dynamics, &a->search, a->state, a->found));
  const int64_t searched = kz_dynamics_count(q->dynamics);
  int64_t *reached = kz_calloc((size_t)searched + 1, sizeof *reached);
  for (int64_t i = 0; i < a->search.starts; i++) reached[a->found[i]]++;
  for (int64_t i = 0; i < q->n; i++) kz_start_state(q->start[2 * i], q->start[2 * i + 1], a->state + 2 * i);
  kz_status status = kz_discover(NULL, q->dynamics, a->search.max_periods, q->n, a->state, a->found);
  const int64_t known = kz_dynamics_count(q->dynamics);
  a->reached = kz_calloc((size_t)known + 1, sizeof *a->reached);
  if (status == KZ_OK) memcpy(a->reached, reached, (size_t)(searched + 1) * sizeof *reached);
  free(reached);
  kz_dynamics_update(q->dynamics);
  return status;
}

static kz_status answer(where_job *a, kz_ending *endings) {
  kz_question *q = &a->question;
  kz_catalogue catalogue;
  KZ_TRY(kz_question_decide(q));
  for (int64_t i = 0; i < q->n; i++) {
    a->reached[q->decision[i].label]++;
    a->reached[q->decision[i].other]++;
  }
  kz_catalogue_make(q->dynamics, a->reached, &catalogue);
  kz_question_answer(q, &catalogue, endings);
  kz_catalogue_free(&catalogue);
  return KZ_OK;
}

kz_status kz_where(const kz_scene *scene, int64_t n, const double *start, const double *low, kz_ending *endings) {
  kz_endings_clear(n, endings);
  if (!scene->has_basin && !scene->has_attractors)
    return kz_fail(KZ_REFUSED, "scene: has no window to search for attractors; add a basin or attractors study to it");
  if (n == 0 || scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  where_job a = {.search = kz_search_of(scene)};
  a.question = (kz_question){.scene = scene, .max_periods = a.search.max_periods, .n = n, .start = start, .low = low};
  where_allocate(&a);
  kz_status status = where_discover(&a);
  if (status == KZ_OK) status = answer(&a, endings);
  if (a.question.dynamics) kz_dynamics_free(a.question.dynamics);
  kz_question_free(&a.question);
  free(a.state);
  free(a.found);
  free(a.reached);
  return status;
}
