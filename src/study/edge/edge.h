/* Study `edge`: the map advances a pair of states on the two sides of a basin's edge. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "plan.h"

/* The cycle or chaotic set on the edge. */
typedef struct {
  int32_t first_end, second_end; /* attractors on the two sides at the end: numbers of kz_dynamics, 0 = not settled */
  kz_attractor cycle;            /* on the edge; period 0 = none was found */
  double theta[KZ_EDGE_MOST_PERIOD], velocity[KZ_EDGE_MOST_PERIOD]; /* its strobe points */
  double exponent;                                                  /* at which the two sides separate, per drive period */
  int64_t n_periods;                                                /* for which the edge was followed */
} kz_edge;
