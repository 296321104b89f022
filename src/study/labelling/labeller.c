#include "labeller.h"

#include "numerics/cells.h"

enum {
  BATCH = 16384, /* starts that are followed together */
  FEW = 24       /* are followed in quad precision for less than the tables of the pairs of doubles take */
};

/* A kz_start_fn: the items are cells of a plan. */
static kz_status start_of_cell(void *context, int64_t item, int32_t level, kz_start *start) {
  double centre[2];
  (void)level;
  kz_cell_start(context, item, centre);
  *start = kz_start_at(centre[0], centre[1]);
  return KZ_OK;
}

kz_labeller kz_cell_labeller(const kz_basin_plan *plan, kz_dynamics *dynamics) {
  return (kz_labeller){dynamics, plan->max_periods, .start = start_of_cell, .context = (void *)plan};
}

/* A kz_start_fn: the items are places in an array of angles and velocities. */
static kz_status start_of_pair(void *context, int64_t item, int32_t level, kz_start *start) {
  const double *pair = (const double *)context + 2 * item;
  (void)level;
  *start = kz_start_at(pair[0], pair[1]);
  return KZ_OK;
}

static int64_t item_at(const int64_t *item, int64_t i) {
  return item ? item[i] : i;
}

static kz_status decide_each(const kz_labeller *l, int64_t n, const int64_t *item, kz_decision *decision) {
  for (int64_t i = 0; i < n; i++) KZ_TRY(l->decide(l->context, item_at(item, i), decision + i));
  return KZ_OK;
}

static kz_status label_batch(const kz_labeller *l, int32_t level, int32_t before, int64_t n, const int64_t *item, int64_t first,
                             kz_start *start, kz_decision *decision) {
  for (int64_t i = 0; i < n; i++) KZ_TRY(l->start(l->context, item_at(item, first + i), level, start + i));
  kz_dynamics_release(l->dynamics, level, n, start);
  kz_dynamics_label(l->dynamics, level, before, n, start, l->max_periods, decision);
  return KZ_OK;
}

kz_status kz_label_at(const kz_labeller *l, int32_t level, int32_t before, int64_t n, const int64_t *item,
                      kz_decision *decision) {
  if (level == KZ_LEVEL_ARBITRARY) return decide_each(l, n, item, decision);
  KZ_FREED kz_start *start = kz_malloc((size_t)(n < BATCH ? n : BATCH) * sizeof *start + 1);
  kz_status status = KZ_OK;
  for (int64_t done = 0; done < n && status == KZ_OK; done += BATCH)
    status = label_batch(l, level, before, n - done < BATCH ? n - done : BATCH, item, done, start, decision + done);
  return status;
}

kz_status kz_label_states(const kz_labeller *l, int32_t stepping, int64_t n, const int64_t *item, int32_t *label,
                          int64_t *periods) {
  const int64_t most = n < BATCH ? n : BATCH;
  KZ_FREED double *state = kz_malloc(2 * (size_t)most * sizeof *state + 1);
  kz_status status = KZ_OK;
  for (int64_t done = 0; done < n && status == KZ_OK; done += BATCH) {
    const int64_t part = n - done < BATCH ? n - done : BATCH;
    kz_start start;
    for (int64_t i = 0; i < part && status == KZ_OK; i++) {
      status = l->start(l->context, item_at(item, done + i), KZ_LEVEL_DOUBLE, &start);
      kz_start_state(start.theta[0], start.velocity[0], state + 2 * i);
    }
    if (status == KZ_OK) kz_dynamics_follow(l->dynamics, stepping, part, l->max_periods, state, label + done, periods + done);
  }
  return status;
}

int32_t kz_level_after(const kz_labeller *l, int32_t level, int64_t pending) {
  if (pending == 0 || level >= KZ_LEVEL_ARBITRARY) return KZ_LEVELS;
  if (level == KZ_LEVEL_QUAD) return l->decide ? KZ_LEVEL_ARBITRARY : KZ_LEVELS;
  return level >= KZ_LEVEL_FINE && pending <= FEW ? KZ_LEVEL_QUAD : level + 1;
}

/* Those that are pending move to the front: how many there are. */
static int64_t take(int32_t level, int64_t n, int64_t *place, const kz_decision *found, kz_decision *decision) {
  int64_t pending = 0;
  for (int64_t i = 0; i < n; i++) {
    const bool is_pending = found[i].label == KZ_DOUBTFUL;
    decision[place[i]] = found[i];
    decision[place[i]].level = is_pending ? KZ_LEVELS : level;
    if (is_pending) place[pending++] = place[i];
  }
  return pending;
}

/* place [n]: of the pending items; others [2 n]: buffer for their numbers. */
static kz_status escalate(const kz_labeller *l, int64_t n, const int64_t *item, int64_t *place, int64_t *pending_item,
                          kz_decision *found, kz_decision *decision) {
  int64_t pending = n;
  int32_t before = KZ_LEVEL_DOUBLE, next;
  for (int32_t level = KZ_LEVEL_DOUBLE; level < KZ_LEVELS; before = level, level = next) {
    for (int64_t i = 0; i < pending; i++) pending_item[i] = item_at(item, place[i]);
    KZ_TRY(kz_label_at(l, level, before, pending, pending_item, found));
    pending = take(level, pending, place, found, decision);
    next = kz_level_after(l, level, pending);
  }
  return KZ_OK;
}

kz_status kz_label(const kz_labeller *l, int64_t n, const int64_t *item, kz_decision *decision) {
  KZ_FREED int64_t *place = kz_malloc(2 * (size_t)n * sizeof *place + 1);
  KZ_FREED kz_decision *found = kz_malloc((size_t)n * sizeof *found + 1);
  for (int64_t i = 0; i < n; i++) place[i] = i;
  return escalate(l, n, item, place, place + n, found, decision);
}

/* Starts of an array cannot fail. */
void kz_follow_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods) {
  const kz_labeller labeller = {dynamics, max_periods, .start = start_of_pair, .context = (void *)start};
  (void)kz_label_states(&labeller, KZ_FOLLOW_DIRECT, n, NULL, end, periods);
}

void kz_decide_starts(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *end,
                      int64_t *periods) {
  const kz_labeller labeller = {dynamics, max_periods, .start = start_of_pair, .context = (void *)start};
  KZ_FREED kz_decision *decision = kz_malloc((size_t)n * sizeof *decision + 1);
  (void)kz_label(&labeller, n, NULL, decision);
  for (int64_t i = 0; i < n; i++) {
    end[i] = decision[i].label;
    periods[i] = decision[i].periods;
    if (end[i] == KZ_DOUBTFUL) kz_follow_starts(dynamics, max_periods, 1, start + 2 * i, end + i, periods + i);
  }
}

void kz_released_states(kz_dynamics *dynamics, int64_t n, kz_start *start, double *state) {
  kz_dynamics_release(dynamics, KZ_LEVEL_DOUBLE, n, start);
  for (int64_t i = 0; i < n; i++) kz_start_state(start[i].theta[0], start[i].velocity[0], state + 2 * i);
}
