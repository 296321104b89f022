/* Measures of how fractal the boundaries of a basin are: pairs of starts, boxes of cells. */
#include "boundary.h"

enum {
  STRIP = 1 << (KZ_BOX_SIZES - 1),
  SHOWN = 4 /* the size of boxes that the summary shows: 16 cells */
};
/* A basin has all of the boundary if it is in at least this share of the boxes. */
static const double ALL = 0.99;

static kz_status write_pairs(int n, const kz_uncertain *u, kz_store *store, FILE *summary) {
  kz_slope slope[KZ_PAIR_DISTANCES];
  const kz_slope whole = kz_uncertainty_slopes(n, u, slope);
  slope[n - 1] = (kz_slope){NAN, NAN, NAN, NAN, NAN};
  KZ_SCALE(store, "boundary", "distance", n, u[i].distance);
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
  KZ_AUTOFREE int16_t *label = kz_malloc((size_t)((STRIP + 1) * columns) * sizeof *label);
  kz_status status = KZ_OK;
  for (int64_t row = 0; status == KZ_OK && row + 1 < rows; row += STRIP) {
    const int64_t n = rows - row < STRIP + 1 ? rows - row : STRIP + 1;
    status = kz_store_rows(store, "basin", "attractor", row, n, label);
    if (status == KZ_OK) kz_boxes_count(columns, n, label, kz_box_sizes(columns, rows), counts);
  }
  return status;
}

/* Basins in nearly every box of the boundary, on one scale. */
static void print_shared(const kz_box_counts *b, int64_t basins, FILE *summary) {
  const double dimension =
      (kz_boxes_dimension(b, 2) + kz_boxes_dimension(b, 3) + kz_boxes_dimension(b, 4) + kz_boxes_dimension(b, 5)) / 4;
  int64_t all = 0;
  if (isnan(dimension))
    fprintf(summary, "boundary: too few cells for a box-counting dimension");
  else
    fprintf(summary, "boundary: box-counting dimension %.4f over boxes of 4 to 64 cells", dimension);
  for (int64_t i = 0; i < basins; i++) {
    if (b->boxes[SHOWN] == 0 || (double)b->with[SHOWN][i] < ALL * (double)b->boxes[SHOWN]) continue;
    fprintf(summary, "%s%lld", all == 0 ? "; basins in 99 % of its boxes of 16 cells: " : ", ", (long long)i);
    all++;
  }
  fprintf(summary, "%s\n", all > 2 ? " (Wada)" : all > 0 ? "" : "; no basin is in 99 % of its boxes of 16 cells");
}

static kz_status write_boxes(const kz_box_counts *b, int64_t count, kz_store *store, FILE *summary) {
  const int64_t basins = kz_smaller(count, KZ_BOX_LABELS);
  KZ_TRY(kz_store_dimension(store, "boundary", "box", KZ_BOX_SIZES, NULL));
  KZ_TRY(kz_store_dimension(store, "boundary", "basin", basins, NULL));
  KZ_COLUMN(store, "boundary", "box_cells", KZ_BOX_SIZES, int32_t, 1 << i);
  KZ_COLUMN(store, "boundary", "boxes", KZ_BOX_SIZES, int32_t, b->boxes[i]);
  KZ_COLUMN(store, "boundary", "dimension", KZ_BOX_SIZES, double,
            i + 1 < KZ_BOX_SIZES ? kz_boxes_dimension(b, (int)i) : NAN);
  KZ_COLUMN(store, "boundary", "shared", KZ_BOX_SIZES * basins, double,
            b->boxes[i / basins] > 0 ? (double)b->with[i / basins][i % basins] / (double)b->boxes[i / basins] : NAN);
  if (b->boxes[2] > 0) print_shared(b, basins, summary);
  return KZ_OK;
}

static kz_status boundary_find(void *own, const kz_chunks *chunks, kz_store *store, FILE *summary) {
  const kz_scene *scene = own;
  kz_uncertain uncertain[KZ_PAIR_DISTANCES];
  kz_box_counts counts = {0};
  KZ_TRY(kz_pairs_count(scene->boundary, chunks->labelling, uncertain));
  kz_status status = KZ_OK;
  if (store) {
    status = write_pairs(kz_distances_of(scene->boundary), uncertain, store, summary);
    if (status == KZ_OK) status = count_boxes(scene->basin, store, &counts);
    if (status == KZ_OK) status = write_boxes(&counts, chunks->catalogue->count, store, summary);
  }
  return kz_ranks_agree(chunks->labelling->run->ranks, status);
}

const kz_basin_part kz_boundary_part = {.find = boundary_find};
