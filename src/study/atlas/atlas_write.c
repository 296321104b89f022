/* The file's group /atlas, and the summary. */
#include <inttypes.h>

#include "numerics/share.h"
#include "curves.h"
#include "cycles.h"
#include "growth.h"
#include "regions.h"

static const char *const GROUP = "atlas";

enum { CUSP, DEGENERATE_FLIP, DEGENERATE_PITCHFORK };
static const char *const WORDS[KZ_CURVE_KINDS] = {"fold", "period doubling", "symmetry breaking", "swings grow",
                                                  "leans over"};

static int kind_of(const kz_cycle_kind *kind) {
  if (kind->rest) return kind->side > 0 ? KZ_CURVE_REST_SWINGS : KZ_CURVE_REST_LEANS;
  if (kind->multiplier > 0) return KZ_CURVE_FOLD;
  return kind->side > 0 ? KZ_CURVE_PERIOD_DOUBLING : KZ_CURVE_SYMMETRY_BREAKING;
}

/* Centre of a cycle that does not turn: the sign of the mean cosine of its strobe points. */
static int centre_of(const kz_atlas *atlas, const kz_atlas_curve *curve) {
  const kz_cycle_kind *kind = &curve->kind;
  double cosine = 0;
  if (kind->rest) return kind->rest == 2 ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN;
  if (kind->side < 0) return kind->turns ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN;
  if (kind->turns != 0) return KZ_ROTATING;
  if (!kz_atlas_paired(atlas)) return KZ_ABOUT_NEITHER;
  for (int i = 0; i < kind->points; i++) cosine += cos(curve->row->at.point[i][0]);
  return cosine < 0 ? KZ_ABOUT_INVERTED : KZ_ABOUT_DOWN;
}

static int64_t winding_of(const kz_cycle_kind *kind) {
  return kind->side > 0 && !kind->rest ? kind->turns : 0;
}

/* The points of all curves, one after the other. */
typedef struct {
  int64_t n, n_special;
  int64_t *first; /* [curves] */
  const kz_curve_row **row;
  const kz_cycle **special; /* [n], [n_special] */
  int64_t *on;              /* the curves of the latter */
} listing;

static void list_points(const kz_atlas *atlas, listing *l) {
  int64_t n = 0, specials = 0;
  for (int64_t i = 0; i < atlas->n_curves; i++) n += atlas->curve[i].n, specials += atlas->curve[i].n_special;
  *l = (listing){.first = kz_calloc((size_t)atlas->n_curves + 1, sizeof *l->first),
                 .row = kz_calloc((size_t)n + 1, sizeof *l->row),
                 .special = kz_calloc((size_t)specials + 1, sizeof *l->special),
                 .on = kz_calloc((size_t)specials + 1, sizeof *l->on)};
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    const kz_atlas_curve *curve = atlas->curve + i;
    l->first[i] = l->n;
    for (int64_t j = 0; j < curve->n; j++) l->row[l->n++] = curve->row + j;
    for (int64_t j = 0; j < curve->n_special; j++) {
      l->on[l->n_special] = i;
      l->special[l->n_special++] = curve->special + j;
    }
  }
}

static void listing_free(listing *l) {
  free(l->first);
  free(l->row);
  free(l->special);
  free(l->on);
}

/* The value at a place of the search along an axis of the file. */
static double atlas_write_at(const kz_atlas *atlas, const double *place, int axis) {
  double value[2];
  kz_atlas_values(atlas->scene->atlas, place, value);
  return value[kz_atlas_axis(atlas, axis)];
}

#define COLUMN(type, name, n, expression) KZ_COLUMN(store, "atlas", name, n, type, expression)

/* Texts that a function makes. */
typedef void (*text_fn)(const kz_atlas *atlas, int64_t i, char *text);
static kz_status write_texts(const kz_atlas *atlas, const char *name, int64_t n, text_fn make, kz_store *store) {
  KZ_AUTOFREE char (*text)[2 * KZ_NAME_LENGTH] = kz_calloc((size_t)n + 1, sizeof *text);
  for (int64_t i = 0; i < n; i++) make(atlas, i, text[i]);
  COLUMN(const char *, name, n, text[i]);
  return KZ_OK;
}

static void name_curve(const kz_atlas *atlas, int64_t i, char *text) {
  const kz_atlas_class class = kz_atlas_class_of(&atlas->curve[i].kind);
  char name[KZ_NAME_LENGTH];
  kz_atlas_class_name(atlas, &class, name);
  snprintf(text, 2 * KZ_NAME_LENGTH, "%s: %s", name, WORDS[kind_of(&atlas->curve[i].kind)]);
}

static void name_class(const kz_atlas *atlas, int64_t i, char *text) {
  kz_atlas_class_name(atlas, atlas->class + i, text);
}

static kz_status write_curves(const kz_atlas *atlas, const listing *l, kz_store *store) {
  const kz_atlas_curve *c = atlas->curve;
  KZ_TRY(kz_store_dimension(store, GROUP, "curve", atlas->n_curves, NULL));
  COLUMN(int8_t, "curve_kind", atlas->n_curves, kind_of(&c[i].kind));
  COLUMN(int16_t, "curve_period", atlas->n_curves, kz_kind_period(&c[i].kind));
  COLUMN(int32_t, "curve_winding", atlas->n_curves, winding_of(&c[i].kind));
  COLUMN(int8_t, "curve_centre", atlas->n_curves, centre_of(atlas, c + i));
  COLUMN(int8_t, "curve_symmetric", atlas->n_curves, c[i].kind.rest || c[i].kind.side < 0);
  COLUMN(int32_t, "curve_first", atlas->n_curves, l->first[i]);
  COLUMN(int32_t, "curve_points", atlas->n_curves, c[i].n);
  COLUMN(int8_t, "curve_closed", atlas->n_curves, c[i].ending[1] == KZ_TRACE_CLOSED);
  COLUMN(int8_t, "curve_open", atlas->n_curves, kz_atlas_open_ends(c + i));
  return write_texts(atlas, "curve_name", atlas->n_curves, name_curve, store);
}

static kz_status write_points(const kz_atlas *atlas, const listing *l, kz_store *store) {
  KZ_TRY(kz_store_dimension(store, GROUP, "point", l->n, NULL));
  COLUMN(double, "x", l->n, atlas_write_at(atlas, l->row[i]->at.place, 0));
  COLUMN(double, "y", l->n, atlas_write_at(atlas, l->row[i]->at.place, 1));
  COLUMN(double, "strobe_theta", l->n, remainder(l->row[i]->at.point[0][0], 2 * M_PI));
  COLUMN(double, "strobe_velocity", l->n, l->row[i]->at.point[0][1]);
  COLUMN(double, "normal_form", l->n, l->row[i]->form.coefficient);
  COLUMN(double, "side_x", l->n, l->row[i]->form.side[kz_atlas_axis(atlas, 0)]);
  COLUMN(double, "side_y", l->n, l->row[i]->form.side[kz_atlas_axis(atlas, 1)]);
  COLUMN(double, "tangent_x", l->n, l->row[i]->tangent[kz_atlas_axis(atlas, 0)]);
  COLUMN(double, "tangent_y", l->n, l->row[i]->tangent[kz_atlas_axis(atlas, 1)]);
  COLUMN(int8_t, "supercritical", l->n, l->row[i]->at.kind.multiplier < 0 && l->row[i]->form.coefficient > 0);
  KZ_TRY(kz_store_dimension(store, GROUP, "special", l->n_special, NULL));
  COLUMN(double, "special_x", l->n_special, atlas_write_at(atlas, l->special[i]->place, 0));
  COLUMN(double, "special_y", l->n_special, atlas_write_at(atlas, l->special[i]->place, 1));
  COLUMN(int8_t, "special_kind", l->n_special,
         l->special[i]->kind.multiplier > 0                          ? CUSP
         : kind_of(&l->special[i]->kind) == KZ_CURVE_PERIOD_DOUBLING ? DEGENERATE_FLIP
                                                                     : DEGENERATE_PITCHFORK);
  COLUMN(int32_t, "special_curve", l->n_special, l->on[i]);
  return KZ_OK;
}

static double middle_of(const kz_atlas *atlas, int64_t i, int axis) {
  const double share = ((double)i + 0.5) / (double)atlas->scene->atlas->points, place[2] = {share, share};
  return atlas_write_at(atlas, place, axis);
}

static double region_middle(const kz_atlas *atlas, const kz_atlas_raster *r, int64_t region, int axis) {
  double place[2];
  kz_atlas_region_place(r, region, place);
  return atlas_write_at(atlas, place, axis);
}

/* Writes layers of cells, each [y][x] of the search. */
static kz_status write_cells(const kz_atlas *atlas, const char *name, int64_t layers, int64_t n, size_t bytes,
                             const void *cells, kz_store *store) {
  if (!atlas->swapped) return kz_store_variable(store, GROUP, name, cells);
  KZ_AUTOFREE char *exchanged = kz_malloc((size_t)(layers * n * n) * bytes + 1);
  for (int64_t i = 0; i < layers * n * n; i++) {
    const int64_t layer = i / (n * n), row = i / n % n, column = i % n;
    memcpy(exchanged + (size_t)i * bytes, (const char *)cells + (size_t)((layer * n + column) * n + row) * bytes,
           bytes);
  }
  return kz_store_variable(store, GROUP, name, exchanged);
}

static kz_status write_raster(const kz_atlas *atlas, const kz_atlas_raster *r, kz_store *store) {
  const int64_t n = r->points;
  KZ_TRY(kz_store_dimension(store, GROUP, "class", r->n_classes, NULL));
  KZ_TRY(write_texts(atlas, "class_name", r->n_classes, name_class, store));
  COLUMN(int16_t, "class_period", r->n_classes, atlas->class[i].period);
  COLUMN(int32_t, "class_winding", r->n_classes, kz_atlas_described(atlas, atlas->class + i).winding);
  COLUMN(int8_t, "class_centre", r->n_classes, kz_atlas_class_centre(atlas->class + i));
  COLUMN(int8_t, "class_symmetric", r->n_classes, atlas->class[i].symmetric);
  KZ_SCALE(store, GROUP, "row", n, middle_of(atlas, i, 1));
  KZ_SCALE(store, GROUP, "column", n, middle_of(atlas, i, 0));
  KZ_TRY(write_cells(atlas, "attracting", r->n_classes, n, sizeof *r->attracting, r->attracting, store));
  KZ_TRY(write_cells(atlas, "count", 1, n, sizeof *r->count, r->count, store));
  KZ_TRY(write_cells(atlas, "list", 1, n, sizeof *r->list, r->list, store));
  KZ_TRY(kz_store_dimension(store, GROUP, "region", r->n_regions, NULL));
  COLUMN(double, "region_x", r->n_regions, region_middle(atlas, r, i, 0));
  COLUMN(double, "region_y", r->n_regions, region_middle(atlas, r, i, 1));
  COLUMN(double, "region_share", r->n_regions, (double)r->region[i].cells / (double)(n * n));
  COLUMN(double, "region_radius", r->n_regions, r->region[i].radius / (double)n);
  if (!r->hits) return KZ_OK;
  const double starts = (double)atlas->scene->atlas->shares;
  COLUMN(double, "region_fraction", r->n_regions * r->n_classes, (double)r->hits[i] / starts);
  COLUMN(double, "region_other", r->n_regions, (double)r->other[i] / starts);
  return KZ_OK;
}

static int64_t open_ends(const kz_atlas *atlas) {
  int64_t open = 0;
  for (int64_t i = 0; i < atlas->n_curves; i++) open += kz_atlas_open_ends(atlas->curve + i);
  return open;
}

static kz_status write_attributes(const kz_atlas *atlas, const kz_atlas_raster *raster, kz_store *store) {
  const kz_plane_axis *axis[] = {&atlas->scene->atlas->x, &atlas->scene->atlas->y};
  const kz_share wrong = kz_share_of(atlas->disagreed, atlas->checked),
                 missing = kz_share_of(atlas->unsolved, atlas->listed);
  for (int i = 0; i < 2; i++) {
    const kz_plane_axis *of = axis[kz_atlas_axis(atlas, i)];
    KZ_TRY(kz_axis_describe(&of->values, of->parameter, i ? "y" : "x", GROUP, store));
  }
  KZ_TRY(kz_store_integer(store, GROUP, "max_period", atlas->scene->atlas->max_period));
  KZ_TRY(kz_store_integer(store, GROUP, "mirrored", kz_atlas_paired(atlas)));
  KZ_TRY(kz_store_integer(store, GROUP, "lists", raster->lists));
  KZ_TRY(kz_store_integer(store, GROUP, "negative", raster->negative));
  KZ_TRY(kz_store_integer(store, GROUP, "checked", atlas->checked));
  KZ_TRY(kz_store_integer(store, GROUP, "disagreed", atlas->disagreed));
  KZ_TRY(kz_store_integer(store, GROUP, "listed", atlas->listed));
  KZ_TRY(kz_store_integer(store, GROUP, "unsolved", atlas->unsolved));
  KZ_TRY(kz_store_integer(store, GROUP, "open_ends", open_ends(atlas)));
  KZ_TRY(kz_store_integer(store, GROUP, "refused_no_point", atlas->refused[KZ_ATLAS_NO_POINT]));
  KZ_TRY(kz_store_integer(store, GROUP, "refused_too_thin", atlas->refused[KZ_ATLAS_TOO_THIN]));
  KZ_TRY(kz_store_integer(store, GROUP, "refused_of_shorter", atlas->refused[KZ_ATLAS_OF_SHORTER]));
  if (atlas->compared > 0) KZ_TRY(kz_store_integer(store, GROUP, "compared", atlas->compared));
  if (atlas->compared > 0) KZ_TRY(kz_store_integer(store, GROUP, "alone", atlas->alone));
  if (atlas->checked == 0) return KZ_OK;
  KZ_TRY(kz_store_real(store, GROUP, "unsolved_high", missing.high));
  return kz_store_real(store, GROUP, "disagreed_high", wrong.high);
}

static void atlas_write_print(const kz_atlas *atlas, const kz_atlas_raster *r, const listing *l, FILE *summary) {
  const int32_t parameter[] = {atlas->scene->atlas->x.parameter, atlas->scene->atlas->y.parameter};
  int64_t kinds[KZ_CURVE_KINDS] = {0}, most = 0;
  for (int64_t i = 0; i < atlas->n_curves; i++) kinds[kind_of(&atlas->curve[i].kind)]++;
  for (int64_t i = 0; i < r->points * r->points; i++)
    if (r->count[i] > most) most = r->count[i];
  fprintf(summary, "atlas: %s x %s, cycles of up to %" PRId64 " periods: %" PRId64 " curves (%" PRId64 " points)\n",
          kz_sweep_parameter_at(parameter[atlas->swapped])->name,
          kz_sweep_parameter_at(parameter[1 - atlas->swapped])->name, atlas->scene->atlas->max_period, atlas->n_curves,
          l->n);
  fprintf(summary,
          "  folds %" PRId64 ", period doublings %" PRId64 ", symmetry breakings %" PRId64 ", of rest %" PRId64 "\n",
          kinds[KZ_CURVE_FOLD], kinds[KZ_CURVE_PERIOD_DOUBLING], kinds[KZ_CURVE_SYMMETRY_BREAKING],
          kinds[KZ_CURVE_REST_SWINGS] + kinds[KZ_CURVE_REST_LEANS]);
  fprintf(summary,
          "  %" PRId64 " lists of attractors in %" PRId64 " x %" PRId64 " cells, up to %" PRId64
          " attractors at once\n",
          r->lists, r->points, r->points, most);
  if (r->negative > 0)
    fprintf(summary, "  warning: %" PRId64 " cells lie beyond a curve that is missing; their lists are not known\n",
            r->negative);
  if (open_ends(atlas) > 0)
    fprintf(summary,
            "  warning: %" PRId64
            " ends of curves lie within the plane without a reason; lists beside them may be wrong\n",
            open_ends(atlas));
  if (atlas->compared > 0)
    fprintf(summary, "  of %" PRId64 " crossings of lines at k, %" PRId64 " have no image at -k%s\n", atlas->compared,
            atlas->alone, atlas->alone > 0 ? ": a curve is missing there" : "");
  if (atlas->checked > 0)
    fprintf(summary,
            "  checked: %" PRId64 " random points in the last of %" PRId64 " rounds, %" PRId64
            " with an attractor that no curve predicts (share at most %.2g)\n",
            atlas->checked, atlas->rounds, atlas->disagreed, kz_share_of(atlas->disagreed, atlas->checked).high);
  if (atlas->listed > 0)
    fprintf(summary,
            "  of %" PRId64 " motions in the lists of these points, %" PRId64
            " could not be solved for (share at most %.2g)\n",
            atlas->listed, atlas->unsolved, kz_share_of(atlas->unsolved, atlas->listed).high);
}

kz_status kz_atlas_write(kz_atlas *atlas, const kz_atlas_raster *raster, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(listing_free) listing l = {0};
  list_points(atlas, &l);
  KZ_TRY(write_attributes(atlas, raster, store));
  KZ_TRY(write_curves(atlas, &l, store));
  KZ_TRY(write_points(atlas, &l, store));
  KZ_TRY(write_raster(atlas, raster, store));
  atlas_write_print(atlas, raster, &l, summary);
  return kz_atlas_write_tally(atlas, store, summary);
}
