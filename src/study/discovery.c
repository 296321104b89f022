/* Rounds of: follow the open starts directly, look for cycles among those that nothing traps yet. What is left at the end is
 * chaotic, or has not settled. */
#include "discovery.h"

#include <stdlib.h>
#include <string.h>

#include "map_table.h"

enum {
  FIRST_LENGTH = 128, /* periods of the first round; a round that finds nothing doubles it */
  TILE = 256,         /* starts per tile */
  CHUNK = 64,         /* states per search, at most what kz_dynamics_find_cycles takes */
  CHUNKS = 16,        /* searches per round */
  SCOUTS = 512,       /* starts that are followed before there is a table */
  CHAOS_TRIES = 4,
  CHAOS_PERIODS = 512 /* to see which open starts a chaotic attractor's cover captures */
};

/* rad: how near an orbit must come back to itself to be tried, and in the last round, where slow spirals remain. */
static const double CLOSENESS = 0.02, LAST_CLOSENESS = 0.3;

typedef struct {
  kz_dynamics *dynamics;
  int64_t periods, n, *open; /* open [n]: which starts are followed */
  double *state;
} following;

typedef struct {
  double state[2 * TILE];
  int32_t owner[TILE];
} followed;

kz_status kz_stage_run_with(kz_team *team, const kz_stage *stage, void *records) {
  if (team != NULL) return kz_stage_run(team, stage, records);
  memset(records, 0, (size_t)stage->n_tiles * stage->record_bytes);
  for (int64_t tile = 0; tile < stage->n_tiles; tile++)
    KZ_TRY(stage->work(stage->context, tile, (char *)records + (size_t)tile * stage->record_bytes));
  return KZ_OK;
}

static kz_status follow_tile(void *context, int64_t tile, void *record) {
  const following *f = context;
  followed *out = record;
  int64_t periods[TILE];
  int64_t first = tile * TILE, n = f->n - first < TILE ? f->n - first : TILE;
  for (int64_t i = 0; i < n; i++) memcpy(out->state + 2 * i, f->state + 2 * f->open[first + i], 2 * sizeof(double));
  kz_dynamics_settle(f->dynamics, n, f->periods, out->state, out->owner, periods);
  return KZ_OK;
}

/* The starts without owner, into open [n]; returns how many. */
static int64_t list_open(int64_t n, const int32_t *owner, int64_t *open) {
  int64_t n_open = 0;
  for (int64_t i = 0; i < n; i++)
    if (owner[i] == 0) open[n_open++] = i;
  return n_open;
}

/* Follows the open starts for some periods; those that are trapped get their owner. */
static kz_status follow_open(kz_team *team, following *f, int32_t *owner) {
  kz_stage stage = {.name = "attractors",
                    .n_tiles = (f->n + TILE - 1) / TILE,
                    .record_bytes = sizeof(followed),
                    .work = follow_tile,
                    .context = f,
                    .everywhere = true};
  followed *records = malloc((size_t)stage.n_tiles * sizeof(followed) + 1);
  kz_status status = records ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)f->n);
  if (team != NULL) status = kz_team_agree(team, status);
  if (status == KZ_OK) status = kz_stage_run_with(team, &stage, records);
  for (int64_t i = 0; status == KZ_OK && i < f->n; i++) {
    const followed *record = records + i / TILE;
    memcpy(f->state + 2 * f->open[i], record->state + 2 * (i % TILE), 2 * sizeof(double));
    owner[f->open[i]] = record->owner[i % TILE];
  }
  free(records);
  return status;
}

/* The catalogue of rank 0 on every rank. */
static kz_status share_catalogue(kz_team *team, kz_dynamics *dynamics) {
  if (team == NULL) return KZ_OK;
  int64_t size = kz_dynamics_packed_size(dynamics);
  KZ_TRY(kz_team_broadcast(team, &size, sizeof size));
  double *flat = malloc((size_t)size * sizeof *flat);
  KZ_TRY(kz_team_agree(team, flat ? KZ_OK : kz_fail(KZ_FAILED, "no memory for the catalogue of attractors")));
  if (kz_team_rank(team) == 0) kz_dynamics_pack(dynamics, size, flat);
  kz_status status = kz_team_broadcast(team, flat, (size_t)size * sizeof *flat);
  if (status == KZ_OK && kz_team_rank(team) != 0) kz_dynamics_unpack(dynamics, size, flat);
  free(flat);
  return status;
}

static bool leads(const kz_team *team) {
  return team == NULL || kz_team_rank(team) == 0;
}

static void search_open(const following *f, double closeness) {
  double state[2 * CHUNK];
  for (int64_t first = 0; first < f->n && first < CHUNKS * CHUNK; first += CHUNK) {
    int64_t n = f->n - first < CHUNK ? f->n - first : CHUNK;
    for (int64_t i = 0; i < n; i++) memcpy(state + 2 * i, f->state + 2 * f->open[first + i], 2 * sizeof(double));
    kz_dynamics_find_cycles(f->dynamics, n, state, closeness);
  }
}

/* What no cycle has taken: chaotic attractors, found one by one from the first open start. */
static kz_status find_chaos(kz_team *team, following *f, int64_t n, int32_t *owner) {
  for (int attempt = 0; attempt < CHAOS_TRIES && f->n > 0; attempt++) {
    int64_t known = kz_dynamics_count(f->dynamics);
    if (leads(team)) kz_dynamics_find_chaos(f->dynamics, f->state + 2 * f->open[(attempt * 7) % f->n]);
    KZ_TRY(share_catalogue(team, f->dynamics));
    if (kz_dynamics_count(f->dynamics) == known) continue;
    kz_dynamics_update(f->dynamics);
    f->periods = CHAOS_PERIODS;
    KZ_TRY(follow_open(team, f, owner));
    f->n = list_open(n, owner, f->open);
  }
  return KZ_OK;
}

static kz_status discover(kz_team *team, following *f, int64_t max_periods, int64_t n, int32_t *owner) {
  int64_t length = FIRST_LENGTH, done = 0;
  for (;;) {
    kz_dynamics_update(f->dynamics);
    f->periods = length;
    KZ_TRY(follow_open(team, f, owner));
    done += length;
    f->n = list_open(n, owner, f->open);
    if (f->n == 0) return KZ_OK;
    int64_t known = kz_dynamics_count(f->dynamics);
    if (leads(team)) search_open(f, done >= max_periods ? LAST_CLOSENESS : CLOSENESS);
    KZ_TRY(share_catalogue(team, f->dynamics));
    if (kz_dynamics_count(f->dynamics) > known) continue;
    if (done >= max_periods) break;
    length = 2 * length < max_periods - done ? 2 * length : max_periods - done;
  }
  return find_chaos(team, f, n, owner);
}

kz_status kz_discover(kz_team *team, kz_dynamics *dynamics, int64_t max_periods, int64_t n, double *state, int32_t *owner) {
  following f = {.dynamics = dynamics, .n = n, .state = state, .open = malloc((size_t)(n + 1) * sizeof *f.open)};
  kz_status status = f.open ? KZ_OK : kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)n);
  if (team != NULL) status = kz_team_agree(team, status);
  if (status == KZ_OK) {
    memset(owner, 0, (size_t)n * sizeof *owner);
    list_open(n, owner, f.open);
    status = discover(team, &f, max_periods, n, owner);
  }
  free(f.open);
  return status;
}

kz_status kz_search_window(kz_team *team, kz_dynamics *dynamics, const kz_search *search, double *state, int32_t *owner) {
  const bool table = search->table_theta > 0;
  const int64_t scouts = table && search->starts > SCOUTS ? SCOUTS : search->starts, rest = search->starts - scouts;
  kz_dynamics_starts(&search->window, search->seed, search->starts, state);
  kz_dynamics_outline(dynamics, search->reach);
  KZ_TRY(kz_discover(team, dynamics, search->max_periods, scouts, state, owner));
  if (table) KZ_TRY(kz_map_table_make(team, dynamics, search->table_theta, search->table_velocity, search->reach));
  return rest > 0 ? kz_discover(team, dynamics, search->max_periods, rest, state + 2 * scouts, owner + scouts) : KZ_OK;
}
