#include "boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/cells.h"
#include "labelling/labeller.h"
#include "numerics/share.h"
#include "labelling/starts.h"

enum {
  MOST = KZ_BOUNDARY_MOST_DECADES + 1, /* distances, from 1e-2 rad down */
  STARTS = 64,                         /* of a tile, each with a partner at every distance */
  POINTS = STARTS * (1 + MOST),
  STRIP = 1 << (KZ_BOX_LEVELS - 1),
  SHOWN = 4 /* the level of boxes that the summary shows: 16 cells */
};
/* A basin holds all of the boundary where it is in so many of the boxes. */
static const double ALL = 0.99;

typedef struct {
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
} pairing;

typedef struct {
  int64_t pairs[MOST], uncertain[MOST];
} pair_record;

/* The starts of a tile and their partners, and where they end. */
typedef struct {
  kz_start start[POINTS];
  double plain[2 * POINTS];
  int32_t end[POINTS];
  int64_t periods[POINTS];
  kz_decision decision[POINTS];
} pair_room;

static double distance_of(int d) {
  return pow(10, -2 - d);
}

static int distances_of(const kz_basin_plan *plan) {
  return (int)plan->boundary.decades + 1;
}

/* The point so large shares of the window from its lower left corner, and a distance more. */
static void put(const kz_basin_plan *plan, const double share[2], const double offset[2], pair_room *r, int64_t i) {
  const kz_axis *const axes[] = {&plan->theta, &plan->velocity};
  r->start[i] = (kz_start){.periods = 0};
  for (int axis = 0; axis < 2; axis++)
    kz_axis_at(axes[axis], share[axis], offset[axis], axis == 0 ? r->start[i].theta : r->start[i].velocity);
}

/* Start i of an evenly spread sequence (M. Roberts' R2) and its partners, in directions that spread evenly too, from place `first` on. */
static void spread(const kz_basin_plan *plan, int64_t i, pair_room *r, int64_t first) {
  const double share[] = {fmod(0.5 + (double)i * 0.75487766624669276, 1), fmod(0.5 + (double)i * 0.56984029099805327, 1)},
               angle = 2 * M_PI * fmod((double)i * 0.61803398874989484820, 1);
  put(plan, share, (const double[2]){0, 0}, r, first);
  for (int d = 0; d < distances_of(plan); d++)
    put(plan, share, (const double[2]){distance_of(d) * cos(angle), distance_of(d) * sin(angle)}, r, first + 1 + d);
}

/* By the method's own labels: with their errors, or by integration. What no level decides is followed in quad precision without regard to
 * its error: that is an error of the start, far below the smallest distance. Left out, such pairs would be missed among the uncertain. */
static kz_status follow(const pairing *p, int64_t n, pair_room *r) {
  const kz_labeller labeller = {
      .dynamics = p->dynamics, .max_periods = p->plan->max_periods, .start = kz_start_of_array, .context = r->start};
  if (p->plan->method != KZ_METHOD_EXACT) {
    for (int64_t i = 0; i < n; i++) memcpy(r->plain + 2 * i, (double[]){r->start[i].theta[0], r->start[i].velocity[0]}, 16);
    kz_follow_starts(p->dynamics, p->plan->max_periods, n, r->plain, r->end, r->periods);
    return KZ_OK;
  }
  KZ_TRY(kz_label(&labeller, n, NULL, r->decision));
  for (int64_t i = 0; i < n; i++) {
    const kz_start *s = r->start + i;
    r->end[i] = r->decision[i].label;
    if (r->end[i] == KZ_DOUBTFUL)
      kz_dynamics_follow_reference(p->dynamics, KZ_REFERENCE_STEPS, 1, p->plan->max_periods,
                                   (double[]){s->theta[0], s->velocity[0]}, (double[]){s->theta[1], s->velocity[1]}, r->end + i,
                                   r->periods + i);
  }
  return KZ_OK;
}

static kz_status pair_tile(void *context, int64_t tile, void *record) {
  const pairing *p = context;
  pair_record *out = record;
  pair_room *r = kz_malloc(sizeof *r);
  const int distances = distances_of(p->plan), stride = 1 + distances;
  for (int64_t i = 0; i < STARTS; i++) spread(p->plan, tile * STARTS + i, r, stride * i);
  const kz_status status = follow(p, (int64_t)STARTS * stride, r);
  for (int64_t i = 0; status == KZ_OK && i < STARTS; i++)
    for (int d = 0; d < distances; d++) {
      const int32_t own = r->end[stride * i], other = r->end[stride * i + 1 + d];
      out->pairs[d] += own > 0 && other > 0;
      out->uncertain[d] += own > 0 && other > 0 && own != other;
    }
  free(r);
  return status;
}

static kz_stage stage_of(pairing *p) {
  return (kz_stage){.name = "pairs",
                    .n_tiles = (p->plan->boundary.pairs + STARTS - 1) / STARTS,
                    .record_bytes = sizeof(pair_record),
                    .work = pair_tile,
                    .context = p,
                    .keep = true,
                    .everywhere = true};
}

kz_status kz_boundary_measure(const kz_basin_plan *plan, kz_dynamics *dynamics, double *seconds) {
  pairing p = {plan, dynamics};
  const kz_stage stage = stage_of(&p);
  return plan->has_boundary ? kz_stage_measure(&stage, 16, 0.5, seconds) : KZ_OK;
}

static kz_status count_pairs(const kz_basin_plan *plan, const kz_window_labels *labelling, kz_uncertain *uncertain) {
  pairing p = {plan, labelling->dynamics};
  const kz_stage stage = stage_of(&p);
  pair_record *records = kz_malloc((size_t)stage.n_tiles * sizeof *records);
  kz_status status = kz_stage_run(labelling->run, &stage, records);
  for (int d = 0; d < distances_of(plan); d++) {
    uncertain[d] = (kz_uncertain){.distance = distance_of(d)};
    for (int64_t tile = 0; status == KZ_OK && tile < stage.n_tiles; tile++) {
      uncertain[d].pairs += records[tile].pairs[d];
      uncertain[d].uncertain += records[tile].uncertain[d];
    }
  }
  free(records);
  return status;
}

static kz_status write_pairs(int n, const kz_uncertain *u, kz_store *store, FILE *summary) {
  kz_slope slope[MOST];
  double distance[MOST];
  const kz_slope whole = kz_uncertainty_slopes(n, u, slope);
  slope[n - 1] = (kz_slope){NAN, NAN, NAN, NAN, NAN};
  for (int d = 0; d < n; d++) distance[d] = distance_of(d);
  KZ_TRY(kz_store_dimension(store, "boundary", "distance", n, distance));
#define COLUMN(name, expression) KZ_COLUMN(store, "boundary", name, n, double, expression)
  COLUMN("uncertain_share", kz_share_of(u[i].uncertain, u[i].pairs).share);
  COLUMN("uncertain_low", kz_share_of(u[i].uncertain, u[i].pairs).low);
  COLUMN("uncertain_high", kz_share_of(u[i].uncertain, u[i].pairs).high);
  COLUMN("slope", slope[i].slope);
  COLUMN("slope_low", slope[i].low);
  COLUMN("slope_high", slope[i].high);
  KZ_TRY(kz_store_integer(store, "boundary", "pairs", u[0].pairs));
  KZ_TRY(kz_store_real(store, "boundary", "uncertainty_exponent", whole.slope));
  KZ_TRY(kz_store_real(store, "boundary", "uncertainty_exponent_low", whole.low));
  KZ_TRY(kz_store_real(store, "boundary", "uncertainty_exponent_high", whole.high));
  KZ_TRY(kz_store_real(store, "boundary", "nearest", whole.near));
  if (isnan(whole.slope))
    fprintf(summary, "boundary: too few pairs are uncertain for an exponent\n");
  else
    fprintf(summary, "boundary: uncertainty exponent %.4f (95 %%: %.4f to %.4f) over distances from %.0e to %.0e rad\n",
            whole.slope, whole.low, whole.high, whole.near, whole.far);
  return KZ_OK;
}

/* Boxes of all cells, strip by strip from the file. */
static kz_status count_boxes(const kz_basin_plan *plan, kz_store *store, kz_box_counts *counts) {
  const int64_t columns = plan->theta.count, rows = plan->velocity.count;
  int16_t *label = kz_malloc((size_t)((STRIP + 1) * columns) * sizeof *label);
  kz_status status = KZ_OK;
  for (int64_t row = 0; status == KZ_OK && row + 1 < rows; row += STRIP) {
    const int64_t n = rows - row < STRIP + 1 ? rows - row : STRIP + 1;
    status = kz_store_rows(store, "basin", "attractor", row, n, label);
    if (status == KZ_OK) status = kz_boxes_count(columns, n, label, counts);
  }
  free(label);
  return status;
}

/* Basins in nearly every box of the boundary, on one scale. */
static void print_shared(const kz_box_counts *b, int64_t basins, FILE *summary) {
  int64_t all = 0;
  fprintf(summary, "boundary: box-counting dimension %.4f over boxes of 4 to 64 cells",
          (kz_boxes_dimension(b, 2) + kz_boxes_dimension(b, 3) + kz_boxes_dimension(b, 4) + kz_boxes_dimension(b, 5)) / 4);
  for (int64_t i = 0; i < basins; i++) {
    if (b->boxes[SHOWN] == 0 || (double)b->with[SHOWN][i] < ALL * (double)b->boxes[SHOWN]) continue;
    fprintf(summary, "%s%lld", all == 0 ? "; basins in 99 % of its boxes of 16 cells: " : ", ", (long long)i);
    all++;
  }
  fprintf(summary, "%s\n", all > 2 ? " (Wada)" : all > 0 ? "" : "; no basin is in 99 % of its boxes of 16 cells");
}

static kz_status write_boxes(const kz_box_counts *b, int64_t count, kz_store *store, FILE *summary) {
  const int64_t basins = count < KZ_BOX_LABELS ? count : KZ_BOX_LABELS;
  KZ_TRY(kz_store_dimension(store, "boundary", "box", KZ_BOX_LEVELS, NULL));
  KZ_TRY(kz_store_dimension(store, "boundary", "basin", basins, NULL));
  KZ_COLUMN(store, "boundary", "box_cells", KZ_BOX_LEVELS, int32_t, 1 << i);
  KZ_COLUMN(store, "boundary", "boxes", KZ_BOX_LEVELS, int32_t, b->boxes[i]);
  KZ_COLUMN(store, "boundary", "dimension", KZ_BOX_LEVELS, double, i + 1 < KZ_BOX_LEVELS ? kz_boxes_dimension(b, (int)i) : NAN);
  KZ_COLUMN(store, "boundary", "shared", KZ_BOX_LEVELS * basins, double,
            b->boxes[i / basins] > 0 ? (double)b->with[i / basins][i % basins] / (double)b->boxes[i / basins] : NAN);
  if (b->boxes[2] > 0) print_shared(b, basins, summary);
  return KZ_OK;
}

kz_status kz_boundary_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                           kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = &scene->basin;
  kz_uncertain uncertain[MOST];
  kz_box_counts counts = {0};
  if (!plan->has_boundary) return KZ_OK;
  KZ_TRY(count_pairs(plan, labelling, uncertain));
  kz_status status = KZ_OK;
  if (store) {
    status = write_pairs(distances_of(plan), uncertain, store, summary);
    if (status == KZ_OK) status = count_boxes(plan, store, &counts);
    if (status == KZ_OK) status = write_boxes(&counts, catalogue->count, store, summary);
  }
  return kz_ranks_agree(labelling->run->ranks, status);
}
