/* Inside of the study `atlas`: curves of bifurcations over a plane of two keys, and the attractors of every point of it.
 *
 * A place is (x, y) in units of the rectangle: 0 at the first value of a key, 1 at the last. */
#pragma once

#include <math.h>

#include "kapitza/dynamics.h"
#include "kapitza/dynamics_trace.h"
#include "kapitza/study.h"
#include "kapitza/study_atlas.h"
#include "numerics/parent.h"
#include "plan.h"

/* Longest step of branches along a line, in sides of the plane. */
#define KZ_ATLAS_BRANCH_STEP 0.03
enum { KZ_ATLAS_UNKNOWNS = 2 * KZ_CURVE_POINTS + 2, KZ_ATLAS_MOST_CLASSES = 512 };

/* Which cycles a curve is about; a cycle or a point of a curve from which one is traced. */
typedef kz_cycle_kind kz_atlas_kind;
typedef struct kz_atlas_plan kz_atlas_plan;
typedef kz_plane_cycle kz_atlas_seed;
typedef struct {
  int64_t count;
  kz_atlas_seed *list;
  int64_t capacity, dropped; /* dropped: those that a record had no room for */
} kz_atlas_seeds;

/* Attractors of one kind; mirror images count as one. */
enum { KZ_CLASS_REST, KZ_CLASS_SYMMETRIC, KZ_CLASS_OTHER };
typedef struct {
  int32_t type, period, turns; /* turns: rest and symmetric cycles: 0 about down, 1 about inverted */
} kz_atlas_class;

/* How a curve ends that was joined to a degenerate point. */
enum { KZ_ATLAS_JOINED = KZ_TRACE_THIN + 1 };
/* A row of a curve: KZ_ROW_... of kz_curve_trace. */
enum { KZ_ROW_PLACE = 0, KZ_ROW_TANGENT = 2, KZ_ROW_FORM = 4, KZ_ROW_SIDE = 5, KZ_ROW_POINTS = 8, KZ_SPECIAL_POINTS = 3 };
enum { KZ_SIGNATURE = 5 };
typedef struct {
  kz_atlas_kind kind;
  int32_t ending[2]; /* of the first row and of the last one: KZ_TRACE_..., KZ_ATLAS_JOINED */
  int64_t n, n_special;
  double *row, *special;
  double (*signature)[KZ_SIGNATURE]; /* [n]: equal for all ways to write a cycle and its mirror image */
} kz_atlas_curve;

/* A crossing of a line with a curve: the class of attractors that change, by how many on the way up. */
typedef struct {
  double at, width; /* width: about, of the band of these attractors that begins or ends here */
  int32_t class, change;
  int64_t curve, row;
  double share; /* of the step from that row */
} kz_atlas_crossing;
typedef struct {
  int64_t count, capacity;
  kz_atlas_crossing *list;
} kz_atlas_crossings;

/* A point, and its attracting cycles that a search has found: one of each pair of mirror images. */
typedef struct {
  double place[2];
  kz_atlas_seeds found;
} kz_atlas_probe;

/* Why a seed leads to no curve: Newton's method finds no point of one; the band beside it is thinner than 1e-10 sides of the plane; the curve is
 * that of a shorter cycle, whose point lies outside of the plane. */
enum { KZ_ATLAS_NO_POINT, KZ_ATLAS_TOO_THIN, KZ_ATLAS_OF_SHORTER, KZ_ATLAS_REFUSALS };

/* The search does not depend on which key a scene calls x: its vertical axis is the one that begins without a drive, or along which the drive grows
 * more. Where that is x, scene and plan have x and y exchanged. */
struct kz_atlas {
  const kz_scene *scene;
  int swapped; /* 1: the axes of the scene are exchanged, so that axis i here is 1 - i there; else 0 */
  kz_scene own_scene;
  kz_atlas_plan own_plan;
  kz_plane plane;
  double longest; /* step along curves */
  bool undriven;  /* no drive at the lowest y: rest alone attracts */
  bool turned;    /* every place has an image with -k in place of k */
  int64_t n_curves, n_explored, curve_capacity;
  kz_atlas_curve *curve;
  kz_atlas_seeds pending;
  int32_t n_classes;
  kz_atlas_class class[KZ_ATLAS_MOST_CLASSES];
  double reference[2];                         /* without an undriven edge: a place, */
  int32_t at_reference[KZ_ATLAS_MOST_CLASSES]; /* and what attracts there */
  int64_t refused[KZ_ATLAS_REFUSALS];          /* seeds that lead to no curve */
  int64_t places, cycles;                      /* of the census: random places, and the cycles that were followed from there */
  kz_atlas_seeds sightings;                    /* the first curves that these met, */
  int64_t *sighting_place, sighting_capacity;  /* and the number of the place of each */
  int64_t rounds, checked, disagreed;          /* of random places, the last two of the last round */
  int64_t dropped;                             /* cycles and points of curves that records had no room for */
  int64_t compared, alone;                     /* crossings of lines at k and -k; those without a partner */
  int64_t listed, unsolved;                    /* motions in the lists of these places; those that could not be solved for */
};

/* What happens on a curve; the codes of the file. */
enum {
  KZ_CURVE_FOLD,
  KZ_CURVE_PERIOD_DOUBLING,
  KZ_CURVE_SYMMETRY_BREAKING,
  KZ_CURVE_REST_SWINGS,
  KZ_CURVE_REST_LEANS,
  KZ_CURVE_KINDS
};

/* ---- the plane ---- */

/* Sets up the plane of the scene. KZ_REFUSED, with the key, where it is not a plane of damped pendulums that its keys change. */
kz_status kz_atlas_begin(const kz_scene *scene, kz_atlas *atlas);
void kz_atlas_end(kz_atlas *atlas);
/* The pendulum of a place; false if there is none. `scene` as context of kz_plane. */
bool kz_atlas_pendulum(const void *scene, const double place[2], kz_pendulum *pendulum);
/* The place with -k in place of k; false if it lies outside of the rectangle. */
bool kz_atlas_image(const kz_atlas *atlas, const double place[2], double image[2]);
/* The values of the keys at a place, as the plan of the search has them. */
void kz_atlas_values(const kz_atlas_plan *plan, const double place[2], double value[2]);
/* An axis of the plan, from an axis of the file, or the other way round. */
static inline int kz_atlas_axis(const kz_atlas *atlas, int axis) {
  return axis ^ atlas->swapped;
}

/* ---- cycles ---- */

/* Writes a cycle that is of a shorter period, or of more symmetry, than its kind as what it is; false if it is of its kind. near: how far
 * points lie apart that are one, rad. */
bool kz_atlas_reduce(const kz_atlas *atlas, double near, kz_atlas_kind *kind, double *y);
/* Adds a seed of a curve (multiplier 1 or -1) or a cycle (0) in its canonical form; false if it is of no interest: a longer period than
 * wanted, outside of the plane. */
bool kz_atlas_add(const kz_atlas *atlas, kz_atlas_kind kind, const double *y, kz_atlas_seeds *seeds);
void kz_atlas_put(kz_atlas_seeds *seeds, const kz_atlas_seed *seed); /* as it is */
void kz_atlas_seeds_free(kz_atlas_seeds *seeds);
/* The class of its attractors, also as files and catalogues describe them, whether that is a given one, and what it is called. */
kz_atlas_class kz_atlas_class_of(const kz_atlas_kind *kind);
kz_atlas_class kz_atlas_class_with(const kz_atlas *atlas, bool symmetric, int32_t period, int32_t turns, int32_t centre);
bool kz_atlas_is_of(const kz_atlas_kind *kind, const kz_atlas_class *class);
int32_t kz_atlas_class_centre(const kz_atlas_class *class);
void kz_atlas_class_name(const kz_atlas *atlas, const kz_atlas_class *class, char *text);
kz_motion_kind kz_atlas_described(const kz_atlas *atlas, const kz_atlas_class *class);
/* How many motions a class has for each of its members: a mirror image too, unless the motion is its own. */
int32_t kz_atlas_images(const kz_atlas *atlas, const kz_atlas_class *class);
/* The number of a class, new if need be. */
int32_t kz_atlas_class_number(kz_atlas *atlas, const kz_atlas_class *class);

/* ---- curves ---- */

/* Traces the curve of a seed to both ends; n = 0 if there is none. */
void kz_atlas_trace(const kz_atlas *atlas, const kz_atlas_seed *seed, kz_atlas_curve *curve);
/* The cycle and the place of a row. */
void kz_atlas_point_of(const kz_atlas_curve *curve, int64_t row, double *y);
/* Sets all points of a row from the first one, which a file has alone. */
void kz_atlas_complete(const kz_atlas *atlas, kz_atlas_curve *curve, int64_t row);
/* The cycle at a share of the step from a row, between those of both rows, with the place of the row. */
void kz_atlas_between(const kz_atlas_curve *curve, int64_t row, double share, double *y);
/* The curve of its kind on which a point lies; -1 = none. */
int64_t kz_atlas_known(const kz_atlas *atlas, const kz_atlas_seed *seed);
/* Adds a curve unless most of it lies on a known one; takes its arrays. */
bool kz_atlas_keep(kz_atlas *atlas, kz_atlas_curve *curve);
void kz_atlas_curve_free(kz_atlas_curve *curve);
/* Sets the signature of each of its points. */
void kz_atlas_sign(const kz_atlas *atlas, kz_atlas_curve *curve);
/* Joins ends of folds to the degenerate points that they run into. */
void kz_atlas_join(kz_atlas *atlas);
/* How many ends of a curve lie within the plane without a reason: it is not whole. */
int kz_atlas_open_ends(const kz_atlas_curve *curve);
static inline int64_t kz_atlas_width(const kz_atlas_kind *kind) {
  return KZ_ROW_POINTS + 2 * kind->of.points;
}

/* ---- exploration: seeds of other curves ---- */

/* From the first curve that a cycle meets along the vertical axis, else along the other one; from a curve's degenerate points, its images and, if
 * `middle`, its middle along both axes; along the line where the other coordinate than `axis` is `value`, from all crossings of curves `first` and
 * later. Not NULL: the branches join `drawn`. */
void kz_atlas_explore_first(const kz_atlas *atlas, const kz_atlas_seed *cycle, kz_atlas_seeds *seeds);
void kz_atlas_explore_curve(const kz_atlas *atlas, const kz_atlas_curve *curve, bool middle, kz_atlas_seeds *seeds);
void kz_atlas_explore_line(kz_atlas *atlas, int axis, double value, int64_t first, kz_atlas_seeds *seeds,
                           kz_atlas_branches *drawn);
/* The point of a curve at a crossing of the line where the other coordinate than `axis` is `value`. */
bool kz_atlas_crossing_point(const kz_atlas *atlas, int axis, double value, const kz_atlas_crossing *crossing,
                             kz_atlas_seed *at);
/* What branches off a point of a curve with multiplier -1: its cycle a little beside, and the direction along the axis in which it exists. */
bool kz_atlas_grown(const kz_atlas *atlas, const kz_atlas_seed *flip, int axis, kz_atlas_seed *child, double along[2]);
/* Half a drive period later, with angles from upside down, a motion at k is a motion at -k. On a plane with k and -k the image of a curve's point
 * `at` becomes a seed. */
void kz_atlas_explore_image(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *at, kz_atlas_seeds *seeds);
/* The curve that Newton's method finds from the mirror image of a curve's point becomes a seed: another one where the symmetry is broken. */
void kz_atlas_explore_mirrored(const kz_atlas *atlas, const kz_atlas_kind *kind, const double *at, kz_atlas_seeds *seeds);
/* Compares lines at values of k with those at -k; what has no partner there becomes a seed. */
void kz_atlas_compare_images(kz_atlas *atlas);
/* The dynamics of a place, with so many steps a period where the pendulum is gentle; NULL if there is no pendulum. The caller frees it. */
kz_dynamics *kz_atlas_dynamics(const kz_atlas *atlas, const double place[2], int steps, kz_pendulum *pendulum);
/* The attractors of a place by following starts, and where the mirror symmetry is broken also the images of what these end on. */
kz_status kz_atlas_probe_at(const kz_atlas *atlas, const double place[2], int64_t starts, int64_t seed, kz_atlas_seeds *found);

/* The distance of a state from another one, or with side -1 from its mirror image. */
static inline double kz_atlas_apart(const double *a, const double *b, double side) {
  return hypot(remainder(a[0] - side * b[0], 2 * M_PI), a[1] - side * b[1]);
}
/* The image of a state at a place: (-theta, -v), or that of the state half a period later. False where no image of a motion is a motion. */
bool kz_atlas_image_state(const kz_atlas *atlas, const double place[2], const double *state, double image[2]);
/* The points of a cycle in the order of time, also those that its kind leaves out as images of others: point [2 KZ_CURVE_POINTS][2]; returns how many,
 * 0 where an orbit cannot be followed. */
int kz_atlas_points(const kz_atlas *atlas, const kz_atlas_kind *kind, const double place[2], const double *y, double *point);
/* Whether a state is one of the points of a cycle or of its image, within `near` rad; image: of the state, NULL where there is none. */
bool kz_atlas_same(const kz_atlas_seed *cycle, const double *state, const double *image, double near);
/* Whether each motion has an image: then a cycle is its own image or one of two. */
static inline bool kz_atlas_paired(const kz_atlas *atlas) {
  return atlas->plane.mirrored || atlas->plane.half_period;
}
/* The cycle of n periods near n points, if the trace of its map, for a symmetric cycle of its half, is below `steepest` times that of a
 * multiplier of 1: 1 = it attracts. */
bool kz_atlas_identify(const kz_atlas *atlas, const double place[2], const double *points, int n, double steepest,
                       kz_atlas_seed *cycle);

/* ---- arrangement ---- */

/* The crossings of the line where coordinate `axis` is `value`, in order of the other coordinate; with the classes that change, or one for
 * each curve alone. */
void kz_atlas_crossings_of(kz_atlas *atlas, int axis, double value, bool classes, kz_atlas_crossings *crossings);
/* The width of the band of attractors at a point of a curve with this normal form, in sides of the plane, if it is narrow: along the direction in
 * which the gradient of the form's side was taken. d: determinant of the cycle's map. */
double kz_atlas_band(const kz_atlas_kind *kind, double d, double form, double gradient);
/* The width at a point of a curve, across it. */
double kz_atlas_band_at(const kz_atlas *atlas, const kz_atlas_seed *at);
/* The widest band of attractors beside a curve within the plane, across the curve; 1 at most. */
double kz_atlas_widest(const kz_atlas *atlas, const kz_atlas_curve *curve);
/* Takes edges of narrow bands that lack the other edge out of the crossings of a line. */
void kz_atlas_pair(kz_atlas_crossings *crossings);
/* The order of crossings along a line, for qsort. */
int kz_atlas_compare_crossings(const void *first, const void *second);
/* counts [KZ_ATLAS_MOST_CLASSES] of the attractors where a column begins to be counted, at the y kz_atlas_floor; at any place. */
double kz_atlas_floor(const kz_atlas *atlas);
/* Where the column of x is counted: a little beside x where k = 0 and an undriven edge meet, as curves of rest turn there. */
double kz_atlas_column(const kz_atlas *atlas, double x);
void kz_atlas_base(kz_atlas *atlas, double x, int32_t *counts);
void kz_atlas_count(kz_atlas *atlas, const double place[2], int32_t *counts);
/* Whether counts may be right: none is negative. */
bool kz_atlas_plausible(const kz_atlas *atlas, const int32_t *counts);
/* Adds to counts what changes between two values along a line. */
void kz_atlas_changes(const kz_atlas_crossings *crossings, double from, double to, int32_t *counts);
void kz_atlas_crossings_free(kz_atlas_crossings *crossings);

/* ---- what a point and a line of an atlas from a file have ---- */

/* Solves for the motions of the list of a place; `known`: attractors that starts have found there. *listed = length of the list, one for each
 * pair of mirror images; *unsolved = those that were not found; both 0 where the list is not known. */
void kz_atlas_confirm(kz_atlas *atlas, const double place[2], const kz_atlas_seeds *known, int64_t *listed, int64_t *unsolved);

/* The place of a value along an axis of the file, to that of the search. KZ_REFUSED outside of the plane. */
kz_status kz_atlas_place(const kz_atlas *atlas, int axis, double value, double *place);
/* Multipliers of the whole period of a cycle from trace and determinant of its own map. */
void kz_atlas_multipliers(const kz_atlas_kind *kind, const double number[2], double re[2], double im[2]);
/* Adds a branch of kz_curve_branch to a line along an axis, with a point where it gains or loses its stability, an event. */
void kz_atlas_draw(const kz_atlas *atlas, int axis, const kz_atlas_kind *kind, int64_t n, const double *row, int64_t n_events,
                   const double *event, kz_atlas_branches *line);

/* How many places of the census see each curve: places [n_curves]. */
void kz_atlas_count_sightings(const kz_atlas *atlas, int64_t *places);

/* ---- records of tiles ---- */

enum { KZ_ATLAS_CURVE_BYTES = 1 << 20, KZ_ATLAS_SEEDS_BYTES = 1 << 19 };
/* The records of a stage, in the order of its tiles. */
typedef struct {
  int64_t n;
  char **record; /* [n]: each begins with its number of bytes, a uint64_t */
} kz_atlas_bag;
void kz_atlas_bag_free(kz_atlas_bag *b);
/* Runs a kept stage whose records have at most `bytes` bytes; all ranks get them. */
kz_status kz_atlas_gather(const kz_run *run, const char *name, int64_t n, size_t bytes, kz_tile_fn work, void *context,
                          kz_atlas_bag *b);
/* Seeds and curves as records; the seeds of a record stay where they are, a curve is copied. */
void kz_atlas_put_seeds(const kz_atlas_seeds *seeds, void *record);
kz_atlas_seeds kz_atlas_seeds_in(const char *record);
void kz_atlas_put_curve(const kz_atlas_curve *curve, void *record);
kz_atlas_curve kz_atlas_curve_in(const char *record);

/* ---- the run ---- */

/* Traces and explores every curve that comes of the seeds that wait, until nothing is left. Collective. */
kz_status kz_atlas_drain(kz_atlas *atlas, const kz_run *run);
/* Follows all branches along n columns, and traces and explores the curves that come of them. Collective. */
kz_status kz_atlas_explore_columns(kz_atlas *atlas, const kz_run *run, int64_t n, const double *x);
/* A seed waits to be traced unless it lies on a known curve. */
void kz_atlas_await(kz_atlas *atlas, const kz_atlas_seed *seed);
/* Finds all cycles of n places, beside those found there, follows each to the first curve that it meets, and traces and explores the curves that come
 * of them. *wide: how many new curves have a band of 1e-4 sides or more; NULL: the places are not random, and count for no estimate. Collective. */
kz_status kz_atlas_census(kz_atlas *atlas, const kz_run *run, int64_t n, const kz_atlas_probe *probe, int64_t *wide);
/* Runs all stages. Collective. */
kz_status kz_atlas_search(kz_atlas *atlas, const kz_run *run);

/* ---- regions ---- */

/* A connected part of the raster with one list of attractors. */
typedef struct {
  int64_t cells, cell; /* how many cells, and the one farthest from its edge */
  double radius;       /* of that one, cells */
} kz_atlas_region;

/* The attractors of the cells of a raster, points x points, and its largest regions. */
enum { KZ_ATLAS_REGIONS = 120, KZ_ATLAS_NOT_KNOWN = 255 };
typedef struct {
  int64_t points, n_classes, n_regions, lists,
      negative;        /* different lists; cells whose list is not known, as some count is negative there */
  uint8_t *attracting; /* [class][y][x]; KZ_ATLAS_NOT_KNOWN where the list is not known */
  int16_t *count;      /* [y][x]: of all, mirror images too; -1 = not known */
  int32_t *list;       /* [y][x]: number of the list of attractors; -1 = not known */
  kz_atlas_region region[KZ_ATLAS_REGIONS];
  int64_t *hits, *other; /* [region][class], [region]: of the starts at the region's place; NULL = not asked for */
} kz_atlas_raster;
/* Counts what attracts in the cells of a column, to `raster` if it is not NULL. Returns how many lists are not known. */
int64_t kz_atlas_fill_column(kz_atlas *atlas, int64_t column, kz_atlas_raster *raster);
/* The middle of a row or column of cells. */
double kz_atlas_middle(int64_t i, int64_t points);
/* The classes must be in their order (kz_atlas_order). */
void kz_atlas_raster_make(kz_atlas *atlas, kz_atlas_raster *raster);
void kz_atlas_raster_free(kz_atlas_raster *raster);
/* The place of a region: the middle of the cell that is farthest from its edge. */
void kz_atlas_region_place(const kz_atlas_raster *raster, int64_t region, double place[2]);
/* Lists all classes, in the order of the file. */
void kz_atlas_order(kz_atlas *atlas);

/* Writes the group /atlas and the summary. Rank 0. */
kz_status kz_atlas_write(kz_atlas *atlas, const kz_atlas_raster *raster, kz_store *store, FILE *summary);
/* Writes how many curves are missing, as the census tells. */
kz_status kz_atlas_write_tally(const kz_atlas *atlas, kz_store *store, FILE *summary);
