/* Cycles of single places, attracting or not, and where they are born: they exist in far more of the plane than they attract in. */
#include <math.h>
#include <string.h>

#include "saddles/saddles.h"
#include "atlas.h"

/* rad: no shorter piece of a line of starts is halved; traces of cycles that are followed, in those of a multiplier of 1; two cycles are one. */
static const double SHORTEST = 1e-3, STEEPEST = 100, ONE = 1e-5;
static const double FASTEST = 2.5;
/* Of one piece of a line; tiles of a place. */
enum { MOST_STARTS = 200000, TILES = 8 };

typedef struct {
  const kz_atlas *atlas;
  const double (*place)[2];
} births;

/* The window of the search at a place: no cycle of this pendulum is faster. */
static kz_saddles_plan window_of(const kz_atlas *atlas, const kz_pendulum *pendulum) {
  const double fastest = fmax(FASTEST, 1 + 2 * sqrt(kz_stiffness(pendulum)));
  return (kz_saddles_plan){
      .theta = {.min = -M_PI, .max = M_PI}, .velocity = {.min = -fastest, .max = fastest}, .max_period = atlas->max_period};
}

/* A cycle of kz_dynamics_search_line joins those of a line, unless it is there already. */
static void join(const kz_atlas *atlas, const double place[2], const double *found, kz_atlas_seeds *cycles) {
  const double state[2] = {M_PI * found[2], found[3]};
  kz_atlas_seed cycle;
  for (int64_t i = 0; i < cycles->count; i++)
    if (kz_kind_period(&cycles->list[i].kind) == (int32_t)found[0] && kz_atlas_same(atlas, cycles->list + i, state, ONE))
      return;
  if (kz_atlas_identify(atlas, place, state, (int)found[0], STEEPEST, &cycle)) kz_atlas_add(atlas, cycle.kind, cycle.y, cycles);
}

/* The cycles along one line of starts. */
static void search_line(const kz_atlas *atlas, const double place[2], const kz_lines *lines, int64_t line,
                        kz_atlas_seeds *cycles) {
  KZ_FREED double *found = kz_malloc(kz_piece_bytes(lines->plan));
  for (int64_t piece = 0; piece < lines->pieces; piece++) {
    int64_t work[2];
    const int64_t n = kz_lines_search(lines, line * lines->pieces + piece, MOST_STARTS, found, work);
    for (int64_t i = 0; i < n; i++) join(atlas, place, found + i * (2 + 2 * lines->plan->max_period), cycles);
  }
}

static kz_status births_tile(void *context, int64_t tile, void *record) {
  const births *b = context;
  const double *place = b->place[tile / TILES];
  KZ_FREED_BY(kz_atlas_seeds_free) kz_atlas_seeds cycles = {0};
  KZ_FREED_BY(kz_atlas_seeds_free) kz_atlas_seeds seeds = {0};
  kz_pendulum pendulum;
  if (kz_atlas_pendulum(b->atlas->scene, place, &pendulum)) {
    const kz_saddles_plan plan = window_of(b->atlas, &pendulum);
    kz_lines lines = kz_lines_of(&pendulum, &plan, 0);
    lines.shortest = SHORTEST;
    for (int64_t line = tile % TILES; line < lines.count; line += TILES) search_line(b->atlas, place, &lines, line, &cycles);
    for (int64_t i = 0; i < cycles.count; i++) kz_atlas_explore_first(b->atlas, cycles.list + i, &seeds);
  }
  kz_atlas_put_seeds(&seeds, record);
  return KZ_OK;
}

kz_status kz_atlas_births(const kz_atlas *atlas, const kz_run *run, int64_t n, const double (*place)[2], kz_atlas_bag *found) {
  births b = {atlas, place};
  return kz_atlas_gather(run, "atlas births", n * TILES, KZ_ATLAS_SEEDS_BYTES, false, births_tile, &b, found);
}
