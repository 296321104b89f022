/* study: where starts end, and where basins meet between them (C; layer 3). No MPI, no files. */
#pragma once

#include "kapitza/study_catalogue.h"
#include "kapitza/dynamics_labels.h"

/* Where a start ends, as users see it. */
typedef struct {
  kz_label end;      /* label and other: ids in the window's catalogue; -1 = not settled, no second candidate */
  kz_entry entry;    /* copy of that attractor; without an id only a name, "" where nothing has settled */
  int64_t near_time; /* drive periods until within 1 degree of the attractor at strobes; -1 = not known */
  double error;      /* rad: bound of the orbit's error when it was trapped; NaN = not decided, or chaotic */
  char other_name[KZ_NAME_LENGTH]; /* "" = none */
} kz_ending;

/* Finds where n starts end: start [n], theta and velocity; high and low of a coordinate with a centre are the nearest
 * pair of doubles. The attractors are those that the search of the scene's study basin or attractors finds, and those
 * that the starts lead to. Each start is labelled as basin.method exact labels a cell, with as many digits as needed.
 * KZ_REFUSED if the scene has neither study. Free endings [n] by kz_where_free in every case. Not collective. */
kz_status kz_where(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2], kz_ending *endings);
void kz_where_free(int64_t n, kz_ending *endings);

/* A point of the boundary between two basins, on the straight line between two starts that end on different attractors.
 * theta and velocity are decimal texts with `digits` right digits behind the point. attractor and name [2] are the
 * attractors on which starts beside the point end: towards the first start, and towards the second. */
enum { KZ_BOUNDARY_MOST_DIGITS = 900 };
typedef struct {
  char theta[KZ_DECIMAL_LENGTH], velocity[KZ_DECIMAL_LENGTH];
  int32_t attractor[2];
  char name[2][KZ_NAME_LENGTH];
} kz_boundary_point;
kz_status kz_where_boundary(const kz_scene *scene, const kz_coordinate (*start)[2], int64_t digits,
                            kz_boundary_point *point);
