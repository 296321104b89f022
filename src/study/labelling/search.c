/* Rounds of: follow the pending starts directly, look for cycles among those that nothing traps yet. What is left at
 * the end is chaotic, or has not settled. */
#include "search.h"

#include "numerics/cells.h"
#include "kapitza/dynamics_labels.h"

enum {
  FIRST_LENGTH = 128,   /* periods of the first round; a round that finds nothing doubles it */
  FIRST_OF_CYCLES = 32, /* first round if only cycles are sought, which is cheap */
  TILE = 256,           /* starts per tile */
  CHUNK = 64,           /* states per search, at most what kz_dynamics_find takes */
  PILOT_STARTS = 512,   /* starts that are followed before regions grow */
  WORTH_CELLS = 4096,   /* least number of cells or starts for which regions pay */
  MANY_CELLS = 40000,
  FEW_CELLS = 96,     /* least regions' grid along an axis for few cells: coarser ones hardly grow */
  FEWEST_CELLS = 200, /* least regions' grid for many cells */
  MOST_CELLS = 500,   /* finer ones trap hardly more */
  STRETCH = 1024,     /* periods of a tile at least */
  STRETCHES = 64,     /* tiles of a round, about */
  TABLE_ROWS = 4,     /* rows of a map table per tile */
  COVER_TRIES = 4,
  MOST_SOUGHT = 1024,  /* starts that a round looks for cycles from */
  RUNNING_STARTS = 16, /* among which a running state is looked for */
  COVER_PERIODS = 512  /* to see which pending starts an attractor's cover captures */
};

/* rad: how near an orbit must come back to itself to be tried, and in the last round, where slow spirals remain. */
static const double CLOSENESS = 0.02, LAST_CLOSENESS = 0.3;

typedef struct {
  kz_dynamics *dynamics;
  int64_t periods, n, *pending; /* pending [n]: which starts are followed */
  double *state;                /* [all] */
  int32_t *label;               /* [all] */
  int64_t all, sought;          /* how many of the pending ones a round looks for cycles from */
  int64_t age;                  /* periods followed by pending ones; INT64_MAX in the last round */
  bool cycles_alone;            /* nothing else is looked for */
} following;

typedef struct {
  double state[2 * TILE];
  int32_t label[TILE];
} followed;

static kz_status follow_starts(void *context, int64_t first, int64_t n, void *record) {
  const following *f = context;
  followed *out = record;
  int64_t periods[TILE];
  for (int64_t i = 0; i < n; i++) memcpy(out->state + 2 * i, f->state + 2 * f->pending[first + i], 2 * sizeof(double));
  kz_dynamics_follow(f->dynamics, KZ_FOLLOW_DIRECT, n, f->periods, out->state, out->label, periods, NULL);
  return KZ_OK;
}

/* The starts without label become the pending ones. */
static void list_pending(following *f) {
  f->n = 0;
  for (int64_t i = 0; i < f->all; i++)
    if (f->label[i] == 0) f->pending[f->n++] = i;
}

/* Follows the pending starts; those that are trapped get their label. In stretches: finished ones are kept, and a stop
 * request ends the search between two of them. */
static kz_status follow_pending(const kz_run *run, following *f, int64_t periods) {
  const int64_t stretch = kz_larger(periods / STRETCHES, STRETCH);
  for (int64_t done = 0; done < periods && f->n > 0; done += f->periods) {
    f->periods = kz_smaller(periods - done, stretch);
    const kz_stage stage = kz_stage_of_items("attractors", f->n, TILE, sizeof(followed), follow_starts, f);
    KZ_AUTOFREE followed *records = kz_malloc((size_t)stage.n_tiles * sizeof(followed) + 1);
    KZ_TRY(kz_stage_run(run, &stage, records));
    for (int64_t i = 0; i < f->n; i++) {
      const followed *record = records + i / TILE;
      memcpy(f->state + 2 * f->pending[i], record->state + 2 * (i % TILE), 2 * sizeof(double));
      f->label[f->pending[i]] = record->label[i % TILE];
    }
    list_pending(f);
  }
  return KZ_OK;
}

typedef struct {
  kz_dynamics *dynamics;
  kz_find what;
  int64_t n;
  double state[2 * CHUNK]; /* states of the starts; for chaos only the first */
  double number;           /* as of kz_dynamics_find */
  double *found;           /* [size] earlier finds, and the new ones; then a record */
  size_t size;
} seeking;

static kz_status seek_tile(void *context, int64_t tile, void *record) {
  const seeking *s = context;
  (void)tile;
  memcpy(record, s->found, s->size * sizeof(double));
  kz_dynamics_find(s->dynamics, s->what, s->n, s->state, s->number, record);
  return KZ_OK;
}

/* One search by one rank; its finds join the catalogue of every rank. */
static kz_status search_seek(const kz_run *run, seeking *s) {
  static const char *const name[] = {"cycles", "running", "chaos"};
  const kz_stage stage = kz_stage_for_all(name[s->what], 1, s->size * sizeof(double), seek_tile, s);
  KZ_TRY(kz_stage_run(run, &stage, s->found + s->size));
  memcpy(s->found, s->found + s->size, s->size * sizeof(double));
  kz_dynamics_adopt(s->dynamics, s->found);
  return KZ_OK;
}

/* A search of a kind; the caller frees `found`. */
static seeking seeking_of(const following *f, kz_find what, double number) {
  const size_t size = (size_t)kz_dynamics_find_size(f->dynamics, what);
  return (seeking){.dynamics = f->dynamics,
                   .what = what,
                   .number = number,
                   .found = kz_malloc(2 * size * sizeof(double)),
                   .size = size};
}

/* Sets n states, `step` pending starts apart, for a search that begins. */
static void seek_from(seeking *s, const following *f, int64_t n, int64_t first, int64_t step) {
  s->n = n;
  for (int64_t i = 0; i < n; i++)
    memcpy(s->state + 2 * i, f->state + 2 * f->pending[first + i * step / n], 2 * sizeof(double));
  memset(s->found, 0, s->size * sizeof(double));
}

/* Looks for cycles among the first pending starts. */
static kz_status find_cycles(const kz_run *run, const following *f, double closeness) {
  seeking s = seeking_of(f, KZ_FIND_CYCLE, closeness);
  KZ_AUTOFREE double *found = s.found;
  for (int64_t first = 0; first < f->n && first < f->sought; first += CHUNK) {
    const int64_t n = kz_smaller(f->n - first, CHUNK);
    seek_from(&s, f, n, first, n);
    while ((int64_t)found[0] < n) KZ_TRY(search_seek(run, &s));
  }
  return KZ_OK;
}

/* Starts that end on no cycle: attractors with covers are found one by one, a chaotic one from one pending start, a
 * running state among some of them. */
static kz_status find_covered(const kz_run *run, following *f, kz_find what) {
  seeking s = seeking_of(f, what, (double)f->age);
  KZ_AUTOFREE double *found = s.found;
  const bool chaos = what == KZ_FIND_CHAOS;
  for (int attempt = 0; attempt < COVER_TRIES && f->n > 0 && !f->cycles_alone; attempt++) {
    const int64_t known = kz_dynamics_count(f->dynamics);
    seek_from(&s, f, chaos ? 1 : kz_smaller(f->n, RUNNING_STARTS), chaos ? (attempt * 7) % f->n : 0, f->n);
    KZ_TRY(search_seek(run, &s));
    if (kz_dynamics_count(f->dynamics) > known) {
      kz_dynamics_update(f->dynamics);
      KZ_TRY(follow_pending(run, f, COVER_PERIODS));
    } else if (!chaos) {
      break;
    }
  }
  return KZ_OK;
}

/* Rounds until all have settled, or max_periods have passed and nothing more is found. */
static kz_status search_on(const kz_run *run, following *f, int64_t max_periods) {
  int64_t length = f->cycles_alone ? FIRST_OF_CYCLES : FIRST_LENGTH, done = 0;
  for (;;) {
    kz_dynamics_update(f->dynamics);
    KZ_TRY(follow_pending(run, f, length));
    done += length;
    f->age = done < max_periods ? done : INT64_MAX;
    if (f->n == 0) return KZ_OK;
    const int64_t known = kz_dynamics_count(f->dynamics);
    KZ_TRY(find_cycles(run, f, done >= max_periods ? LAST_CLOSENESS : CLOSENESS));
    if (kz_dynamics_count(f->dynamics) > known) continue;
    KZ_TRY(find_covered(run, f, KZ_FIND_RUNNING));
    if (done >= max_periods || f->n == 0) break;
    length = kz_smaller(2 * length, max_periods - done);
  }
  return find_covered(run, f, KZ_FIND_CHAOS);
}

kz_status kz_discover(const kz_run *run, kz_dynamics *dynamics, int64_t sought, int64_t max_periods, int64_t n,
                      double *state, int32_t *label) {
  KZ_AUTOFREE int32_t *own = kz_calloc((size_t)n + 1, sizeof *own);
  KZ_AUTOFREE int64_t *pending = kz_malloc((size_t)(n + 1) * sizeof *pending);
  following f = {.dynamics = dynamics,
                 .all = n,
                 .sought = sought > 0 ? sought : MOST_SOUGHT,
                 .state = state,
                 .label = label ? memset(label, 0, (size_t)n * sizeof *label) : own,
                 .pending = pending,
                 .cycles_alone = !label};
  list_pending(&f);
  KZ_TRY(search_on(run, &f, max_periods));
  if (kz_dynamics_count(dynamics) <= INT16_MAX) return KZ_OK;
  return kz_fail(KZ_FAILED, "more than %d attractors", INT16_MAX);
}

int64_t kz_regions_cells(int64_t cells) {
  if (cells < WORTH_CELLS) return 0;
  if (cells < MANY_CELLS) return FEW_CELLS;
  return (int64_t)fmin(fmax(FEWEST_CELLS, 0.256 * sqrt((double)cells)), MOST_CELLS);
}

void kz_regions_grow(kz_dynamics *dynamics, int64_t cells, double max_velocity) {
  static const double few =
      0.1; /* share of the grid that is trapped: a finer one may trap much more, and each cell pays for what is not */
  const int64_t coarse = kz_regions_cells(cells), fine = (int64_t)fmin(0.7 * sqrt((double)cells), MOST_CELLS);
  if (coarse == 0) return;
  kz_dynamics_regions(dynamics, coarse, max_velocity);
  if (cells >= MANY_CELLS && fine > coarse && kz_dynamics_trapped_share(dynamics) < few)
    kz_dynamics_regions(dynamics, fine, max_velocity);
}

static kz_status table_rows(void *context, int64_t first, int64_t n, void *record) {
  kz_dynamics *dynamics = context;
  for (int64_t i = 0; i < n; i++)
    kz_dynamics_table_row(dynamics, first + i, (double *)record + i * kz_dynamics_table_row_size(dynamics));
  return KZ_OK;
}

kz_status kz_map_table_make(const kz_run *run, kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity,
                            double max_velocity) {
  kz_dynamics_table_create(dynamics, n_theta, n_velocity, max_velocity);
  const size_t bytes = TABLE_ROWS * (size_t)kz_dynamics_table_row_size(dynamics) * sizeof(double);
  kz_stage stage = kz_stage_of_items("map table", n_velocity, TABLE_ROWS, bytes, table_rows, dynamics);
  KZ_AUTOFREE double *rows = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_status status = kz_stage_run(run, &stage, rows);
  if (status == KZ_OK) kz_dynamics_table_set(dynamics, rows);
  return status;
}

kz_status kz_search_window(const kz_run *run, kz_dynamics *dynamics, const kz_search *search, int32_t *label) {
  const double speed =
      search->max_velocity > 0 ? search->max_velocity : kz_dynamics_max_velocity(dynamics, &search->window);
  const int64_t labelled = kz_larger(search->cells, search->starts);
  const bool grows = kz_regions_cells(labelled) > 0 && search->starts > PILOT_STARTS;
  const int64_t pilots = grows ? PILOT_STARTS : search->starts, rest = search->starts - pilots;
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)search->starts * sizeof *state);
  KZ_AUTOFREE int32_t *own = kz_malloc((size_t)search->starts * sizeof *own);
  if (!label) label = own;
  kz_dynamics_starts(&search->window, search->seed, search->starts, state);
  kz_dynamics_regions(dynamics, 0, speed);
  KZ_TRY(kz_discover(run, dynamics, search->sought, search->max_periods, pilots, state, label));
  kz_regions_grow(dynamics, labelled, speed);
  if (search->table_theta > 0)
    KZ_TRY(kz_map_table_make(run, dynamics, search->table_theta, search->table_velocity, speed));
  if (rest == 0) return KZ_OK;
  return kz_discover(run, dynamics, search->sought, search->max_periods, rest, state + 2 * pilots, label + pilots);
}
