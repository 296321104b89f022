/* Search for all curves: from cycles of places, and attractors not explained, until random places agree. */
#include "numerics/share.h"
#include "lines.h"
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "growth.h"
#include "motions.h"
#include "probe.h"
#include "records.h"
#include "regions.h"

enum {
  FURTHER = 20, /* places of a round whose cycles are searched */
  MANY = 256,   /* starts at places that check the curves */
  ROUNDS = 16,  /* largest number of rounds of checks */
  QUIET = 2     /* rounds in a row that find nothing end the search */
};

/* ---- places whose attractors are searched ---- */

typedef struct {
  kz_atlas *atlas;
  int64_t n, starts, round;
  kz_atlas_probe *probe;
} probing;

static kz_status probe_tile(void *context, int64_t tile, void *record) {
  const probing *p = context;
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds found = {0};
  KZ_TRY(kz_atlas_probe_at(p->atlas, p->probe[tile].place, p->starts, 1 + tile + 1000 * p->round, &found));
  kz_atlas_put_seeds(&found, record);
  return KZ_OK;
}

static kz_status probe_all(const kz_run *run, const char *name, probing *p) {
  KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag found = {0};
  KZ_TRY(kz_atlas_gather(run, name, p->n, KZ_ATLAS_SEEDS_BYTES, probe_tile, p, &found));
  for (int64_t i = 0; i < p->n; i++) {
    const kz_atlas_seeds seeds = kz_atlas_seeds_in(found.record[i]);
    kz_atlas_seeds *mine = &p->probe[i].found;
    p->atlas->dropped += seeds.dropped;
    *mine = (kz_atlas_seeds){seeds.count, kz_malloc((size_t)(seeds.count + 1) * sizeof *mine->list)};
    memcpy(mine->list, seeds.list, (size_t)seeds.count * sizeof *mine->list);
  }
  return KZ_OK;
}

static void probes_free(int64_t n, kz_atlas_probe *probe) {
  for (int64_t i = 0; i < n; i++) kz_atlas_seeds_free(&probe[i].found);
  free(probe);
}

/* Whether the curves do not explain what was found at a place, or contradict each other. */
static bool is_wrong(kz_atlas *atlas, const kz_atlas_probe *probe) {
  KZ_AUTOFREE int32_t *counts = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  kz_atlas_count(atlas, probe->place, counts);
  if (!kz_atlas_plausible(atlas, counts)) return true;
  for (int64_t i = 0; i < probe->found.count; i++) {
    const kz_atlas_class class = kz_atlas_class_of(&probe->found.list[i].kind);
    if (--counts[kz_atlas_class_number(atlas, &class)] < 0) return true;
  }
  return false;
}

/* Without an undriven edge: what attracts at the reference. */
static void set_reference(kz_atlas *atlas, const kz_atlas_probe *probe) {
  memset(atlas->at_reference, 0, sizeof atlas->at_reference);
  for (int64_t j = 0; j < probe->found.count; j++) {
    const kz_atlas_class class = kz_atlas_class_of(&probe->found.list[j].kind);
    atlas->at_reference[kz_atlas_class_number(atlas, &class)]++;
  }
}

static kz_status search_reference(kz_atlas *atlas, const kz_run *run) {
  kz_atlas_probe *probe = kz_calloc(1, sizeof *probe);
  memcpy(probe->place, atlas->reference, sizeof probe->place);
  probing p = {atlas, 1, 8 * MANY, 0, probe};
  kz_status status = probe_all(run, "atlas reference", &p);
  if (status == KZ_OK) set_reference(atlas, probe);
  if (status == KZ_OK) status = kz_atlas_census(atlas, run, 1, probe, NULL);
  probes_free(1, probe);
  return status;
}

/* The census of the next places of the sequence; *wide: as in kz_atlas_census. */
static kz_status search_next(kz_atlas *atlas, const kz_run *run, int64_t first, int64_t n, int64_t *wide) {
  KZ_AUTOFREE kz_atlas_probe *probe = kz_calloc((size_t)n + 1, sizeof *probe);
  for (int64_t i = 0; i < n; i++) kz_even_share(first + i + 1, probe[i].place);
  return kz_atlas_census(atlas, run, n, probe, wide);
}

/* Curves from the cycles of places where something has no explanation; *wrong = how many. */
static kz_status search_mend(kz_atlas *atlas, const kz_run *run, int64_t n, const kz_atlas_probe *probe,
                             int64_t *wrong) {
  KZ_AUTOFREE kz_atlas_probe *at = kz_malloc((size_t)(n + 1) * sizeof *at);
  *wrong = 0;
  for (int64_t i = 0; i < n; i++)
    if (is_wrong(atlas, probe + i)) at[(*wrong)++] = probe[i];
  return kz_atlas_census(atlas, run, *wrong, at, NULL);
}

/* A round: the census of further places and then, if that finds no curve with a wide band, the attractors of random
 * ones. *quiet: neither finds anything. The probes of the former round go. */
static kz_status search_check(kz_atlas *atlas, const kz_run *run, int round, bool *quiet, probing *p) {
  const int64_t n = atlas->scene->atlas->checks;
  int64_t wide;
  KZ_TRY(search_next(atlas, run, atlas->scene->atlas->seeds + round * FURTHER, FURTHER, &wide));
  kz_atlas_compare_images(atlas);
  KZ_TRY(kz_atlas_drain(atlas, run));
  *quiet = wide == 0;
  if (!*quiet && round + 1 < ROUNDS) return KZ_OK;
  probes_free(p->n, p->probe);
  *p = (probing){atlas, n, MANY, 2 + round, kz_calloc((size_t)n, sizeof *p->probe)};
  for (int64_t i = 0; i < n; i++) kz_even_share(1001 + round * n + i, p->probe[i].place);
  KZ_TRY(probe_all(run, "atlas checks", p));
  KZ_TRY(search_mend(atlas, run, n, p->probe, &atlas->disagreed));
  atlas->checked = n;
  *quiet = *quiet && atlas->disagreed == 0;
  return KZ_OK;
}

/* Follows columns in which the curves contradict each other: a missing curve branches off one that crosses them. */
static kz_status mend_columns(kz_atlas *atlas, const kz_run *run) {
  enum { LINES = 8, TRIES = 4 };
  const int64_t points = atlas->scene->atlas->points;
  KZ_AUTOFREE double *x = kz_malloc((size_t)points * sizeof *x);
  int64_t curves = -1;
  for (int i = 0; i < TRIES && curves != atlas->n_curves; i++) {
    int64_t n = 0, lines = 0;
    for (int64_t column = 0; column < points; column++)
      if (kz_atlas_fill_column(atlas, column, NULL) > 0)
        x[n++] = kz_atlas_column(atlas, kz_atlas_middle(column, points));
    for (int64_t k = 0; k < n; k += (n + LINES - 1) / LINES) x[lines++] = x[k];
    curves = atlas->n_curves;
    if (n > 0) KZ_TRY(kz_atlas_explore_columns(atlas, run, lines, x));
  }
  return KZ_OK;
}

/* Rounds, until some in a row find nothing. */
static kz_status check_all(kz_atlas *atlas, const kz_run *run, probing *last) {
  for (int round = 0, quiet = 0; round < ROUNDS && quiet < QUIET && atlas->scene->atlas->checks > 0; round++) {
    bool is_quiet;
    KZ_TRY(search_check(atlas, run, round, &is_quiet, last));
    atlas->rounds = round + 1;
    quiet = is_quiet ? quiet + 1 : 0;
  }
  KZ_TRY(mend_columns(atlas, run));
  kz_atlas_compare_images(atlas);
  return KZ_OK;
}

/* ---- the motions of the lists ---- */

typedef struct {
  int64_t listed, unsolved;
} answers;

static kz_status confirm_tile(void *context, int64_t tile, void *record) {
  const probing *p = context;
  answers *a = record;
  kz_atlas_confirm(p->atlas, p->probe[tile].place, &p->probe[tile].found, &a->listed, &a->unsolved);
  return KZ_OK;
}

/* Solves for every motion of the lists of the places of the last round. */
static kz_status search_confirm(kz_atlas *atlas, const kz_run *run, probing *p) {
  KZ_AUTOFREE answers *of = kz_calloc((size_t)p->n + 1, sizeof *of);
  const kz_stage stage = kz_stage_for_all("atlas motions", p->n, sizeof *of, confirm_tile, p);
  if (p->n == 0) return KZ_OK;
  KZ_TRY(kz_stage_run(run, &stage, of));
  for (int64_t i = 0; i < p->n; i++) atlas->listed += of[i].listed, atlas->unsolved += of[i].unsolved;
  return KZ_OK;
}

kz_status kz_atlas_search(kz_atlas *atlas, const kz_run *run) {
  if (!atlas->undriven) KZ_TRY(search_reference(atlas, run));
  int64_t wide;
  KZ_TRY(search_next(atlas, run, 0, atlas->scene->atlas->seeds, &wide));
  probing last = {0};
  kz_status status = check_all(atlas, run, &last);
  kz_atlas_join(atlas);
  kz_atlas_order(atlas);
  if (status == KZ_OK) status = search_confirm(atlas, run, &last);
  probes_free(last.n, last.probe);
  return status;
}
