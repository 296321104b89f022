/* Common part of textbook.c and twin.c: RK4 with 100 steps a period, told the attractors, captured once the orbit has
 * been within 0.01 of one attractor's strobe points, in phase, four times running. */
#pragma once

#include "catalogue.h"

enum { STEPS = 100, RUNNING = 4 };
static const double capture_circle = 0.01;

/* Labels n states: -1 where not captured within max_periods. Gives the drive periods integrated in all. */
long label_states(const kz_catalogue *catalogue, long n, const double *theta, const double *velocity, int *labels);
