/* The census: all cycles of places, attracting or not, each followed to the first curve that it meets. A cycle exists
 * in far more of the plane than it attracts in, so that bands are seen that starts hardly ever reach. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lines.h"
#include "curves.h"
#include "cycles.h"
#include "seeds.h"
#include "growth.h"
#include "probe.h"
#include "records.h"
#include "saddles/saddles.h"

/* rad: two cycles are one. */
static const double ONE = 1e-5;
/* Largest traces of the cycles of a place, in that of a multiplier of 1: along rows of starts, and along lines of
 * constant angle, for which those cycles are left that repel little and that no row passes. */
enum { SETS = 2 };
static const double STEEPEST[SETS] = {1e4, 100};
static const double FASTEST = 2.5;
/* Sides of the plane: curves are traced from places where the band beside them is wider; the search goes on while
 * curves are found that have a band as wide as the second. */
static const double LEAST_BAND = 1e-5, WIDE_BAND = 1e-4;
enum { TILES = 8, CYCLES_OF_A_TILE = 16 };

/* A place, or a tile of cycles of it. */
typedef struct {
  const kz_atlas *atlas;
  const kz_atlas_probe *probe;
  int64_t n, capacity, place_capacity;
  kz_atlas_seeds *tile; /* [n]: the cycles of tiles, and the place of each */
  int64_t *place_of;
} census;

/* The window of the search at a place: no cycle of this pendulum is faster. */
static kz_saddles_plan window_of(const kz_atlas *atlas, const kz_pendulum *pendulum) {
  const double fastest = fmax(FASTEST, 1 + 2 * sqrt(kz_stiffness(pendulum)));
  return (kz_saddles_plan){.theta = {.min = -M_PI, .max = M_PI},
                           .velocity = {.min = -fastest, .max = fastest},
                           .max_period = atlas->scene->atlas->max_period};
}

static bool has_cycle(const kz_atlas *atlas, const double place[2], const kz_atlas_seeds *cycles, int32_t period,
                      const double *state) {
  double at_image[2];
  const double *image = kz_atlas_image_state(atlas, place, state, at_image) ? at_image : NULL;
  for (int64_t i = 0; i < cycles->count; i++)
    if (kz_kind_period(&cycles->list[i].kind) == period && kz_atlas_same(cycles->list + i, state, image, ONE))
      return true;
  return false;
}

/* A cycle of kz_dynamics_search_line joins those of a tile, unless it is there already. */
static void join_cycle(const kz_atlas *atlas, const double place[2], const double *found, kz_atlas_seeds *cycles) {
  const int n = (int)found[0];
  kz_plane_cycle cycle = {.kind = {{1, n, 0, 0, 0}, -1}};
  for (int i = 0; i < n; i++) cycle.y[2 * i] = M_PI * found[2 + 2 * i], cycle.y[2 * i + 1] = found[3 + 2 * i];
  memcpy(cycle.y + 2 * n, place, 2 * sizeof *cycle.y);
  if (!has_cycle(atlas, place, cycles, n, cycle.y)) kz_atlas_put(cycles, &cycle);
}

/* The cycles along one line of starts. */
static void search_line(const kz_atlas *atlas, const double place[2], const kz_lines *lines, int64_t line,
                        kz_atlas_seeds *cycles) {
  KZ_AUTOFREE double *found = kz_malloc(kz_piece_bytes(lines->plan));
  int64_t work[2];
  const int64_t n = kz_lines_search(lines, line, INT64_MAX, found, work);
  cycles->dropped += n > KZ_CYCLES_OF_A_PIECE;
  for (int64_t i = 0; i < n && i < KZ_CYCLES_OF_A_PIECE; i++)
    join_cycle(atlas, place, found + i * (2 + 2 * lines->plan->max_period), cycles);
}

static kz_status cycles_tile(void *context, int64_t tile, void *record) {
  const census *c = context;
  const double *place = c->probe[tile / TILES].place;
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds cycles = {0};
  kz_pendulum pendulum;
  const bool exists = kz_atlas_pendulum(c->atlas->scene, place, &pendulum);
  for (int set = 0; set < SETS && exists; set++) {
    const kz_saddles_plan plan = window_of(c->atlas, &pendulum);
    kz_lines lines = kz_lines_of(&pendulum, &plan, set);
    lines.steepest = STEEPEST[set];
    lines.cells *= lines.pieces, lines.pieces = 1;
    for (int64_t line = tile % TILES; line < lines.count; line += TILES)
      search_line(c->atlas, place, &lines, line, &cycles);
  }
  kz_atlas_put_seeds(&cycles, record);
  return KZ_OK;
}

static void census_free(census *c) {
  for (int64_t i = 0; i < c->n; i++) kz_atlas_seeds_free(c->tile + i);
  free(c->tile);
  free(c->place_of);
}

/* The cycles of n places, each once, in tiles. */
static void list_cycles(census *c, const kz_atlas_bag *found, int64_t *dropped) {
  for (int64_t place = 0; place < found->n / TILES; place++) {
    KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds all = {0};
    for (int64_t i = 0; i < c->probe[place].found.count; i++) kz_atlas_put(&all, c->probe[place].found.list + i);
    for (int64_t tile = place * TILES; tile < (place + 1) * TILES; tile++) {
      const kz_atlas_seeds some = kz_atlas_seeds_in(found->record[tile]);
      *dropped += some.dropped;
      for (int64_t i = 0; i < some.count; i++)
        if (!has_cycle(c->atlas, c->probe[place].place, &all, kz_kind_period(&some.list[i].kind), some.list[i].y))
          kz_atlas_put(&all, some.list + i);
    }
    for (int64_t i = 0; i < all.count; i++) {
      if (i % CYCLES_OF_A_TILE == 0) {
        c->tile = kz_list_reserve(c->tile, &c->capacity, c->n + 1, sizeof *c->tile);
        c->place_of = kz_list_reserve(c->place_of, &c->place_capacity, c->n + 1, sizeof *c->place_of);
        c->place_of[c->n] = place;
        c->tile[c->n++] = (kz_atlas_seeds){0};
      }
      kz_atlas_put(c->tile + c->n - 1, all.list + i);
    }
  }
}

static int64_t count_cycles(const census *c) {
  int64_t n = 0;
  for (int64_t i = 0; i < c->n; i++) n += c->tile[i].count;
  return n;
}

static kz_status births_tile(void *context, int64_t tile, void *record) {
  const census *c = context;
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds births = {0};
  for (int64_t i = 0; i < c->tile[tile].count; i++) {
    const kz_plane_cycle *found = c->tile[tile].list + i;
    const int n = found->kind.of.points;
    const bool is_raw = found->kind.of.side > 0 && found->kind.rest < 0; /* the search does not look at symmetries */
    kz_plane_cycle cycle = *found;
    if (!is_raw || kz_atlas_identify(c->atlas, found->y + 2 * n, found->y, n, STEEPEST[0], &cycle))
      kz_atlas_explore_first(c->atlas, &cycle, &births);
  }
  kz_atlas_put_seeds(&births, record);
  return KZ_OK;
}

double kz_atlas_band_at(const kz_atlas *atlas, const kz_plane_cycle *at) {
  double form, side[2], vector[2];
  kz_pendulum pendulum;
  if (!kz_atlas_pendulum(atlas->scene, at->y + 2 * at->kind.of.points, &pendulum) ||
      !kz_curve_form(&atlas->plane, &at->kind.of, at->y, &form, side, vector))
    return 0;
  return kz_atlas_band(&at->kind, kz_kind_determinant(&at->kind.of, pendulum.beta), form, hypot(side[0], side[1]));
}

double kz_atlas_widest(const kz_atlas *atlas, const kz_atlas_curve *curve) {
  double widest = 0;
  kz_pendulum pendulum;
  for (int64_t i = 0; i < curve->n; i++) {
    const double *row = curve->row + i * kz_atlas_width(&curve->kind), *side = row + KZ_ROW_SIDE;
    if (!(row[0] >= 0 && row[0] <= 1 && row[1] >= 0 && row[1] <= 1) || !kz_atlas_pendulum(atlas->scene, row, &pendulum))
      continue;
    const double d = kz_kind_determinant(&curve->kind.of, pendulum.beta);
    widest = fmax(widest, kz_atlas_band(&curve->kind, d, row[KZ_ROW_FORM], hypot(side[0], side[1])));
  }
  return fmin(widest, 1);
}

/* The first curves of cycles at random places are kept, to be counted in the end. */
static void keep_sightings(kz_atlas *atlas, const census *c, const kz_atlas_bag *births) {
  for (int64_t tile = 0; tile < births->n; tile++) {
    const kz_atlas_seeds seeds = kz_atlas_seeds_in(births->record[tile]);
    for (int64_t i = 0; i < seeds.count; i++) {
      atlas->sighting_place = kz_list_reserve(atlas->sighting_place, &atlas->sighting_capacity,
                                              atlas->sightings.count + 1, sizeof *atlas->sighting_place);
      atlas->sighting_place[atlas->sightings.count] = atlas->places + c->place_of[tile];
      kz_atlas_put(&atlas->sightings, seeds.list + i);
    }
  }
}

void kz_atlas_count_sightings(const kz_atlas *atlas, int64_t *places) {
  KZ_AUTOFREE int64_t *last = kz_calloc((size_t)atlas->n_curves + 1, sizeof *last);
  memset(places, 0, (size_t)atlas->n_curves * sizeof *places);
  for (int64_t i = 0; i < atlas->sightings.count; i++) {
    const int64_t curve = kz_atlas_known(atlas, atlas->sightings.list + i);
    if (curve < 0 || last[curve] == atlas->sighting_place[i] + 1) continue;
    last[curve] = atlas->sighting_place[i] + 1;
    places[curve]++;
  }
}

kz_status kz_atlas_census(kz_atlas *atlas, const kz_run *run, int64_t n, const kz_atlas_probe *probe, int64_t *wide) {
  if (wide) *wide = 0;
  if (n == 0) return KZ_OK;
  const int64_t before = atlas->n_curves;
  KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag found = {0};
  KZ_AUTOFREE_BY(kz_atlas_bag_free) kz_atlas_bag births = {0};
  KZ_AUTOFREE_BY(census_free) census c = {.atlas = atlas, .probe = probe};
  KZ_TRY(kz_atlas_gather(run, "atlas cycles", n * TILES, KZ_ATLAS_SEEDS_BYTES, cycles_tile, &c, &found));
  list_cycles(&c, &found, &atlas->dropped);
  KZ_TRY(kz_atlas_gather(run, "atlas births", c.n, KZ_ATLAS_SEEDS_BYTES, births_tile, &c, &births));
  for (int64_t tile = 0; tile < births.n; tile++) {
    const kz_atlas_seeds seeds = kz_atlas_seeds_in(births.record[tile]);
    atlas->dropped += seeds.dropped;
    for (int64_t i = 0; i < seeds.count; i++)
      if (kz_atlas_band_at(atlas, seeds.list + i) > LEAST_BAND) kz_atlas_await(atlas, seeds.list + i);
  }
  KZ_TRY(kz_atlas_drain(atlas, run));
  if (!wide) return KZ_OK;
  keep_sightings(atlas, &c, &births);
  atlas->places += n;
  atlas->cycles += count_cycles(&c);
  for (int64_t i = before; i < atlas->n_curves; i++) *wide += kz_atlas_widest(atlas, atlas->curve + i) >= WIDE_BAND;
  return KZ_OK;
}
