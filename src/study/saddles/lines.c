/* A round of the search: the window is crossed by parallel lines of starts, whose pieces are the tiles. */
#include "saddles.h"

enum {
  LEAST_LINES = 4,
  CELLS = 16,             /* Cells of a piece */
  MOST_STARTS = 20000000, /* Starts of a piece at most */
};
/* rad: between the lines of the first round, between the starts of a line to begin with, between two cycles. */
static const double SPACING = 0.2, CELL = 0.05, ONE = 1e-5;

static double lines_width(const kz_axis *axis) {
  return axis->max - axis->min;
}

/* A window that is its own mirror image: its upper half shows every cycle or the mirror image of it. */
static bool is_mirrored(const kz_saddles_plan *plan) {
  return plan->velocity.min == -plan->velocity.max &&
         (plan->theta.min == -plan->theta.max || lines_width(&plan->theta) == 2 * M_PI);
}

kz_lines kz_lines_of(const kz_pendulum *pendulum, const kz_saddles_plan *plan, int round) {
  kz_axis velocity = plan->velocity;
  if (kz_is_mirrored(pendulum) && is_mirrored(plan)) velocity.min = 0;
  kz_lines lines = {.pendulum = pendulum, .plan = plan, .rows = round % 2 == 0, .steepest = INFINITY};
  lines.along = lines.rows ? plan->theta : velocity;
  lines.across = lines.rows ? velocity : plan->theta;
  lines.count = (int64_t)fmax(LEAST_LINES, ceil(lines_width(&lines.across) / SPACING * pow(2, round / 2)));
  lines.pieces = (int64_t)fmax(1, ceil(lines_width(&lines.along) / (CELLS * CELL)));
  lines.cells = CELLS;
  return lines;
}

size_t kz_cycle_bytes(const kz_saddles_plan *plan) {
  return (size_t)(2 + 2 * plan->max_period) * sizeof(double);
}

size_t kz_piece_bytes(const kz_saddles_plan *plan) {
  return sizeof(uint64_t) + KZ_CYCLES_OF_A_PIECE * kz_cycle_bytes(plan);
}

int64_t kz_lines_search(const kz_lines *lines, int64_t tile, int64_t most_starts, double *found, int64_t work[2]) {
  const kz_saddles_plan *plan = lines->plan;
  const kz_line_search search = {.max_period = plan->max_period,
                                 .most_starts = most_starts,
                                 .most = KZ_CYCLES_OF_A_PIECE,
                                 .window = {plan->theta.min, plan->theta.max, plan->velocity.min, plan->velocity.max},
                                 .steepest = lines->steepest};
  const double first = (double)(tile % lines->pieces * lines->cells), cells = (double)(lines->pieces * lines->cells);
  const double line = (double)(tile / lines->pieces) + 0.5;
  KZ_AUTOFREE double (*node)[2] = kz_malloc((size_t)(lines->cells + 1) * sizeof *node);
  for (int64_t i = 0; i <= lines->cells; i++) {
    const double along = lines->along.min + lines_width(&lines->along) * (first + (double)i) / cells;
    const double across = lines->across.min + lines_width(&lines->across) * line / (double)lines->count;
    node[i][0] = lines->rows ? along : across;
    node[i][1] = lines->rows ? across : along;
  }
  return kz_dynamics_search_line(lines->pendulum, &search, lines->cells + 1, node[0], found, work);
}

static int lines_compare(const void *first, const void *second) {
  const double *a = first, *b = second;
  int i = 0;
  for (const int n = 2 + 2 * (int)a[0]; i < n - 1 && a[i] == b[i]; i++) continue;
  return (a[i] > b[i]) - (a[i] < b[i]);
}

/* Whether two cycles of one period are one, or mirror images, when the points of b are taken from `first` on. */
static bool lines_coincide(const double *a, const double *b, int first, int side) {
  const int n = (int)a[0];
  for (int i = 0; i < n; i++) {
    const double *x = a + 2 + 2 * i, *y = b + 2 + 2 * ((first + i) % n);
    if (hypot(M_PI * remainder(x[0] - side * y[0], 2), x[1] - side * y[1]) > ONE) return false;
  }
  return true;
}

static bool is_same(const double *a, const double *b) {
  for (int first = 0; first < (int)a[0]; first++)
    if (lines_coincide(a, b, first, 1) || lines_coincide(a, b, first, -1)) return true;
  return false;
}

/* Sorts n cycles and leaves each once, or its mirror image: how many. */
static int64_t drop_repeats(const kz_saddles_plan *plan, int64_t n, double *cycle) {
  const int64_t stride = 2 + 2 * plan->max_period;
  int64_t kept = 0;
  qsort(cycle, (size_t)n, kz_cycle_bytes(plan), lines_compare);
  for (int64_t i = 0; i < n; i++) {
    const double *mine = cycle + i * stride;
    bool repeated = false;
    for (int64_t j = kept - 1; j >= 0 && !repeated; j--) {
      const double *other = cycle + j * stride;
      if (other[0] != mine[0] || mine[1] - other[1] > ONE) break;
      repeated = is_same(mine, other);
    }
    if (!repeated) memmove(cycle + stride * kept++, mine, kz_cycle_bytes(plan));
  }
  return kept;
}

static kz_status too_many(const kz_saddles_plan *plan, int most, const char *what) {
  return kz_fail(KZ_REFUSED, "saddles.max_period: %lld needs more than %d %s; use a smaller value",
                 (long long)plan->max_period, most, what);
}

static kz_status search_tile(void *context, int64_t tile, void *record) {
  const kz_lines *lines = context;
  uint64_t *bytes = record;
  int64_t work[2], n = kz_lines_search(lines, tile, MOST_STARTS, (double *)(bytes + 1), work);
  if (work[0] > MOST_STARTS) return too_many(lines->plan, MOST_STARTS, "starts on one piece of a line of the search");
  if (n > KZ_CYCLES_OF_A_PIECE)
    return too_many(lines->plan, KZ_CYCLES_OF_A_PIECE, "cycles on one piece of a line of the search");
  n = drop_repeats(lines->plan, n, (double *)(bytes + 1));
  *bytes = sizeof *bytes + (uint64_t)n * kz_cycle_bytes(lines->plan);
  return KZ_OK;
}

/* Receiver of the cycles of pieces. */
typedef struct {
  const kz_saddles_plan *plan;
  kz_found *found;
} collection;

static kz_status lines_take(void *context, int64_t tile, const void *record, size_t bytes) {
  const collection *c = context;
  const size_t one = kz_cycle_bytes(c->plan), before = (size_t)c->found->count * one, more = bytes - sizeof(uint64_t);
  char *longer = kz_realloc(c->found->cycle, before + more);
  (void)tile;
  if (more > 0) memcpy(longer + before, (const char *)record + sizeof(uint64_t), more);
  c->found->cycle = (double *)longer;
  c->found->count += (int64_t)(more / one);
  return KZ_OK;
}

kz_status kz_lines_run(const kz_run *run, const kz_lines *lines, const char *name, kz_found *found) {
  const kz_stage stage = {.name = name,
                          .n_tiles = lines->count * lines->pieces,
                          .record_bytes = kz_piece_bytes(lines->plan),
                          .work = search_tile,
                          .context = (kz_lines *)lines,
                          .keep = true};
  collection all = {lines->plan, found};
  KZ_TRY(kz_stage_gather(run, &stage, "saddles: cycles", lines_take, &all));
  if (kz_rank(run->ranks) == 0) found->count = drop_repeats(lines->plan, found->count, found->cycle);
  return kz_ranks_agree(run->ranks,
                        found->count > KZ_SADDLES_MOST ? too_many(lines->plan, KZ_SADDLES_MOST, "cycles") : KZ_OK);
}
