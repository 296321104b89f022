/* What the branches prove, in the group /wada and the summary. */
#include <math.h>
#include <stdlib.h>

#include "wada.h"

enum { SIDES = 2 };
enum { OPEN, NO, PARTLY, YES }; /* of the variable wada */
static const char *const words[] = {"open: a branch is too short, or no cycle is known", "no", "partly", "yes"};

typedef struct {
  int64_t n_saddles, n_attractors;
  const char *basins; /* kz_branch_basins of both sides of each saddle */
  size_t stride;
} table;

static const kz_branch_basins *branch_of(const table *t, int64_t saddle, int64_t side) {
  return (const kz_branch_basins *)(t->basins + (size_t)(SIDES * saddle + side) * t->stride);
}

static bool meets(const table *t, int64_t saddle, int64_t attractor) {
  return !isnan(branch_of(t, saddle, 0)->witness[attractor].theta) || !isnan(branch_of(t, saddle, 1)->witness[attractor].theta);
}

static int32_t basins_of(const table *t, int64_t saddle) {
  int32_t n = 0;
  for (int64_t i = 0; i < t->n_attractors; i++) n += meets(t, saddle, i);
  return n;
}

/* Whether no longer branch would meet another basin. */
static bool is_complete(const table *t, int64_t saddle) {
  return branch_of(t, saddle, 0)->followed > 0 && branch_of(t, saddle, 1)->followed > 0;
}

/* Cycles whose stable manifolds bound the basin of a, and that of b too: how many, those that bound three, those that bound no third basin. */
typedef struct {
  int32_t all, three, two;
} bounds;

static bounds bounds_of(const table *t, int64_t a, int64_t b) {
  bounds n = {0};
  for (int64_t saddle = 0; saddle < t->n_saddles; saddle++) {
    const int32_t basins = basins_of(t, saddle);
    if (!meets(t, saddle, a) || !meets(t, saddle, b) || (basins < 2 && is_complete(t, saddle))) continue;
    n.all++;
    n.three += basins > 2;
    n.two += basins == 2 && is_complete(t, saddle);
  }
  return n;
}

static int8_t wada_of(const table *t, int64_t attractor) {
  const bounds n = bounds_of(t, attractor, attractor);
  if (n.three > 0 && n.two > 0) return PARTLY;
  if (n.all == 0 || n.three + n.two < n.all) return OPEN;
  return n.three > 0 ? YES : NO;
}

#define COLUMN(type, name, count, expression) KZ_COLUMN(store, "wada", name, count, type, expression)

static kz_status write_group(const table *t, kz_store *store) {
  const int64_t n = t->n_attractors, pairs = n * n;
  KZ_TRY(kz_store_dimension(store, "wada", "saddle", t->n_saddles, NULL));
  KZ_TRY(kz_store_dimension(store, "wada", "side", SIDES, NULL));
  KZ_TRY(kz_store_dimension(store, "wada", "attractor", n, NULL));
  KZ_TRY(kz_store_dimension(store, "wada", "other", n, NULL));
#define WITNESS(name) \
  COLUMN(double, #name, SIDES * t->n_saddles * n, branch_of(t, i / n / SIDES, i / n % SIDES)->witness[i % n].name)
  WITNESS(theta);
  WITNESS(velocity);
  WITNESS(arc_length);
  WITNESS(periods);
  COLUMN(int8_t, "followed", SIDES * t->n_saddles, branch_of(t, i / SIDES, i % SIDES)->followed);
  COLUMN(int32_t, "basins", t->n_saddles, basins_of(t, i));
  COLUMN(int8_t, "wada", n, wada_of(t, i));
  COLUMN(int32_t, "pair_cycles", pairs, i / n == i % n ? 0 : bounds_of(t, i / n, i % n).all);
  COLUMN(int32_t, "pair_shared", pairs, i / n == i % n ? 0 : bounds_of(t, i / n, i % n).three);
  return KZ_OK;
}

static void print(const table *t, FILE *summary) {
  int64_t every = 0;
  for (int64_t i = 0; i < t->n_saddles; i++) every += basins_of(t, i) == t->n_attractors;
  fprintf(summary, "wada: the unstable manifolds of %lld of %lld cycles meet all %lld basins\n", (long long)every,
          (long long)t->n_saddles, (long long)t->n_attractors);
  for (int64_t i = 0; i < t->n_attractors; i++) {
    const bounds n = bounds_of(t, i, i);
    fprintf(summary,
            "wada: attractor %lld, %s: its boundary has the stable manifolds of %d cycles; %d of them bound three basins or "
            "more, %d only two\n",
            (long long)i, words[wada_of(t, i)], n.all, n.three, n.two);
  }
}

kz_status kz_wada_write(int64_t n_saddles, int64_t n_attractors, const void *basins, size_t stride, kz_store *store,
                        FILE *summary) {
  const table t = {n_saddles, n_attractors, basins, stride};
  KZ_TRY(write_group(&t, store));
  print(&t, summary);
  return KZ_OK;
}
