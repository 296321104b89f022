/* What a scene says of the study `edge`: the edge between the basins of two starts. */
#pragma once

#include "kapitza/study.h"

struct kz_edge_plan {
  double first[2], second[2]; /* rad, rad per drive radian */
  int64_t periods;            /* largest number of drive periods for which the edge is followed */
  int64_t max_period;         /* longest period of a cycle that is recognised */
};
enum { KZ_EDGE_MOST_PERIOD = 64 };
