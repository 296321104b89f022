/* Starts labelled in as much precision as it takes, and the candidates of those that none decides. Not collective. */
#ifndef KAPITZA_STUDY_DECIDE_H
#define KAPITZA_STUDY_DECIDE_H

#include <stdint.h>

#include "kapitza/dynamics.h"

typedef struct {
  int32_t label; /* number of kz_dynamics, 0 = not settled, KZ_DOUBTFUL: no rung decides */
  int32_t rung;  /* that decided; KZ_RUNGS: none */
  int64_t periods;
  double reach; /* rad, as of kz_dynamics_follow_errors */
} kz_decision;

/* Follows n starts (start, low [n][2] as of kz_dynamics_follow_errors) on one rung after the other until each is decided. */
kz_status kz_decide(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, const double *low,
                    kz_decision *decision);

/* Makes the finer map and the tables of pairs of doubles, else made where they are first needed: before something is timed. */
void kz_decide_prepare(kz_dynamics *dynamics);

/* For n <= KZ_FEW starts: where the scene's numerics end without regard to errors (label, periods), and the attractor of the nearest start
 * that ends elsewhere (other), 0 = none seen; all [n]. */
enum { KZ_FEW = 64 };
void kz_find_candidates(kz_dynamics *dynamics, int64_t max_periods, int64_t n, const double *start, int32_t *label,
                        int64_t *periods, int32_t *other);

#endif
