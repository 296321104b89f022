#include "question.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "labelling/labeller.h"
#include "numerics/cells.h"

static kz_status label(kz_question *q, kz_start *asked) {
  const kz_labeller labeller = {
      .dynamics = q->dynamics, .max_periods = q->max_periods, .start = kz_start_of_array, .context = asked};
  for (int64_t i = 0; i < q->n; i++) {
    asked[i] = kz_start_at(q->start[2 * i], q->start[2 * i + 1]);
    if (q->low) asked[i].theta[1] = q->low[2 * i], asked[i].velocity[1] = q->low[2 * i + 1];
  }
  KZ_TRY(kz_label(&labeller, q->n, NULL, q->decision));
  for (int64_t i = 0; i < q->n; i++)
    if (q->decision[i].label == KZ_DOUBTFUL) KZ_TRY(kz_label_candidates(&labeller, 1, &i, q->decision + i));
  return KZ_OK;
}

kz_status kz_question_decide(kz_question *q) {
  kz_start *asked = kz_malloc(((size_t)q->n + 1) * sizeof *asked);
  q->decision = kz_malloc(((size_t)q->n + 1) * sizeof *q->decision);
  const kz_status status = label(q, asked);
  free(asked);
  return status;
}

void kz_question_free(kz_question *q) {
  free(q->decision);
}

/* Names of the levels of precision. */
static const char *const precision_names[] = {
    [KZ_LEVEL_DOUBLE] = "double",
    [KZ_LEVEL_FINE] = "double",
    [KZ_LEVEL_PAIRS_20] = "pairs",
    [KZ_LEVEL_PAIRS_28] = "pairs",
    [KZ_LEVEL_QUAD] = "quad",
    [KZ_LEVEL_ARBITRARY] = "arbitrary",
    [KZ_LEVELS] = NULL,
};

static void describe_orbit(const kz_entry *entry, kz_ending *ending) {
  const size_t bytes = (size_t)entry->row.period * sizeof(double);
  memcpy(ending->name, entry->name, sizeof ending->name);
  ending->period = entry->row.period;
  ending->winding = entry->row.winding;
  ending->strobe_theta = kz_malloc(bytes + 1);
  ending->strobe_velocity = kz_malloc(bytes + 1);
  memcpy(ending->strobe_theta, entry->theta, bytes);
  memcpy(ending->strobe_velocity, entry->velocity, bytes);
}

static void describe_start(const kz_question *q, const kz_catalogue *catalogue, int64_t i, kz_ending *ending) {
  const kz_decision *d = q->decision + i;
  if (d->label <= 0) return;
  ending->attractor = catalogue->id_of[d->label];
  ending->settling_time = d->periods;
  ending->precision = precision_names[d->level];
  describe_orbit(catalogue->entries + ending->attractor, ending);
  if (ending->precision && ending->period > 0) ending->error = d->error;
  if (d->other <= 0) return;
  ending->other = catalogue->id_of[d->other];
  memcpy(ending->other_name, catalogue->entries[ending->other].name, sizeof ending->other_name);
}

void kz_question_answer(const kz_question *q, const kz_catalogue *catalogue, kz_ending *endings) {
  for (int64_t i = 0; i < q->n; i++) describe_start(q, catalogue, i, endings + i);
}

void kz_endings_clear(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) endings[i] = (kz_ending){.attractor = -1, .error = NAN, .other = -1};
}

void kz_where_free(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) {
    free(endings[i].strobe_theta);
    free(endings[i].strobe_velocity);
  }
}
