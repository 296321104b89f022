/* Inside of the study `atlas`: curves of bifurcations over a plane of two keys, and the attractors of every point of
 * it.
 *
 * A place is (x, y) in units of the rectangle: 0 at the first value of a key, 1 at the last. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/dynamics_trace.h"
#include "numerics/parent.h"
#include "plan.h"

/* Longest step of branches along a line, in sides of the plane. */
#define KZ_ATLAS_BRANCH_STEP 0.03
enum { KZ_ATLAS_MOST_CLASSES = 512 };

typedef struct kz_atlas_plan kz_atlas_plan;
typedef struct {
  int64_t count;
  kz_cycle *list;
  int64_t capacity, dropped; /* dropped: those that a record had no room for */
} kz_atlas_seeds;

/* Attractors of one kind; mirror images count as one. */
typedef struct {
  int32_t symmetric, period, turns; /* symmetric 1: cycles and rest about down (turns 0) or inverted (1) */
} kz_atlas_class;

/* How a curve ends that was joined to a degenerate point. */
enum { KZ_ATLAS_JOINED = KZ_TRACE_THIN + 1 };
enum { KZ_SIGNATURE = 5 };
typedef struct {
  kz_cycle_kind kind;
  int32_t ending[2]; /* ends at the first and last row: KZ_TRACE_..., KZ_ATLAS_JOINED */
  int64_t n, n_special;
  kz_curve_row *row;
  kz_cycle *special;
  double (*signature)[KZ_SIGNATURE]; /* [n]: equal for all ways to write a cycle and its mirror image */
} kz_atlas_curve;

/* A crossing of a line with a curve: the class of attractors that change, by how many on the way up. */
typedef struct {
  double at, width; /* width: about, of the band of these attractors that begins or ends here */
  int32_t class, change;
  int64_t curve, row;
  double share; /* share of the step from that row */
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

/* Why a seed leads to no curve: Newton's method finds no point of one; the band beside it is thinner than 1e-10 sides
 * of the plane; the curve is that of a shorter cycle, whose point lies outside of the plane. */
enum { KZ_ATLAS_NO_POINT, KZ_ATLAS_TOO_THIN, KZ_ATLAS_OF_SHORTER, KZ_ATLAS_REFUSALS };

/* The search does not depend on which key a scene calls x: its vertical axis is the one that begins without a drive, or
 * along which the drive grows more. Where that is x, scene and plan have x and y exchanged. */
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
  double reference[2];                         /* reference place of a plane without an undriven edge */
  int32_t at_reference[KZ_ATLAS_MOST_CLASSES]; /* attractors of each class there */
  int64_t refused[KZ_ATLAS_REFUSALS];          /* seeds that lead to no curve */
  int64_t places, cycles;                      /* census: random places, and cycles followed from there */
  kz_atlas_seeds sightings;                    /* first curves met by these cycles */
  int64_t *sighting_place, sighting_capacity;  /* place of each sighting */
  int64_t rounds, checked, disagreed;          /* random places; the last two: of the last round */
  int64_t dropped;                             /* cycles and points of curves that records had no room for */
  int64_t compared, alone;                     /* crossings of lines at k and -k; those without a partner */
  int64_t listed, unsolved;                    /* motions in their lists; motions not solved for */
};

/* Events on a curve; the codes of the file. */
enum {
  KZ_CURVE_FOLD,
  KZ_CURVE_PERIOD_DOUBLING,
  KZ_CURVE_SYMMETRY_BREAKING,
  KZ_CURVE_REST_SWINGS,
  KZ_CURVE_REST_LEANS,
  KZ_CURVE_KINDS
};

/* ---- the plane ---- */

/* Sets up the plane of the scene. KZ_REFUSED, with the key, unless it is a plane of damped pendulums. */
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
