/* An atlas from its result file: the curves, and what attracts at one place. */
#include "curves.h"
#include "cycles.h"
#include "regions.h"

static const char *const GROUP = "atlas";

/* The numbers of a variable, which the caller frees. */
static kz_status atlas_read_columns(kz_store *store, const char *name, int64_t n, double **values) {
  *values = kz_malloc((size_t)(n + 1) * sizeof **values);
  return kz_store_numbers(store, GROUP, name, n, *values);
}

/* Variables of one dimension, one after the other. */
enum { MOST_COLUMNS = 10 };
typedef struct {
  double *of[MOST_COLUMNS];
} columns;

static void columns_free(columns *c) {
  for (int i = 0; i < MOST_COLUMNS; i++) free(c->of[i]);
}

static kz_status read_columns(kz_store *store, int n_names, const char *const *name, int64_t n, columns *c) {
  for (int i = 0; i < n_names; i++) KZ_TRY(atlas_read_columns(store, name[i], n, c->of + i));
  return KZ_OK;
}

enum { KIND, PERIOD, WINDING, CENTRE, SYMMETRIC, FIRST, POINTS, CLOSED, CURVE_COLUMNS };
static const char *const CURVE[CURVE_COLUMNS] = {"curve_kind",      "curve_period", "curve_winding", "curve_centre",
                                                 "curve_symmetric", "curve_first",  "curve_points",  "curve_closed"};
enum { X, Y, THETA, VELOCITY, FORM, SIDE_X, SIDE_Y, TANGENT_X, TANGENT_Y, POINT_COLUMNS };
static const char *const POINT[POINT_COLUMNS] = {"x",      "y",      "strobe_theta", "strobe_velocity", "normal_form",
                                                 "side_x", "side_y", "tangent_x",    "tangent_y"};

static kz_cycle_kind kind_of(const columns *c, int64_t i) {
  const int kind = (int)c->of[KIND][i], period = (int)c->of[PERIOD][i],
            inverted = c->of[CENTRE][i] == KZ_ABOUT_INVERTED;
  const bool symmetric = c->of[SYMMETRIC][i] != 0;
  if (kind == KZ_CURVE_REST_SWINGS) return (kz_cycle_kind){1, 1, -1, 0, 0, 0, 1 + inverted};
  if (kind == KZ_CURVE_REST_LEANS) return (kz_cycle_kind){-1, 1, -1, inverted, 0, 0, 1 + inverted};
  return (kz_cycle_kind){.side = symmetric ? -1 : 1,
                         .points = symmetric ? (period + 1) / 2 : period,
                         .multiplier = kind == KZ_CURVE_FOLD ? 1 : -1,
                         .turns = symmetric ? inverted : (int32_t)c->of[WINDING][i],
                         .half = symmetric && period % 2};
}

/* Reads the first point of each cycle, from which the others are completed. */
static kz_status read_rows(const kz_atlas *atlas, const columns *points, int64_t first, int64_t n_points,
                           kz_atlas_curve *curve) {
  const kz_axis *axis[] = {&atlas->scene->atlas->x.values, &atlas->scene->atlas->y.values};
  const int32_t cycle_points = curve->kind.points;
  if (cycle_points < 1 || cycle_points > KZ_CURVE_POINTS || first < 0 || curve->n < 0 || first + curve->n > n_points)
    return kz_fail(KZ_REFUSED, "the atlas of the result file is damaged");
  curve->row = kz_calloc((size_t)curve->n + 1, sizeof *curve->row);
  for (int64_t i = 0; i < curve->n; i++) {
    kz_curve_row *row = curve->row + i;
    row->at.kind = curve->kind;
    for (int c = 0; c < 2; c++) {
      const int of = kz_atlas_axis(atlas, c);
      row->at.place[c] = (points->of[X + of][first + i] - axis[c]->min) / (axis[c]->max - axis[c]->min);
      row->tangent[c] = points->of[TANGENT_X + of][first + i];
      row->form.side[c] = points->of[SIDE_X + of][first + i];
      row->at.point[0][c] = points->of[THETA + c][first + i];
    }
    row->form.coefficient = points->of[FORM][first + i];
  }
  return KZ_OK;
}

static kz_status read_curves(kz_atlas *atlas, kz_store *store) {
  KZ_AUTOFREE_BY(columns_free) columns curves = {0}, points = {0};
  int64_t n, n_points;
  KZ_TRY(kz_store_length(store, GROUP, "curve", &n));
  KZ_TRY(kz_store_length(store, GROUP, "point", &n_points));
  KZ_TRY(read_columns(store, CURVE_COLUMNS, CURVE, n, &curves));
  KZ_TRY(read_columns(store, POINT_COLUMNS, POINT, n_points, &points));
  atlas->curve = kz_calloc((size_t)(n + 1), sizeof *atlas->curve);
  for (int64_t i = 0; i < n; i++) {
    kz_atlas_curve *curve = atlas->curve + i;
    const int32_t ending = curves.of[CLOSED][i] != 0 ? KZ_TRACE_CLOSED : KZ_TRACE_LEFT;
    *curve =
        (kz_atlas_curve){.kind = kind_of(&curves, i), .ending = {ending, ending}, .n = (int64_t)curves.of[POINTS][i]};
    atlas->n_curves++;
    KZ_TRY(read_rows(atlas, &points, (int64_t)curves.of[FIRST][i], n_points, curve));
  }
  return KZ_OK;
}

/* The first cell whose list is known, row and column; the first one if there is none. */
static kz_status find_known(const kz_atlas *atlas, kz_store *store, int64_t cell[2]) {
  const int64_t points = atlas->scene->atlas->points;
  for (int64_t i = 0; i < points * points; i++) {
    double list;
    KZ_TRY(kz_store_number(store, GROUP, "list", (int64_t[]){i / points, i % points}, &list));
    if (list < 0) continue;
    cell[0] = i / points, cell[1] = i % points;
    break;
  }
  return KZ_OK;
}

/* Reads the classes in the order of the file, and their counts in a cell: negative where no cell is known. */
static kz_status read_classes(kz_atlas *atlas, kz_store *store) {
  enum { OF_PERIOD, OF_WINDING, OF_CENTRE, OF_SYMMETRY, CLASS_COLUMNS };
  static const char *const name[] = {"class_period", "class_winding", "class_centre", "class_symmetric"};
  KZ_AUTOFREE_BY(columns_free) columns c = {0};
  int64_t n, cell[2] = {0};
  KZ_TRY(find_known(atlas, store, cell));
  KZ_TRY(kz_store_length(store, GROUP, "class", &n));
  KZ_TRY(read_columns(store, CLASS_COLUMNS, name, n, &c));
  for (int64_t i = 0; i < n && i < KZ_ATLAS_MOST_CLASSES; i++) {
    double count;
    const kz_atlas_class class = kz_atlas_class_with(c.of[OF_SYMMETRY][i] != 0, (int32_t)c.of[OF_PERIOD][i],
                                                     (int32_t)c.of[OF_WINDING][i], (int32_t)c.of[OF_CENTRE][i]);
    KZ_TRY(kz_store_number(store, GROUP, "attracting", (int64_t[]){i, cell[0], cell[1]}, &count));
    atlas->at_reference[kz_atlas_class_number(atlas, &class)] = (int32_t)(count == KZ_ATLAS_NOT_KNOWN ? -count : count);
  }
  for (int i = 0; i < 2; i++)
    atlas->reference[i] = ((double)cell[1 - kz_atlas_axis(atlas, i)] + 0.5) / (double)atlas->scene->atlas->points;
  return KZ_OK;
}

kz_status kz_atlas_open(const kz_scene *scene, kz_store *store, kz_atlas **atlas) {
  *atlas = NULL;
  if (!scene->has_atlas) return kz_fail(KZ_REFUSED, "the result file has no study atlas");
  *atlas = kz_calloc(1, sizeof **atlas);
  kz_status status = kz_atlas_begin(scene, *atlas);
  if (status == KZ_OK) status = read_curves(*atlas, store);
  if (status == KZ_OK) status = read_classes(*atlas, store);
  if (status == KZ_OK) return KZ_OK;
  kz_atlas_close(*atlas);
  *atlas = NULL;
  return status;
}

void kz_atlas_close(kz_atlas *atlas) {
  if (atlas) kz_atlas_end(atlas);
  free(atlas);
}
