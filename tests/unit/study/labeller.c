/* The labeller: items climb from level to level, and unsettled ones lead to attractors that nobody has named. */
#include <math.h>
#include <stdlib.h>

#include "../../tools/test.h"
#include "kapitza/study_catalogue.h"

#include "labelling/labeller.h"
#include "labelling/search.h"

enum { ITEMS = 40000 /* more than are followed together */, LEVELS = 3 };

/* How often each level has seen each item; the first level leaves some of them to the last at once. */
typedef struct {
  int seen[LEVELS][ITEMS];
} record;

/* The level that decides an item: 0, 1, 2, or none. */
static int labeller_decides(int64_t item) {
  return (int)(item % 4);
}

static bool is_left_to_last(int64_t item) {
  return labeller_decides(item) >= 2 && item % 3 == 0;
}

static kz_status label_level(void *context, int32_t level, int64_t n, const int64_t *item, kz_decision *decision) {
  record *r = context;
  for (int64_t i = 0; i < n; i++) {
    r->seen[level][item[i]]++;
    decision[i] =
        (kz_decision){.end = {.label = (int16_t)(labeller_decides(item[i]) == level ? 1 + item[i] % 1000 : KZ_DOUBTFUL),
                              .next = is_left_to_last(item[i]) ? 2 : (uint8_t)(level + 1)}};
  }
  return KZ_OK;
}

/* Each item is seen once by every level up to the one that decides it, but by none that it was not left to, and its
 * label comes back to its place. */
TEST(items_climb_until_they_are_decided) {
  static const kz_level rows[LEVELS] = {{.stage = "a", .evidence = 10, .tile = 7},
                                        {.stage = "b", .evidence = 11, .tile = 100},
                                        {.stage = "c", .evidence = 12, .tile = 1}};
  static const kz_added_levels levels = {rows, LEVELS, label_level};
  static record r;
  const kz_labeller labeller = {.way = KZ_BY_ADDED, .context = &r, .added = &levels};
  KZ_AUTOFREE int64_t *item = kz_malloc(ITEMS * sizeof *item);
  KZ_AUTOFREE kz_label *label = kz_malloc(ITEMS * sizeof *label);
  for (int64_t i = 0; i < ITEMS; i++) item[i] = (i * 7919) % ITEMS; /* each once */
  assert_int_equal(kz_label_items(&labeller, 1, ITEMS, item, label), KZ_OK);
  for (int64_t i = 0; i < ITEMS; i++) {
    const int last = labeller_decides(item[i]) < LEVELS ? labeller_decides(item[i]) : LEVELS - 1;
    for (int level = 0; level < LEVELS; level++)
      assert_int_equal(r.seen[level][item[i]], level <= last && !(level == 1 && is_left_to_last(item[i])));
    assert_int_equal(label[i].label, labeller_decides(item[i]) < LEVELS ? 1 + item[i] % 1000 : KZ_DOUBTFUL);
    assert_int_equal(label[i].evidence, 10 + last);
  }
}

/* A pendulum of which nothing is known: items settle only after a search from some of them. */
TEST(unsettled_items_lead_to_attractors) {
  enum { STARTS = 24 };
  const kz_pendulum pendulum = {.k = 1 / 121.0, .beta = 1 / 55.0, .m = 0.3};
  const kz_numerics numerics = {.scheme = kz_scheme_find("split6"), .steps_per_period = 24};
  kz_dynamics *dynamics = kz_dynamics_create(&pendulum, &numerics, 12);
  double start[2 * STARTS];
  kz_label label[STARTS];
  static int64_t reached[INT16_MAX + 1];
  int64_t all = 0;
  for (int i = 0; i < STARTS; i++) {
    start[2 * i] = M_PI * cos(i);
    start[2 * i + 1] = 0.5 * sin(3 * i);
  }
  kz_dynamics_regions(dynamics, 0, 3);
  const kz_labeller labeller = kz_pair_labeller(start, 2000, KZ_BY_STATES, dynamics);
  assert_int_equal(kz_label_items(&labeller, 1, STARTS, NULL, label), KZ_OK);
  for (int i = 0; i < STARTS; i++) assert_true(label[i].label == 0 && label[i].periods == 2000);
  const kz_search_on search = {.rounds = 3, .starts = STARTS / 2, .reached = reached};
  assert_int_equal(kz_label_and_search(&labeller, &search, STARTS, NULL, label), KZ_OK);
  assert_true(kz_dynamics_count(dynamics) > 0);
  for (int i = 0; i < STARTS; i++)
    assert_true(label[i].label > 0 && label[i].label <= kz_dynamics_count(dynamics) && label[i].periods < 2000);
  for (int i = 0; i <= INT16_MAX; i++) all += reached[i];
  assert_true(all >= STARTS / 2);
  kz_dynamics_free(dynamics);
}

/* Every evidence that a level gives has the level's word; what no level gives has none. */
TEST(evidence_has_the_word_of_its_level) {
  for (int level = 0; level < KZ_LEVELS; level++)
    assert_string_equal(kz_evidence_word(kz_level_rows[level].evidence), kz_level_rows[level].word);
  for (int i = 0; i < kz_study_count; i++) /* including those of powers */
    for (int32_t level = 0; level < kz_studies[i]->n_levels; level++)
      assert_ptr_equal(kz_evidence_word(kz_studies[i]->levels[level].evidence), kz_studies[i]->levels[level].word);
  assert_null(kz_evidence_word(KZ_UNDECIDED));
  assert_null(kz_evidence_word(KZ_LEFT));
}
