/* Plan of the study `atlas`: bifurcation curves over a plane of two keys of the pendulum mapping. */
#pragma once

#include "kapitza/study_atlas.h"

struct kz_atlas_plan {
  kz_plane_axis x, y;         /* the counts are not used */
  int64_t max_period, checks; /* drive periods; random points of a round */
  int64_t seeds;              /* places whose cycles are searched first */
  int64_t points;             /* cells of the raster along each axis */
  int64_t shares;             /* starts at one point of each region; 0 = none */
};
