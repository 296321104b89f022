/* The census: all cycles of places, attracting or not, each followed to the first curve that it meets. A cycle exists
 * in far more of the plane than it attracts in, so that bands are seen that starts hardly ever reach. */
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

/* A task of the census: a place, or a tile of its cycles. */
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

/* A cycle of kz_dynamics_search_line joins those of a tile, unless it is there already. */
static void join_cycle(const kz_atlas *atlas, const double place[2], const double *found, kz_atlas_seeds *cycles) {
  const int n = (int)found[0];
  kz_cycle cycle = {.kind = {.side = 1, .points = n}, .place = {place[0], place[1]}};
  for (int i = 0; i < n; i++) cycle.point[i][0] = M_PI * found[2 + 2 * i], cycle.point[i][1] = found[3 + 2 * i];
  if (!kz_atlas_has(atlas, cycles->count, cycles->list, &cycle, ONE)) kz_atlas_put(cycles, &cycle);
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
        if (!kz_atlas_has(c->atlas, all.count, all.list, some.list + i, ONE)) kz_atlas_put(&all, some.list + i);
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
    kz_cycle cycle = c->tile[tile].list[i];
    const bool is_raw = cycle.kind.side > 0 && !cycle.kind.rest; /* the search does not look at symmetries */
    if (!is_raw || kz_atlas_identify(c->atlas, &cycle, STEEPEST[0])) kz_atlas_explore_first(c->atlas, &cycle, &births);
  }
  kz_atlas_put_seeds(&births, record);
  return KZ_OK;
}

double kz_atlas_band_at(const kz_atlas *atlas, const kz_cycle *at) {
  kz_normal_form form;
  kz_pendulum pendulum;
  if (!kz_atlas_pendulum(atlas->scene, at->place, &pendulum) || !kz_cycle_form(&atlas->plane, at, &form)) return 0;
  return kz_atlas_band(&at->kind, kz_kind_determinant(&at->kind, pendulum.beta), form.coefficient,
                       hypot(form.side[0], form.side[1]));
}

double kz_atlas_widest(const kz_atlas *atlas, const kz_atlas_curve *curve) {
  double widest = 0;
  kz_pendulum pendulum;
  for (const kz_curve_row *row = curve->row; row < curve->row + curve->n; row++) {
    const double *place = row->at.place, *side = row->form.side;
    if (!(place[0] >= 0 && place[0] <= 1 && place[1] >= 0 && place[1] <= 1) ||
        !kz_atlas_pendulum(atlas->scene, place, &pendulum))
      continue;
    const double d = kz_kind_determinant(&curve->kind, pendulum.beta);
    widest = fmax(widest, kz_atlas_band(&curve->kind, d, row->form.coefficient, hypot(side[0], side[1])));
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
