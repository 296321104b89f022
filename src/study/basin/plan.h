/* What a scene says of the study `basin`. */
#pragma once

#include "kapitza/study.h"

enum { KZ_METHOD_ICM = 0, KZ_METHOD_DIRECT = 1, KZ_METHOD_EXACT = 2 };
enum { KZ_LINEAR = 0, KZ_QUINTIC = 1 };

enum { KZ_BOUNDARY_FEWEST_DECADES = 2, KZ_BOUNDARY_MOST_DECADES = 23 };
enum { KZ_MOST_SHOCK_SIZES = 16 };
/* The search for the smallest shocks that leave a basin. The size of a shock is hypot(dtheta, dv / scale). */
typedef struct {
  double scale; /* velocity, rad per drive radian, that counts as much as 1 rad */
  kz_reals sizes;
} kz_shocks_plan;

struct kz_basin_plan {
  kz_axis theta;    /* rad; the whole circle is [-pi, pi) */
  kz_axis velocity; /* rad per drive radian */
  kz_edges theta_edges, velocity_edges;
  int32_t method;
  int64_t table_theta, table_velocity; /* nodes of the map table */
  bool table_is_idle;                  /* the scene gives keys of a map table, but its method does not use one */
  int32_t interpolation;
  int64_t max_periods;
  int64_t starts;
  int64_t max_period;
  int64_t seed;
  bool turns;      /* count the net turns of each cell */
  bool unmirrored; /* the pendulum has no mirror symmetry */
  double accuracy; /* NaN, or the share of right labels for which the program chooses method, table and numerics */
  bool has_boundary;
  struct {
    int64_t pairs, decades; /* starts; of their partners' distances */
    double farthest;        /* distance of the first partner, rad */
  } boundary;
  bool has_shocks;
  kz_shocks_plan shocks;
  int64_t phases; /* number of phases of the drive at which the cells are also released; 0 or less = none */
};
