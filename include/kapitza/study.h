/* study: what a scene can ask for, one file per study (C; floor 3). The scene arrives as plain structs; the results go to
 * the store and, for people, to a summary. */
#ifndef KAPITZA_STUDY_H
#define KAPITZA_STUDY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "kapitza/kernel.h"
#include "kapitza/parallel.h"
#include "kapitza/store.h"

/* An axis of cells or of values: n cells between min and max (basin), or n values with both ends (charts, sweeps). */
typedef struct {
  double min, max;
  int64_t count;
} kz_axis;

enum { KZ_METHOD_ICM = 0, KZ_METHOD_DIRECT = 1, KZ_METHOD_HYBRID = 2 };
enum { KZ_LINEAR = 0, KZ_CUBIC = 1, KZ_QUINTIC = 2 };

typedef struct {
  kz_axis theta;    /* rad; the whole circle is [-pi, pi) */
  kz_axis velocity; /* rad per drive radian */
  int32_t method;
  int64_t table_theta, table_velocity; /* nodes of the map table */
  int32_t interpolation;
  int64_t max_periods;
  int64_t starts;
  int64_t max_period;
  int64_t seed;
} kz_basin_plan;

/* The three ways to give the parameters all end here; NaN where a value is not defined (Q without damping, Omega at k <= 0). */
typedef struct {
  kz_pendulum pendulum;
  double quality_factor, drive_frequency, drive_amplitude;
} kz_parameters;

typedef struct {
  char *title; /* may be "" */
  kz_parameters parameters;
  kz_numerics numerics;
  bool has_basin;
  kz_basin_plan basin;
} kz_scene;

/* What a study would cost. */
typedef struct {
  int64_t cells;
  double disk_bytes;     /* result file and checkpoint */
  double memory_bytes;   /* of the largest rank */
  double core_seconds;   /* rough, on one core */
} kz_cost;

/* One row per study. `summary` is a stream for people on rank 0, NULL elsewhere; so is `store`. All ranks call run. */
typedef struct {
  const char *name;
  bool (*wanted)(const kz_scene *scene);
  kz_cost (*cost)(const kz_scene *scene);
  kz_status (*run)(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary);
} kz_study;
extern const kz_study kz_studies[];
extern const int kz_study_count;

#endif
