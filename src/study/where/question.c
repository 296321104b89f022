#include "where.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "window/window.h"

/* A kz_start_fn: a pair of doubles, and what it leaves out of a longer number. */
static kz_status start_of(void *context, int64_t i, int32_t level, kz_start *start) {
  static const double pair_error = 4e-32;
  const kz_question *q = context;
  const kz_coordinate *theta = &q->start[i][0], *velocity = &q->start[i][1];
  const double error = theta->centre || velocity->centre ? pair_error * hypot(theta->high, velocity->high) : 0;
  (void)level;
  *start = (kz_start){.theta = {theta->high, theta->low},
                      .velocity = {velocity->high, velocity->low},
                      .error = {error * error, 0, error * error}};
  return KZ_OK;
}

/* A kz_decide_fn: of starts with more digits than a pair has. Doubles are labelled as method exact labels the cells of a file. */
static kz_status decide(void *context, int64_t i, kz_decision *decision) {
  const kz_question *q = context;
  *decision = (kz_decision){.label = KZ_DOUBTFUL, .level = KZ_LEVELS, .error = NAN};
  if (!q->start[i][0].centre && !q->start[i][1].centre) return KZ_OK;
  return kz_own_orbit_decide(q->dynamics, &q->scene->parameters, q->start[i], q->max_periods, decision);
}

/* A kz_note_fn. */
static void note(void *context, int64_t i, const kz_decision *decision) {
  ((kz_question *)context)->error[i] = decision->error;
}

static kz_labeller labeller_of(const kz_question *q) {
  return (kz_labeller){.dynamics = q->dynamics,
                       .max_periods = q->max_periods,
                       .way = KZ_BY_LEVELS,
                       .open = KZ_OPEN_CANDIDATES,
                       .start = start_of,
                       .decide = decide,
                       .note = note,
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

static void describe(const kz_label *d, double error, const kz_catalogue *catalogue, kz_ending *ending) {
  if (d->label <= 0) return;
  ending->precision = kz_evidence_word(d->evidence);
  if (catalogue->id_of[d->label] < 0) {
    kz_orbit_name(-1, 0, 0, ending->name);
    return;
  }
  const kz_entry *entry = catalogue->entries + catalogue->id_of[d->label];
  const size_t bytes = (size_t)entry->row.period * sizeof(double);
  ending->attractor = catalogue->id_of[d->label];
  ending->settling_time = d->periods;
  ending->period = entry->row.period;
  ending->winding = entry->row.winding;
  ending->strobe_theta = memcpy(kz_malloc(bytes + 1), entry->theta, bytes);
  ending->strobe_velocity = memcpy(kz_malloc(bytes + 1), entry->velocity, bytes);
  memcpy(ending->name, entry->name, sizeof ending->name);
  if (ending->precision && ending->period > 0) ending->error = error;
  ending->other = d->other > 0 ? catalogue->id_of[d->other] : -1;
  if (ending->other < 0) return;
  memcpy(ending->other_name, catalogue->entries[ending->other].name, sizeof ending->other_name);
}

kz_status kz_question_answer(const kz_question *q, const kz_catalogue *catalogue, kz_ending *endings) {
  KZ_FREED double *state = kz_malloc(2 * (size_t)q->n * sizeof *state + 1);
  KZ_FREED int64_t *periods = kz_malloc((size_t)q->n * sizeof *periods + 1);
  for (int64_t i = 0; i < q->n; i++) describe(q->label + i, q->error[i], catalogue, endings + i);
  const kz_labeller labeller = labeller_of(q);
  KZ_TRY(kz_item_states(&labeller, q->n, NULL, state, periods));
  kz_endings_approach(q, state, periods, catalogue, endings);
  return KZ_OK;
}

void kz_endings_clear(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) endings[i] = (kz_ending){.attractor = -1, .near_time = -1, .error = NAN, .other = -1};
}

void kz_where_free(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) {
    free(endings[i].strobe_theta);
    free(endings[i].strobe_velocity);
  }
}
