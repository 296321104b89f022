/* The ends of starts by what the engine knows, for a click in the explorer. */
#include "where/question.h"

#include <stdlib.h>

#include "engine.h"
#include "labelling/labeller.h"

/* Attractors that only these starts end on join. */
static kz_status where_discover(kz_engine *engine, kz_resident *r, int64_t n, const kz_coordinate (*start)[2]) {
  double *state = kz_malloc(2 * (size_t)n * sizeof *state);
  int32_t *found = kz_malloc((size_t)n * sizeof *found);
  const int64_t known = kz_dynamics_count(r->dynamics);
  for (int64_t i = 0; i < n; i++) {
    kz_start first = kz_start_at(start[i][0].high, start[i][1].high);
    kz_released_states(r->dynamics, 1, &first, state + 2 * i);
  }
  const kz_status status = kz_discover(NULL, r->dynamics, r->search.max_periods, n, state, found);
  free(state);
  free(found);
  if (status != KZ_OK || kz_dynamics_count(r->dynamics) == known) return status;
  kz_dynamics_update(r->dynamics);
  kz_engine_list(engine, r);
  return KZ_OK;
}

kz_status kz_engine_where(kz_engine *engine, const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                          kz_ending *endings) {
  kz_resident *r;
  kz_endings_clear(n, endings);
  KZ_TRY(kz_engine_resident(engine, scene, false, &r));
  if (!r->dynamics || n == 0) return KZ_OK;
  KZ_TRY(where_discover(engine, r, n, start));
  kz_question q = {.scene = &r->scene, .dynamics = r->dynamics, .max_periods = r->search.max_periods, .n = n, .start = start};
  const kz_status status = kz_question_decide(&q);
  if (status == KZ_OK) kz_question_answer(&q, &r->catalogue.list, endings);
  kz_question_free(&q);
  return status;
}
