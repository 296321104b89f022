#include "labeller.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "search.h"

enum {
  BATCH = 16384, /* items that are followed together */
  FEW = 24       /* are followed in quad precision for less than the tables of the pairs of doubles take */
};

/* A kz_start_fn: the items are places in an array of angles and velocities. */
static kz_status start_of_pair(void *context, int64_t item, int32_t level, kz_start *start) {
  const double *pair = (const double *)context + 2 * item;
  (void)level;
  *start = kz_start_at(pair[0], pair[1]);
  return KZ_OK;
}

kz_labeller kz_pair_labeller(const double *start, int64_t max_periods, kz_way way, kz_dynamics *dynamics) {
  return (kz_labeller){dynamics, max_periods, way, KZ_OPEN_BY_STATES, true, start_of_pair, .context = (void *)start};
}

static int64_t item_at(const int64_t *item, int64_t i) {
  return item ? item[i] : i;
}

static int64_t smaller(int64_t a, int64_t b) {
  return a < b ? a : b;
}

/* The starts of n <= BATCH items for a level, released. */
static kz_status starts_of(const kz_labeller *l, int32_t level, int64_t n, const int64_t *item, int64_t first,
                           kz_start *start) {
  const int32_t own = level < 0 ? KZ_LEVEL_DOUBLE : level;
  for (int64_t i = 0; i < n; i++) KZ_TRY(l->start(l->context, item_at(item, first + i), own, start + i));
  if (!l->at_strobe) kz_dynamics_begin(l->dynamics, level, n, start);
  return KZ_OK;
}

kz_status kz_item_states(const kz_labeller *l, int64_t n, const int64_t *item, double *state, int64_t *periods) {
  KZ_FREED kz_start *start = kz_malloc((size_t)smaller(n, BATCH) * sizeof *start + 1);
  for (int64_t done = 0; done < n; done += BATCH) {
    const int64_t part = smaller(n - done, BATCH);
    KZ_TRY(starts_of(l, KZ_LEVEL_DOUBLE, part, item, done, start));
    kz_states_of(part, start, state + 2 * done);
    for (int64_t i = 0; periods && i < part; i++) periods[done + i] = start[i].periods;
  }
  return KZ_OK;
}

/* Some items that are labelled together, with buffers. */
typedef struct {
  int64_t n, first;
  const int64_t *item;
  kz_start *start;
  kz_decision *decision;
} batch;

/* By the states alone. */
static kz_status follow_states(const kz_labeller *l, const batch *b) {
  KZ_FREED double *state = kz_malloc(2 * (size_t)b->n * sizeof *state);
  KZ_FREED int32_t *label = kz_malloc((size_t)b->n * sizeof *label);
  KZ_FREED int64_t *periods = kz_malloc((size_t)b->n * sizeof *periods);
  KZ_FREED int64_t *turns = kz_malloc((size_t)b->n * sizeof *turns);
  KZ_TRY(starts_of(l, KZ_LEVEL_DOUBLE, b->n, b->item, b->first, b->start));
  kz_states_of(b->n, b->start, state);
  kz_dynamics_follow(l->dynamics, l->stepper, b->n, l->max_periods, state, label, periods, turns);
  for (int64_t i = 0; i < b->n; i++)
    b->decision[i] = kz_decision_by_state(b->start + i, label[i], periods[i], state + 2 * i, turns[i]);
  return KZ_OK;
}

static kz_status decide_batch(const kz_labeller *l, int32_t level, int32_t before, const batch *b) {
  if (l->way == KZ_BY_STATES) return follow_states(l, b);
  if (level == KZ_LEVEL_ARBITRARY) {
    for (int64_t i = 0; i < b->n; i++) KZ_TRY(l->decide(l->context, item_at(b->item, b->first + i), b->decision + i));
    return KZ_OK;
  }
  KZ_TRY(starts_of(l, level < KZ_LEVELS ? level : kz_candidates_level(l->open), b->n, b->item, b->first, b->start));
  if (level == KZ_LEVELS)
    kz_candidates_find(l->dynamics, l->max_periods, l->open, b->n, b->start, b->decision);
  else
    kz_dynamics_label(l->dynamics, level, before, b->n, b->start, l->max_periods, b->decision);
  return KZ_OK;
}

static uint8_t evidence_of(const kz_labeller *l, int32_t level, const kz_decision *decision) {
  if (decision->end.label > 0 && kz_dynamics_is_averaged(l->dynamics, decision->end.label)) return KZ_AVERAGED;
  if (l->way == KZ_BY_MARKS && decision->level == KZ_LEVELS) return KZ_LEFT;
  return kz_level_rows[level < 0 ? KZ_LEVEL_DOUBLE : level].evidence;
}

static kz_status label_batch(const kz_labeller *l, int32_t level, int32_t before, const batch *b, kz_label *label) {
  KZ_TRY(decide_batch(l, level, before, b));
  if (l->turns) kz_dynamics_count_turns(l->dynamics, b->n, l->max_periods, b->decision);
  for (int64_t i = 0; i < b->n; i++) {
    const kz_decision *d = b->decision + i;
    label[i] = d->end;
    label[i].evidence = evidence_of(l, level, d);
    if (l->note) l->note(l->context, item_at(b->item, b->first + i), d);
  }
  return KZ_OK;
}

/* One level for n items, KZ_LEVELS: in the way `open`; `before` is the level at which they were doubtful. Not collective. */
static kz_status label_at(const kz_labeller *l, int32_t level, int32_t before, int64_t n, const int64_t *item,
                          kz_label *label) {
  const int64_t most = l->tile > 0 ? smaller(l->tile, BATCH) : BATCH;
  if (l->run) KZ_TRY(kz_ranks_interrupted(l->run->ranks));
  if (l->at) return l->at(l->context, level, n, item, label);
  KZ_FREED kz_start *start = kz_malloc((size_t)smaller(n, most) * sizeof *start + 1);
  KZ_FREED kz_decision *decision = kz_malloc((size_t)smaller(n, most) * sizeof *decision + 1);
  kz_status status = KZ_OK;
  for (int64_t done = 0; done < n && status == KZ_OK; done += most) {
    const batch b = {smaller(n - done, most), done, item, start, decision};
    if (l->run) status = kz_ranks_interrupted(l->run->ranks);
    if (status == KZ_OK) status = label_batch(l, level, before, &b, label + done);
  }
  return status;
}

/* The level that follows if `pending` items are left; KZ_LEVELS + 1 = none. A few items go to quad precision at once, because they take less
 * time there than the tables of the pairs of doubles. */
static int32_t level_after(const kz_labeller *l, int32_t level, int64_t pending) {
  if (l->at) return pending > 0 && level + 1 < l->n_levels ? level + 1 : KZ_LEVELS + 1;
  const int32_t last = l->open == KZ_OPEN_DOUBTFUL ? KZ_LEVELS + 1 : KZ_LEVELS;
  if (pending == 0 || level == KZ_LEVELS || l->way != KZ_BY_LEVELS) return KZ_LEVELS + 1;
  if (level == KZ_LEVEL_QUAD) return l->decide ? KZ_LEVEL_ARBITRARY : last;
  if (level == KZ_LEVEL_ARBITRARY) return last;
  return level >= KZ_LEVEL_FINE && pending <= FEW ? KZ_LEVEL_QUAD : level + 1;
}

/* Items that a level labels, in a stage. */
typedef struct {
  const kz_labeller *labeller;
  int32_t level, before;    /* the level; that at which they were doubtful */
  int64_t tile;             /* items of a tile */
  int64_t n, *item, *place; /* that are left */
  int64_t n_now, *now;      /* those that this level may decide */
} level_job;

static kz_status label_some(void *context, int64_t first, int64_t n, void *record) {
  const level_job *a = context;
  return label_at(a->labeller, a->level, a->before, n, a->now + first, record);
}

static const kz_level *row_of(const level_job *a) {
  if (a->labeller->at) return a->labeller->levels + a->level;
  return kz_level_rows + (a->level < 0 ? KZ_LEVEL_DOUBLE : a->level);
}

/* Alone a process takes all lanes can hold; ranks share smaller tiles. */
static int64_t tile_of(const level_job *a) {
  const kz_labeller *l = a->labeller;
  const int64_t most = l->run ? row_of(a)->tile : BATCH;
  return l->tile > 0 ? smaller(l->tile, most) : most;
}

/* Labels at one level the items that it may decide: label [place] of each. The items that are still doubtful, and their places, move to the
 * front. */
static kz_status label_level(level_job *a, int round, kz_label *label) {
  const kz_labeller *l = a->labeller;
  char name[32];
  snprintf(name, sizeof name, "%s %d", row_of(a)->stage, round);
  a->n_now = 0;
  for (int64_t i = 0; i < a->n; i++)
    if (label[a->place[i]].next <= a->level) a->now[a->n_now++] = a->item[i];
  if (a->n_now == 0) return KZ_OK;
  a->tile = tile_of(a);
  const kz_stage stage = kz_stage_of_items(l->stage && a->level <= KZ_LEVEL_DOUBLE ? l->stage : name, a->n_now, a->tile,
                                           (size_t)a->tile * sizeof(kz_label), label_some, a);
  KZ_FREED kz_label *found = kz_malloc((size_t)stage.n_tiles * stage.record_bytes + 1);
  KZ_TRY(kz_stage_run(l->run, &stage, found));
  int64_t left = 0, now = 0;
  for (int64_t i = 0; i < a->n; i++) {
    kz_label *own = label + a->place[i];
    if (own->next <= a->level) *own = found[now++];
    if (own->label != KZ_DOUBTFUL) continue;
    a->item[left] = a->item[i];
    a->place[left++] = a->place[i];
  }
  a->n = left;
  a->before = a->level;
  return KZ_OK;
}

/* Labels n items from `level` on, until each is decided or no level is left; label [n].next: the first level that may decide each. */
static kz_status climb(const kz_labeller *l, int32_t level, int round, int64_t n, const int64_t *item, kz_label *label) {
  KZ_FREED int64_t *list = kz_malloc(3 * (size_t)n * sizeof *list + 1);
  level_job a = {
      .labeller = l, .level = level, .before = KZ_LEVEL_DOUBLE, .n = n, .item = list, .place = list + n, .now = list + 2 * n};
  for (int64_t i = 0; i < n; i++) {
    a.item[i] = item_at(item, i);
    a.place[i] = i;
  }
  while (a.n > 0 && a.level <= KZ_LEVELS) {
    KZ_TRY(label_level(&a, round, label));
    a.level = level_after(l, a.level, a.n);
  }
  return KZ_OK;
}

static int32_t first_level(const kz_labeller *l) {
  return l->way == KZ_BY_MARKS ? KZ_LEVEL_GUESS : KZ_LEVEL_DOUBLE;
}

kz_status kz_label_first(const kz_labeller *l, int64_t n, const int64_t *item, kz_label *label) {
  return label_at(l, first_level(l), KZ_LEVEL_DOUBLE, n, item, label);
}

kz_status kz_label_doubtful(const kz_labeller *l, int round, int64_t n, const int64_t *item, kz_label *label) {
  return climb(l, level_after(l, KZ_LEVEL_DOUBLE, n), round, n, item, label);
}

kz_status kz_label_items(const kz_labeller *l, int round, int64_t n, const int64_t *item, kz_label *label) {
  for (int64_t i = 0; i < n; i++) label[i].next = 0;
  return climb(l, first_level(l), round, n, item, label);
}
