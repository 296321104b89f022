/* Measures (src/study/measures) at every point of a line or plane, and attractors matched between points. */
#pragma once

#include "measures.h"
#include "sweep/sweep.h"

enum { KZ_POINT_MOST = 32 }; /* attractors at one point */

/* Where the points lie: x fastest; one row where the sweep is a line. */
typedef struct {
  const kz_scene *scene;
  kz_measures_plan plan; /* Plan of the measures at every point */
  int64_t columns, rows;
  int64_t numbers;     /* values of an attractor: each measure has 1, or 3 with its interval */
  int64_t of_pendulum; /* Numbers that belong to the pendulum */
} kz_points;
/* names: rows of kz_measures. */
kz_points kz_points_of(const kz_scene *scene, const kz_integers *names);
/* Estimate the cost of all points; run them. Collective. */
kz_cost kz_points_cost(const kz_points *points);
kz_status kz_points_run(const kz_points *points, const kz_run *run, kz_store *store, FILE *summary);
/* The pendulum between two points, at `share` of the way from one to the other; false if there is none. */
bool kz_points_pendulum(const kz_points *points, int64_t from, int64_t to, double share, kz_pendulum *pendulum);

/* Record of a point: value [KZ_POINT_MOST][numbers] of its attractors, then [of_pendulum]. count -1: no pendulum, or
 * one without damping. */
typedef struct {
  int64_t count;
  kz_attractor attractor[KZ_POINT_MOST];
  double value[];
} kz_measured_point;
static inline size_t kz_point_bytes(const kz_points *points) {
  return sizeof(kz_measured_point) + (size_t)(KZ_POINT_MOST * points->numbers + points->of_pendulum) * sizeof(double);
}
static inline const kz_measured_point *kz_point_at(const kz_points *points, const void *records, int64_t point) {
  return (const kz_measured_point *)((const char *)records + (size_t)point * kz_point_bytes(points));
}

/* Attractors that are the same from point to point. of [points][KZ_POINT_MOST]: the number of each attractor's class;
 * first [count]: its place (point, place in the list of the point) where the class begins. */
typedef struct {
  int64_t count, *first_point;
  int32_t *of, *first_place;
} kz_classes;
void kz_classes_free(kz_classes *classes);
/* Carries every cycle to the points to the right and above; what arrives is the same attractor. Chaotic ones join the
 * nearest. Two attractors of one point never become one. Collective; rank 0 alone gets the classes. */
kz_status kz_classes_make(const kz_points *points, const kz_run *run, const void *records, kz_classes *classes);
