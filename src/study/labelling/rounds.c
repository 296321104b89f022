/* Rounds of search and labels: items that ended on nothing known lead to further attractors. */
#include "labeller.h"
#include "search.h"

/* Finds the attractors that n items end on, whatever their labels; *found: whether there were new ones. */
static kz_status search_from(const kz_labeller *l, int64_t n, const int64_t *item, int64_t *reached, bool *found) {
  const int64_t known = kz_dynamics_count(l->dynamics);
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)n * sizeof *state + 1);
  KZ_AUTOFREE int32_t *label = kz_malloc((size_t)n * sizeof *label + 1);
  KZ_TRY(kz_item_states(l, n, item, state, NULL));
  KZ_TRY(kz_discover(l->run, l->dynamics, 0, l->max_periods, n, state, label));
  for (int64_t i = 0; reached && i < n; i++) reached[label[i]]++;
  *found = kz_dynamics_count(l->dynamics) > known;
  return KZ_OK;
}

kz_status kz_search_rounds(const kz_labeller *l, const kz_search_on *search, const kz_unsettled *u) {
  for (int round = 1; round <= search->rounds; round++) {
    int64_t all;
    bool found;
    KZ_TRY(u->count(u->labels, &all));
    if (all == 0) return KZ_OK;
    const int64_t n = kz_smaller(all, search->starts);
    KZ_AUTOFREE int64_t *item = kz_malloc((size_t)n * sizeof *item);
    KZ_TRY(u->pick(u->labels, all, n, item));
    KZ_TRY(search_from(l, n, item, search->reached, &found));
    if (!found) return KZ_OK;
    KZ_TRY(u->again(u->labels, round + 1));
  }
  return KZ_OK;
}

/* ---- labels in an array ---- */

typedef struct {
  const kz_labeller *labeller;
  const int64_t *item; /* NULL: 0, 1, ... */
  kz_label *label;
  int64_t n, open, *place; /* [open] places of the unsettled ones */
} array;

static kz_status count_open(void *labels, int64_t *n) {
  array *a = labels;
  a->open = 0;
  for (int64_t i = 0; i < a->n; i++)
    if (a->label[i].label == 0) a->place[a->open++] = i;
  *n = a->open;
  return KZ_OK;
}

static int64_t item_at(const array *a, int64_t place) {
  return a->item ? a->item[place] : place;
}

static kz_status rounds_pick(void *labels, int64_t all, int64_t n, int64_t *item) {
  const array *a = labels;
  for (int64_t i = 0; i < n; i++) item[i] = item_at(a, a->place[kz_even_place(i, n, all)]);
  return KZ_OK;
}

static kz_status label_again(void *labels, int round) {
  const array *a = labels;
  KZ_AUTOFREE int64_t *item = kz_malloc((size_t)a->open * sizeof *item);
  KZ_AUTOFREE kz_label *label = kz_malloc((size_t)a->open * sizeof *label);
  for (int64_t i = 0; i < a->open; i++) item[i] = item_at(a, a->place[i]);
  KZ_TRY(kz_label_items(a->labeller, round, a->open, item, label));
  for (int64_t i = 0; i < a->open; i++) a->label[a->place[i]] = label[i];
  return KZ_OK;
}

kz_status kz_label_and_search(const kz_labeller *l, const kz_search_on *search, int64_t n, const int64_t *item,
                              kz_label *label) {
  KZ_AUTOFREE int64_t *place = kz_malloc((size_t)n * sizeof *place + 1);
  array a = {l, item, label, n, 0, place};
  const kz_unsettled unsettled = {count_open, rounds_pick, label_again, &a};
  KZ_TRY(kz_label_items(l, 1, n, item, label));
  return kz_search_rounds(l, search, &unsettled);
}
