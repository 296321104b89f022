/* The edge of a basin followed: a pair of states on its two sides, carried along by the map. Not collective. */
#ifndef KAPITZA_STUDY_EDGE_TRACK_H
#define KAPITZA_STUDY_EDGE_TRACK_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* What the edge leads to. */
typedef struct {
  int32_t first_end, second_end; /* numbers of kz_dynamics, 0 = not settled: of the two sides at last */
  int32_t period, winding;       /* of the cycle on the edge; period 0 = none was found */
  int32_t centre;                /* as of attractors */
  double theta[KZ_EDGE_MOST_PERIOD], velocity[KZ_EDGE_MOST_PERIOD]; /* its strobe points */
  double multiplier_re[2], multiplier_im[2];
  double exponent;   /* how fast the sides part, per drive period */
  int64_t n_periods; /* that the edge was followed */
} kz_edge;

/* Bisects between the plan's two starts and follows the edge between the first one's basin and what is beside it, bisecting again
 * where the sides have parted. orbit [plan->periods + 1][2]: states on the edge, rad and rad per drive radian. KZ_REFUSED where both
 * starts end alike. */
kz_status kz_edge_track(const kz_scene *scene, kz_dynamics *dynamics, int64_t max_periods, kz_edge *edge, double *orbit);

#endif
