/* Starts to be labelled by the command where, after the attractors are known, and points between two of them at which
 * their basins meet. Not collective. */
#pragma once

#include "labelling/catalogue.h"
#include "labelling/labeller.h"
#include "kapitza/study_where.h"

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  int64_t max_periods, n;
  const kz_coordinate (*start)[2]; /* [n] as of kz_where */
  double start_error;              /* rad: bound of the distance of each motion from its start; 0 = none */
  kz_label *label;                 /* [n] */
  double *error;                   /* [n] rad: bound of the orbit's error when it was trapped */
} kz_question;

/* Labels the starts as method exact does: fills `label` and `error`. An undecided start gets its candidates. Attractors
 * that only these starts end on join those of `dynamics`. */
kz_status kz_question_label(kz_question *question);
void kz_question_free(kz_question *question);

/* Clears endings [n]. */
void kz_endings_clear(int64_t n, kz_ending *endings);
/* Fills endings [n] from the labels, with names of the catalogue. */
kz_status kz_question_answer(const kz_question *question, const kz_catalogue *catalogue, kz_ending *endings);

/* Fills the near_time of endings [n] that are decided. The motions begin at state [n][2] (half-turns, velocity), after
 * periods [n]; they are followed in doubles, so that a motion that only more digits lead to its attractor keeps -1. */
void kz_endings_approach(const kz_question *question, const double *state, const int64_t *periods, kz_ending *endings);

/* The point on the straight line between the two starts of a question, whose labels differ: theta and velocity as texts
 * with `digits` right digits behind the point. */
typedef struct {
  char theta[KZ_DECIMAL_LENGTH], velocity[KZ_DECIMAL_LENGTH];
  int32_t label[2]; /* towards the first start, towards the second */
} kz_bisection;
kz_status kz_bisect(const kz_question *question, int64_t digits, kz_bisection *bisection);
