/* The job of the tools that label states: a pendulum and its attractors, read from text.
 *
 * k beta m torque torque_amplitude, number of harmonics / per harmonic: cosine and sine up, cosine and sine aside /
 * max_periods / number of attractors / per attractor: period, then period times theta velocity; the states to label
 * follow, theta velocity each. Angles in rad, velocities in rad per drive radian. */
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "kapitza/kernel.h"

typedef struct {
  double theta, velocity;
  int attractor, next; /* whose strobe point, and the index of the one that follows */
} kz_strobe_point;

typedef struct {
  kz_pendulum pendulum;
  long max_periods;
  int n_points;
  kz_strobe_point *points; /* owned: kz_catalogue_free */
} kz_catalogue;

/* False where `in` does not hold a catalogue or memory ran out; free it in both cases. */
bool kz_catalogue_read(FILE *in, kz_catalogue *catalogue);
void kz_catalogue_free(kz_catalogue *catalogue);

/* Distance of a state from a strobe point on the cylinder. */
double kz_point_distance(double theta, double velocity, const kz_strobe_point *point);
