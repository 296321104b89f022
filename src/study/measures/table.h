/* The table of measures: every number about an attractor and its basin, once. A new measure is its row here and its
 * function kz_measure_WORD in a file of this folder; keys, variables of the file, sweeps and planes follow from the
 * row. */
#pragma once

#include <stdint.h>

/* Ingredients of a measure; those that no measure of a scene needs are not computed. */
enum {
  KZ_NEEDS_STARTS = 1,   /* starts spread evenly over the window, with labels and settling times */
  KZ_NEEDS_WEIGHTED = 2, /* starts from the Gaussian distribution */
  KZ_NEEDS_PICTURE = 4,  /* labels of a grid of cells over the window */
  KZ_NEEDS_TANGENTS = 8, /* the derivatives of the map at the strobe points */
  KZ_NEEDS_SHOCKS = 16,  /* the smallest shocks of each kind at the strobe points */
  KZ_NEEDS_SPREAD = 32,  /* shocks of the sizes, spread evenly */
  KZ_NEEDS_SMALLEST = 64 /* the smallest shock of both over all strobe points alone */
};

/* Shapes: a number for each attractor; with the ends of an interval; for each size of shocks; for each other attractor;
 * one for the pendulum. Rows: word, what it needs, unit, long name. */
#define KZ_MEASURES(NUMBER, INTERVAL, SIZES, PAIR, PENDULUM)                                                          \
  INTERVAL(share, KZ_NEEDS_STARTS, "1", "share of the starts of the window that end on the attractor")                \
  INTERVAL(weighted_share, KZ_NEEDS_WEIGHTED, "1", "share of the starts of the Gaussian distribution")                \
  INTERVAL(share_within, KZ_NEEDS_STARTS, "1", "share of the starts that are trapped within the given time")          \
  NUMBER(settling_mean, KZ_NEEDS_STARTS, "1|drive periods", "mean settling time of the starts that end on it")        \
  NUMBER(settling_median, KZ_NEEDS_STARTS, "1|drive periods", "median settling time of the starts that end on it")    \
  NUMBER(settling_largest, KZ_NEEDS_STARTS, "1|drive periods", "largest settling time of the starts that end on it")  \
  NUMBER(settling_pace, KZ_NEEDS_STARTS, "1|drive periods",                                                           \
         "mean of settling time over distance, per rad, of the starts that end on it")                                \
  NUMBER(return_time, 0, "1|drive periods", "time in which the slowest small disturbance falls to 1/e")               \
  NUMBER(mean_velocity, 0, "1|rad per drive radian", "mean velocity, a junction's voltage in units of hbar omega/2e") \
  NUMBER(reactivity, KZ_NEEDS_TANGENTS, "1", "largest growth of a small disturbance in one drive period")             \
  NUMBER(amplification, KZ_NEEDS_TANGENTS, "1", "largest growth of a small disturbance by any later strobe")          \
  NUMBER(shock_angle, KZ_NEEDS_SHOCKS, "rad", "smallest change of the angle that leaves the basin")                   \
  NUMBER(shock_velocity, KZ_NEEDS_SHOCKS, "1|rad per drive radian",                                                   \
         "smallest change of the velocity that leaves the basin")                                                     \
  NUMBER(shock, KZ_NEEDS_SMALLEST, "rad", "size of the smallest change of the state that leaves the basin")           \
  SIZES(harmless, KZ_NEEDS_SPREAD, "1", "share of the shocks of at most this size that stay in the basin")            \
  NUMBER(integrity_local, KZ_NEEDS_PICTURE, "rad", "radius of the largest circle in the basin about a strobe point")  \
  NUMBER(integrity_global, KZ_NEEDS_PICTURE, "1|rad^2 per drive radian", "area of the basin in the window")           \
  NUMBER(integrity_factor, KZ_NEEDS_PICTURE, "rad", "radius of the largest circle in the basin")                      \
  PENDULUM(entropy, KZ_NEEDS_PICTURE, "1", "basin entropy over boxes of 5 x 5 cells")                                 \
  PENDULUM(boundary_entropy, KZ_NEEDS_PICTURE, "1", "the same over the boxes on a boundary")                          \
  INTERVAL(uncertainty_exponent, KZ_NEEDS_PICTURE, "1", "uncertainty exponent of the boundary of the basin")          \
  INTERVAL(boundary_dimension, KZ_NEEDS_PICTURE, "1",                                                                 \
           "dimension of the boundary of the basin; outside of 1 to 2: too few cells")                                \
  NUMBER(intermingledness, KZ_NEEDS_STARTS, "1", "intermingledness with the other basins, their mean")                \
  PAIR(intermingled_with, KZ_NEEDS_STARTS, "1", "intermingledness with the other basin")                              \
  NUMBER(shared_boundary, KZ_NEEDS_PICTURE, "1",                                                                      \
         "share of the boxes of 16 x 16 cells on any boundary that the basin is in")                                  \
  PENDULUM(wada_on_grid, KZ_NEEDS_PICTURE, "1", "1 where all basins, three or more, are in 99 % of these boxes; else 0")

typedef enum { KZ_PER_ATTRACTOR, KZ_PER_INTERVAL, KZ_PER_SIZE, KZ_PER_PAIR, KZ_PER_PENDULUM } kz_measure_shape;
