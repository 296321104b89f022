/* The smallest shocks that push a motion out of its basin: a sudden change of angle, of velocity, or of both; and how
 * far each attractor's motion is from the edge of its basin, at every strobe point. */
#pragma once

#include "basin/label.h"
#include "labelling/catalogue.h"
#include "plan.h"

extern const kz_basin_part kz_shocks_part;

/* NULL, or what is wrong with the sizes of shocks, as "sizes: what is wrong". */
const char *kz_sizes_lack(const kz_reals *sizes);

/* Labels n starts, start [n][2] (rad, rad per drive radian): end [n]. */
typedef void (*kz_ends_fn)(void *context, int64_t n, const double *start, kz_label *end);

/* The problem: shocks of one state. The size of a shock (dtheta, dv) is hypot(dtheta, dv / scale). */
typedef struct {
  kz_ends_fn ends;
  void *context;
  double from[2];   /* the state: rad, rad per drive radian */
  int32_t own;      /* its end without a shock */
  double scale;     /* velocity that counts as much as 1 rad, rad per drive radian */
  double farthest;  /* largest change of the velocity, rad per drive radian */
  double tolerance; /* Relative tolerance of a size; 0 = as close as can be */
} kz_shock_problem;

/* A shock; end = the end after it; size NaN = none was found. */
typedef struct {
  double theta, velocity, size; /* rad, rad per drive radian, rad */
  int32_t end;
} kz_shock;

/* Harmless shocks among evenly spread ones of at most `size`. */
typedef struct {
  int64_t harmless, shocks;
  double return_time; /* mean number of drive periods after a harmless shock until the end is certain */
} kz_harmless;

/* The smallest shocks: [0] of the angle alone, [1] of the velocity alone (size: the change itself, rad or rad per drive
 * radian), [2] of both. Lines and discs are searched on ever finer grids, until a finer one finds nothing nearer; then
 * the boundary between the nearest points is bisected to rounding, and its distance minimised along it. */
void kz_shocks_find(const kz_shock_problem *problem, kz_shock shock[3]);

/* A shock of both that is smaller than *shock; unchanged where there is none. */
void kz_shocks_nearer(const kz_shock_problem *problem, kz_shock *shock);

void kz_shocks_harmless(const kz_shock_problem *problem, double size, kz_harmless *harmless);

/* The settings of a search, the same for all points. */
typedef struct {
  double scale, farthest, tolerance; /* as in kz_shock_problem */
  bool smallest;  /* only the smallest shock of an attractor is wanted: stands at phase 0, all others NaN */
  kz_reals sizes; /* Sizes of harmless shocks; KZ_MOST_SHOCK_SIZES at most */
  int64_t max_periods;
} kz_resilience_plan;

/* A strobe point and its shocks; ends are numbers of kz_dynamics, 0 = not settled. */
typedef struct {
  int64_t number, phase;
  double theta, velocity;
  kz_shock shock[3]; /* Shocks of the angle, of the velocity, of both */
  kz_harmless harmless[KZ_MOST_SHOCK_SIZES];
} kz_resilience;

/* All strobe points of the non-chaotic attractors of a catalogue, [*n]; the caller frees them. */
kz_resilience *kz_resilience_list(const kz_dynamics *dynamics, const kz_catalogue *catalogue, int64_t *n);

/* Fills point [n] on every rank, in a kept stage. Collective. */
kz_status kz_resilience_run(const kz_run *run, kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n,
                            kz_resilience *point);
