/* study: where starts end, and where basins meet between them (C; layer 3). No MPI, no files. */
#ifndef KAPITZA_STUDY_WHERE_H
#define KAPITZA_STUDY_WHERE_H

#include <stdint.h>

#include "kapitza/study.h"

/* Where a start ends. */
typedef struct {
  int32_t attractor;               /* id in the catalogue of the scene's window; -1 = not settled */
  char name[KZ_NAME_LENGTH];       /* "" = not settled */
  int32_t period, winding;         /* as in /attractors */
  int64_t settling_time;           /* drive periods until the orbit is inside a trapping region */
  const char *precision;           /* that decides it: double, pairs, quad, arbitrary; NULL = none does, or not settled */
  double error;                    /* rad: how far the orbit may be off when it is trapped; NaN = not decided, or chaotic */
  int32_t other;                   /* settled, but not decided: the other candidate's id; -1 = none */
  char other_name[KZ_NAME_LENGTH]; /* "" = none */
  double *strobe_theta, *strobe_velocity; /* [period] rad, rad per drive radian; NULL = not settled */
} kz_ending;

/* Where n starts (start [n]: theta and velocity; of one with a centre `high` and `low` are the nearest pair) end, into endings [n]. The
 * attractors are those that the search of the scene's study basin or attractors finds, and those that the starts find themselves; each
 * start is then labelled as basin.method exact labels a cell, and in as many digits as it takes. KZ_REFUSED without such a study. Not
 * collective. kz_where_free in every case. */
kz_status kz_where(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], kz_ending *endings);
void kz_where_free(int64_t n, kz_ending *endings);

/* A point of the boundary between basins, on the straight line between two starts that end differently: decimal texts, right to so many
 * digits behind the point, and the attractors that starts beside it end on, towards the first start and towards the second. */
enum { KZ_BOUNDARY_MOST_DIGITS = 900 };
typedef struct {
  char theta[KZ_DECIMAL_LENGTH], velocity[KZ_DECIMAL_LENGTH];
  int32_t attractor[2];
  char name[2][KZ_NAME_LENGTH];
} kz_boundary_point;
kz_status kz_where_boundary(const kz_scene *scene, const kz_coordinate (*start)[2], int64_t digits, kz_boundary_point *point);

#endif
