/* Inside of the study `sweep`: its parts. Values are those of the swept key of the pendulum mapping. */
#pragma once

#include "kapitza/dynamics_cycles.h"
#include "plan.h"

/* Whether the cells of the scene's basin are labelled at each value, else the starts of the sweep. */
bool kz_sweep_has_grid(const kz_scene *scene);

/* ---- walks: one cycle from value to value ---- */

/* How a branch ends; the codes of the file. */
enum {
  KZ_END_OF_RANGE,
  KZ_END_FOLD,
  KZ_END_PERIOD_DOUBLING,
  KZ_END_NEIMARK_SACKER,
  KZ_END_SYMMETRY_BREAKING,
  KZ_END_NOT_LOCATED,
  KZ_END_HOMOCLINIC
};

/* Gives the pendulum at a value of one parameter; false if there is none. */
typedef bool (*kz_pendulum_fn)(const void *context, double value, kz_pendulum *pendulum);
/* The way of a walk, from one value to another. */
typedef struct {
  kz_pendulum_fn pendulum;
  const void *context;
  double from, to;
  kz_fine_maps *maps; /* where those of both ends are kept; NULL = nowhere */
} kz_path;

/* The path of the sweep between two of its values; `scene` and `maps` must outlive it. */
kz_path kz_sweep_path(const kz_scene *scene, int64_t from, int64_t to, kz_fine_maps *maps);

/* A piece of a branch between two values: all along it the cycle attracts, or nowhere. It begins at the cycle that is
 * followed, or where something happens; it ends at one of the values, or where something happens (KZ_END_...). */
typedef struct {
  double begin, end; /* values; of the ends that are events */
  int32_t begin_kind, end_kind;
  int32_t from_start;      /* 1: begins at the cycle that is followed */
  int32_t reached;         /* 0: ends at the first value, 1: at the second, -1: at an event */
  int32_t attracts, twice; /* twice: its image branches off with it */
  double step;             /* next step from its end, in distances of the two values */
  kz_attractor point;      /* cycle at the end of the piece */
} kz_sweep_piece;
enum { KZ_SWEEP_PIECES = 32 };
typedef struct {
  int64_t count;
  kz_sweep_piece piece[KZ_SWEEP_PIECES];
} kz_sweep_walk;

/* Follows a cycle along a path by pseudo-arclength, attracting or not, through folds, and all cycles of up to
 * max_period periods that branch off on the way. The first piece is that from the cycle itself. Ends are right to
 * rounding. step: the first one, in distances of the values; 0 = not known. */
void kz_sweep_follow(const kz_path *path, int64_t max_period, const kz_attractor *point, double step,
                     kz_sweep_walk *found);

/* The value of a path, to rounding, at which a running state of this winding is born that the pendulum at its begin has
 * and the one at its end has not; NaN if that is not so, or if anything but a constant torque drives them. */
double kz_running_birth(const kz_path *path, int32_t winding);

/* A cycle with a strobe point, or of a motion that never closes its means; its image. */
kz_attractor kz_branch_point_image(const kz_pendulum *pendulum, kz_attractor point);
/* Whether two motions have the same period and winding. */
bool kz_branch_alike(const kz_attractor *a, const kz_attractor *b);
/* The distance between two motions that never close, by their means. */
double kz_branch_points_apart(const kz_attractor *a, const kz_attractor *b);
/* Compares by centre, period (0 last), |winding|/period, + first: below 0 where p comes first, 0 where these are equal.
 */
int kz_branch_points_order(const kz_attractor *p, const kz_attractor *q);

/* ---- catalogues: what attracts at each value ---- */

enum { KZ_SWEEP_MOST = 128 /* attractors at one value */, KZ_SWEEP_NUMBERS = 3 /* numbers of an entry, by a part */ };

typedef struct {
  kz_attractor point;              /* period 0: theta, velocity are its mean angle and mean velocity */
  int64_t hits;                    /* number of starts or cells that ended on it */
  double number[KZ_SWEEP_NUMBERS]; /* numbers of a part (kz_sweep_part); NaN = none */
} kz_sweep_entry;

struct kz_sweep_catalogue {
  int64_t count, samples, unsettled; /* attractors; starts or cells followed; starts or cells unsettled */
  kz_lifetime lifetime;              /* lifetime of the starts, if measured */
  double of_value[KZ_SWEEP_NUMBERS]; /* by a part (kz_sweep_part) */
  kz_sweep_entry entries[KZ_SWEEP_MOST];
};

/* A value where parts measure: what attracts, how many samples ended on each, the speeds of the samples. */
struct kz_sweep_value_at {
  const kz_run *run;
  kz_dynamics *dynamics;
  kz_pendulum pendulum;
  const int64_t *hits;     /* [numbers from 1] */
  const kz_axis *velocity; /* axis of the samples' window */
  int64_t n_cells;         /* samples that are cells of the basin, without mirror images; 0 = they are the starts */
  int64_t max_periods;
};

/* Fills catalogue [values.count] on every rank. Collective. */
kz_status kz_sweep_catalogues(const kz_scene *scene, const kz_run *run, kz_sweep_catalogue *catalogue);

/* ---- branches: the same attractor along the values ---- */

/* An attractor at one value, joined to its neighbours of the same branch. */
typedef struct {
  kz_sweep_entry entry;
  int64_t value;             /* index */
  int32_t attracts, between; /* between: the branch lies between this value and the next one, and exists at neither */
  int64_t previous, next;    /* nodes; -1 = none */
  double first, last;        /* value at which the branch begins before, or ends after, this node */
  int32_t first_kind, last_kind;
  double step; /* with which a walk has arrived here; 0 = not known */
} kz_sweep_node;

typedef struct {
  int64_t n_nodes, nodes_capacity;
  kz_sweep_node *nodes;
  int64_t n_branches, *first_node; /* [n_branches] in the order of the file */
  kz_fine_maps *maps;              /* fine maps of the values */
} kz_sweep_branches;

/* Joins the catalogues by continuation; equal on all ranks; kz_sweep_branches_free frees it. Collective. */
kz_status kz_sweep_branches_make(const kz_scene *scene, const kz_run *run, const kz_sweep_catalogue *catalogue,
                                 kz_sweep_branches *branches);
void kz_sweep_branches_free(kz_sweep_branches *branches);

/* Writes everything about branches to the file and the summary. Rank 0. */
kz_status kz_sweep_branches_write(const kz_scene *scene, const kz_sweep_catalogue *catalogue,
                                  const kz_sweep_branches *branches, kz_store *store, FILE *summary);

/* ---- the other measures: each runs its stage and, on rank 0, writes its variables. Collective. ---- */

kz_status kz_sweep_release(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
kz_status kz_sweep_strobe(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* Writes the axes of a plane, their keys and those keys' units. Rank 0. */
kz_status kz_sweep_write_axes(const kz_sweep_plan *plan, kz_store *store);

/* Variables of a sweep over a plane, besides kz_sweep_variables. */
extern const kz_variable kz_plane_variables[];

/* Writes the records of such a measure, on rank 0. */
typedef kz_status (*kz_records_fn)(const kz_scene *scene, const void *records, kz_store *store, FILE *summary);
/* Runs a stage whose context is the scene, then `write`. Collective. */
kz_status kz_sweep_stage(const kz_run *run, const kz_stage *stage, kz_records_fn write, kz_store *store, FILE *summary);

/* Releases the pendulum from rest at t = 0, at angle [n] (rad) from inverted. stays [n] = 1 if the motion stays within
 * half a turn of inverted, else 0. */
void kz_sweep_releases(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *angle,
                       uint8_t *stays);

/* Prints a warning for each class of speeds whose error is too large, at the value with the largest error. */
void kz_sweep_warn_steps(const kz_scene *scene, FILE *summary);
