/* Plan of the study `basin`. */
#pragma once

#include "kapitza/study.h"

typedef enum { KZ_METHOD_ICM = 0, KZ_METHOD_DIRECT = 1, KZ_METHOD_EXACT = 2 } kz_method;
typedef enum { KZ_LINEAR = 0, KZ_QUINTIC = 1 } kz_interpolation;

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
};
