#include "labeller.h"

#include "search.h"

enum {
  BATCH = 16384, /* items that are followed together */
  FEW = 24       /* are followed in quad precision for less than the tables of the pairs of doubles take */
};

/* A kz_start_fn: the items are places in an array of angles and velocities. */
static kz_status start_of_pair(void *context, int64_t item, kz_precision level, kz_start *start) {
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

/* The starts of n items for a level, released. */
static kz_status starts_of(const kz_labeller *l, kz_precision level, int64_t n, const int64_t *item, int64_t first,
                           kz_start *start) {
  for (int64_t i = 0; i < n; i++) KZ_TRY(l->start(l->context, item_at(item, first + i), level, start + i));
  if (!l->at_strobe) kz_dynamics_begin(l->dynamics, level, n, start);
  return KZ_OK;
}

kz_status kz_item_states(const kz_labeller *l, int64_t n, const int64_t *item, double *state, int64_t *periods) {
  KZ_AUTOFREE kz_start *start = kz_malloc((size_t)n * sizeof *start + 1);
  KZ_TRY(starts_of(l, KZ_LEVEL_DOUBLE, n, item, 0, start));
  kz_states_of(n, start, state);
  for (int64_t i = 0; periods && i < n; i++) periods[i] = start[i].periods;
  return KZ_OK;
}

/* The labelling of the remaining items: a dynamics level, an added one, the rule for undecided ones, or none. */
typedef struct {
  enum { LEVEL, ADDED, UNDECIDED, NOTHING } kind;
  int32_t row; /* row of the table of levels */
} decider;

static decider first_decider(const kz_labeller *l) {
  return (decider){l->way == KZ_BY_ADDED ? ADDED : LEVEL, 0};
}

/* Chooses the step for `pending` items. A few items go to quad precision at once, because they take less time there
 * than the tables of the pairs of doubles. */
static decider next_decider(const kz_labeller *l, decider by, int64_t pending) {
  const int32_t row = by.kind == ADDED ? by.row + 1 : 0;
  if (pending == 0 || by.kind == UNDECIDED || l->way == KZ_BY_STATES || l->way == KZ_BY_MARKS)
    return (decider){NOTHING, 0};
  if (by.kind == LEVEL && by.row < KZ_LEVEL_QUAD)
    return (decider){LEVEL, by.row >= KZ_LEVEL_FINE && pending <= FEW ? KZ_LEVEL_QUAD : by.row + 1};
  if (l->added && row < l->added->n) return (decider){ADDED, row};
  return (decider){l->open == KZ_OPEN_DOUBTFUL ? NOTHING : UNDECIDED, 0};
}

static const kz_level *row_of(const kz_labeller *l, decider by) {
  static const kz_level undecided = {NULL, "candidates", KZ_UNDECIDED, 64, 0, false};
  return by.kind == LEVEL ? kz_level_rows + by.row : by.kind == ADDED ? l->added->rows + by.row : &undecided;
}

/* Whether it may decide a doubtful item with this label. */
static bool may_decide(const kz_labeller *l, decider by, const kz_label *label) {
  const int32_t below = by.kind == ADDED && l->way != KZ_BY_ADDED ? KZ_LEVELS : 0;
  return by.kind == UNDECIDED || label->next <= below + by.row;
}

static uint8_t evidence_of(const kz_labeller *l, decider by, const kz_decision *decision) {
  kz_attractor attractor = {.averaged = 0};
  if (decision->end.label > 0 && l->dynamics) kz_dynamics_attractor(l->dynamics, decision->end.label, &attractor);
  if (attractor.averaged) return KZ_AVERAGED;
  return l->way == KZ_BY_MARKS && !decision->decided ? KZ_LEFT : row_of(l, by)->evidence;
}

/* Labels n items that wait in a stage. */
typedef struct {
  const kz_labeller *labeller;
  decider by;
  kz_precision before; /* the level at which they were doubtful */
  const int64_t *item; /* NULL: 0, 1, ... */
} batch;

/* Labels items by their states alone. */
static kz_status follow_states(const batch *b, int64_t first, int64_t n, kz_start *start, kz_decision *decision) {
  const kz_labeller *l = b->labeller;
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)n * sizeof *state);
  if (!l->state) KZ_TRY(starts_of(l, KZ_LEVEL_DOUBLE, n, b->item, first, start));
  if (!l->state) kz_states_of(n, start, state);
  for (int64_t i = 0; l->state && i < n; i++)
    memcpy(state + 2 * i, l->state + 2 * item_at(b->item, first + i), 2 * sizeof *state);
  kz_decide_by_states(l->dynamics, l->stepper, l->max_periods, n, l->state ? NULL : start, state, decision);
  return KZ_OK;
}

/* Decisions of the items first .. first + n - 1. `start` [n]: a buffer. */
static kz_status labeller_decide(const batch *b, int64_t first, int64_t n, kz_start *start, kz_decision *decision) {
  const kz_labeller *l = b->labeller;
  if (l->way == KZ_BY_STATES) return follow_states(b, first, n, start, decision);
  if (b->by.kind == ADDED) return l->added->label(l->context, b->by.row, n, b->item + first, decision);
  const kz_precision level = b->by.kind == LEVEL ? (kz_precision)b->by.row : kz_candidates_level(l->open);
  const kz_label_precision precision = {.level = level, .before = b->before, .guess = l->way == KZ_BY_MARKS};
  KZ_TRY(starts_of(l, level, n, b->item, first, start));
  if (b->by.kind == UNDECIDED)
    kz_candidates_find(l->dynamics, l->max_periods, l->open, n, start, decision);
  else
    kz_dynamics_label(l->dynamics, &precision, n, start, l->max_periods, decision);
  return KZ_OK;
}

/* Labels items as many at a time as the labeller says, by this process alone. */
static kz_status label_items(const batch *b, int64_t first, int64_t n, kz_label *label) {
  const kz_labeller *l = b->labeller;
  const int64_t most = kz_smaller(n, l->tile > 0 ? kz_smaller(l->tile, BATCH) : BATCH);
  KZ_AUTOFREE kz_start *start = kz_malloc((size_t)most * sizeof *start + 1);
  KZ_AUTOFREE kz_decision *decision = kz_malloc((size_t)most * sizeof *decision + 1);
  for (int64_t done = 0; done < n; done += most) {
    const int64_t part = kz_smaller(n - done, most);
    if (l->run) KZ_TRY(kz_ranks_interrupted(l->run->ranks));
    KZ_TRY(labeller_decide(b, first + done, part, start, decision));
    if (l->turns) kz_dynamics_count_turns(l->dynamics, part, l->max_periods, decision);
    for (int64_t i = 0; i < part; i++) {
      label[done + i] = decision[i].end;
      label[done + i].evidence = evidence_of(l, b->by, decision + i);
      if (l->note) l->note(l->context, item_at(b->item, first + done + i), decision + i);
    }
  }
  return KZ_OK;
}

static kz_status label_tile(void *context, int64_t first, int64_t n, void *record) {
  return label_items(context, first, n, record);
}

/* The stage in which ranks label n items. */
static kz_stage stage_of(batch *b, int round, int64_t n, char name[32]) {
  const kz_labeller *l = b->labeller;
  const kz_level *row = row_of(l, b->by);
  const decider first = first_decider(l);
  const int64_t tile = l->tile > 0 ? kz_smaller(l->tile, row->tile) : row->tile;
  snprintf(name, 32, "%s %d", row->stage, round);
  if (l->stage && b->by.kind == first.kind && b->by.row == first.row) snprintf(name, 32, "%s", l->stage);
  return kz_stage_of_items(name, n, tile, (size_t)tile * sizeof(kz_label), label_tile, b);
}

/* Labels n items from a decider on, until each is decided or none is left; label [n].next: the first level that may
 * decide each. The places of items that are still doubtful move to the front. */
static kz_status labeller_climb(const kz_labeller *l, decider by, int round, int64_t n, const int64_t *item,
                                kz_label *label) {
  KZ_AUTOFREE int64_t *place = kz_malloc(2 * (size_t)n * sizeof *place + 1);
  int64_t *now = place + n;
  KZ_AUTOFREE kz_label *found = NULL;
  batch b = {.labeller = l, .by = by, .before = KZ_LEVEL_DOUBLE, .item = now};
  char name[32];
  for (int64_t i = 0; i < n; i++) place[i] = i;
  for (; n > 0 && b.by.kind != NOTHING; b.by = next_decider(l, b.by, n)) {
    int64_t n_now = 0, left = 0, taken = 0;
    for (int64_t i = 0; i < n; i++)
      if (may_decide(l, b.by, label + place[i])) now[n_now++] = item_at(item, place[i]);
    if (n_now == 0) continue;
    if (l->run) {
      const kz_stage stage = stage_of(&b, round, n_now, name);
      found = kz_realloc(found, (size_t)stage.n_tiles * stage.record_bytes + 1);
      KZ_TRY(kz_stage_run(l->run, &stage, found));
    } else {
      found = kz_realloc(found, (size_t)n_now * sizeof *found);
      KZ_TRY(label_items(&b, 0, n_now, found));
    }
    for (int64_t i = 0; i < n; i++) {
      kz_label *own = label + place[i];
      if (may_decide(l, b.by, own)) *own = found[taken++];
      if (own->label == KZ_DOUBTFUL) place[left++] = place[i];
    }
    n = left;
    if (b.by.kind == LEVEL) b.before = (kz_precision)b.by.row;
  }
  return KZ_OK;
}

kz_status kz_label_first(const kz_labeller *l, int64_t n, const int64_t *item, kz_label *label) {
  const batch b = {.labeller = l, .by = first_decider(l), .before = KZ_LEVEL_DOUBLE, .item = item};
  return label_items(&b, 0, n, label);
}

kz_status kz_label_doubtful(const kz_labeller *l, int round, int64_t n, const int64_t *item, kz_label *label) {
  return labeller_climb(l, next_decider(l, first_decider(l), n), round, n, item, label);
}

kz_status kz_label_items(const kz_labeller *l, int round, int64_t n, const int64_t *item, kz_label *label) {
  for (int64_t i = 0; i < n; i++) label[i].next = 0;
  return labeller_climb(l, first_decider(l), round, n, item, label);
}
