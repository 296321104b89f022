/* Curves from seeds: they are traced and explored until nothing new is met. */
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "growth.h"
#include "records.h"

enum {
  LINES = 5,        /* along each axis on which all branches are followed */
  LINES_CHECKED = 8 /* with checks: thin bands lie between the lines of a quick atlas */
};
/* Where the first line lies between an edge and the next line. */
static const double OFFSET = 0.4142;

/* ---- curves: one of each kind at a time is traced, so that no curve is traced twice ---- */

typedef struct {
  kz_atlas *atlas;
  int64_t n;
  kz_cycle *seed;
} tracing;

static kz_status trace_tile(void *context, int64_t tile, void *record) {
  const tracing *t = context;
  kz_atlas_curve curve;
  kz_atlas_trace(t->atlas, t->seed + tile, &curve);
  kz_atlas_put_curve(&curve, record);
  kz_atlas_curve_free(&curve);
  return KZ_OK;
}

/* The first pending seed of each kind, without those that are known by now. */
static void next_seeds(kz_atlas *atlas, tracing *t) {
  kz_atlas_seeds *pending = &atlas->pending;
  int64_t left = 0;
  t->n = 0;
  for (int64_t i = 0; i < pending->count; i++) {
    const kz_cycle seed = pending->list[i];
    bool waits = false;
    if (kz_atlas_known(atlas, &seed) >= 0) continue;
    for (int64_t j = 0; j < t->n && !waits; j++) waits = !memcmp(&t->seed[j].kind, &seed.kind, sizeof seed.kind);
    if (waits)
      pending->list[left++] = seed;
    else
      t->seed[t->n++] = seed;
  }
  pending->count = left;
}

/* By the ending of a trace without a point. */
static int refusal_of(int32_t ending) {
  return ending == KZ_TRACE_THIN     ? KZ_ATLAS_TOO_THIN
         : ending == KZ_TRACE_MERGED ? KZ_ATLAS_OF_SHORTER
                                     : KZ_ATLAS_NO_POINT;
}

static kz_status trace_pending(kz_atlas *atlas, const kz_run *run) {
  KZ_AUTOFREE kz_cycle *seed = kz_malloc((size_t)(atlas->pending.count + 1) * sizeof *seed);
  tracing t = {.atlas = atlas, .seed = seed};
  for (next_seeds(atlas, &t); t.n > 0; next_seeds(atlas, &t)) {
    KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag traced = {0};
    KZ_TRY(kz_atlas_gather(run, "atlas curves", t.n, KZ_ATLAS_CURVE_BYTES, trace_tile, &t, &traced));
    for (int64_t i = 0; i < t.n; i++) {
      kz_atlas_curve curve = kz_atlas_curve_in(traced.record[i]);
      if (curve.n > 0) {
        kz_atlas_keep(atlas, &curve);
        continue;
      }
      atlas->refused[refusal_of(curve.ending[1])]++;
      kz_atlas_curve_free(&curve);
    }
  }
  return KZ_OK;
}

/* ---- exploration ---- */

/* Lines through the plane, new curves: a tile each. */
typedef struct {
  kz_atlas *atlas;
  int64_t first, lines; /* the first new curve; lines along each axis that are followed now */
} exploring;

static int64_t lines_of(const kz_atlas *atlas) {
  return atlas->scene->atlas->checks > 0 ? LINES_CHECKED : LINES;
}

static double line_at(const kz_atlas *atlas, int64_t line) {
  return ((double)line + OFFSET) / (double)lines_of(atlas);
}

/* Whether a curve crosses two lines. */
static bool crosses_lines(const kz_atlas *atlas, const kz_atlas_curve *curve) {
  int crossed = 0;
  for (int axis = 0; axis < 2; axis++) {
    double low = 1, high = 0;
    for (int64_t row = 0; row < curve->n; row++) {
      low = fmin(low, curve->row[row].at.place[axis]);
      high = fmax(high, curve->row[row].at.place[axis]);
    }
    for (int64_t line = 0; line < lines_of(atlas); line++)
      crossed += low < line_at(atlas, line) && line_at(atlas, line) < high;
  }
  return crossed >= 2;
}

static kz_status explore_tile(void *context, int64_t tile, void *record) {
  const exploring *e = context;
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds seeds = {0};
  const int64_t curves = 2 * e->lines;
  const kz_atlas_curve *curve = e->atlas->curve + e->first + tile - curves;
  if (tile < curves)
    kz_atlas_explore_line(e->atlas, (int)(tile % 2), line_at(e->atlas, tile / 2), e->first, &seeds, NULL);
  else
    kz_atlas_explore_curve(e->atlas, curve, !crosses_lines(e->atlas, curve), &seeds);
  kz_atlas_put_seeds(&seeds, record);
  return KZ_OK;
}

void kz_atlas_await(kz_atlas *atlas, const kz_cycle *seed) {
  if (kz_atlas_known(atlas, seed) < 0) kz_atlas_add(atlas, seed, &atlas->pending);
}

static void await_all(kz_atlas *atlas, const kz_atlas_bag *found) {
  for (int64_t i = 0; i < found->n; i++) {
    const kz_atlas_seeds seeds = kz_atlas_seeds_in(found->record[i]);
    atlas->dropped += seeds.dropped;
    for (int64_t j = 0; j < seeds.count; j++) kz_atlas_await(atlas, seeds.list + j);
  }
}

static kz_status growth_explore(kz_atlas *atlas, const kz_run *run) {
  KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag found = {0};
  const int64_t curves = atlas->n_curves - atlas->n_explored;
  exploring e = {atlas, atlas->n_explored, lines_of(atlas)};
  if (curves == 0) return KZ_OK;
  KZ_TRY(kz_atlas_gather(run, "atlas branches", 2 * e.lines + curves, KZ_ATLAS_SEEDS_BYTES, explore_tile, &e, &found));
  atlas->n_explored = atlas->n_curves;
  await_all(atlas, &found);
  return KZ_OK;
}

kz_status kz_atlas_drain(kz_atlas *atlas, const kz_run *run) {
  while (atlas->pending.count > 0 || atlas->n_explored < atlas->n_curves) {
    KZ_TRY(trace_pending(atlas, run));
    KZ_TRY(growth_explore(atlas, run));
  }
  return KZ_OK;
}

typedef struct {
  kz_atlas *atlas;
  const double *x;
} columns;

static kz_status column_tile(void *context, int64_t tile, void *record) {
  const columns *c = context;
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds seeds = {0};
  kz_atlas_explore_line(c->atlas, 1, c->x[tile], 0, &seeds, NULL);
  kz_atlas_put_seeds(&seeds, record);
  return KZ_OK;
}

kz_status kz_atlas_explore_columns(kz_atlas *atlas, const kz_run *run, int64_t n, const double *x) {
  KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag found = {0};
  columns c = {atlas, x};
  KZ_TRY(kz_atlas_gather(run, "atlas columns", n, KZ_ATLAS_SEEDS_BYTES, column_tile, &c, &found));
  await_all(atlas, &found);
  return kz_atlas_drain(atlas, run);
}
