/* Sets of states, and where a motion lies in them. */
#pragma once

#include "kapitza/kernel.h"
#include "kapitza/kernel_enclosure.h"

typedef __float128 quad;

static inline kz_enclosure set_at(double theta, double velocity, double half) {
  return (kz_enclosure){.theta = {theta}, .velocity = {velocity}, .matrix = {{1, 0}, {0, 1}}, .reach = {half, half}};
}

/* z of a state at a distance from the centre of a set, in its coordinates. */
static inline void place_at(quad x, quad v, const kz_enclosure *set, double z[2]) {
  const double (*A)[2] = set->matrix;
  const quad det = (quad)A[0][0] * A[1][1] - (quad)A[0][1] * A[1][0];
  z[0] = (double)((A[1][1] * x - A[0][1] * v) / det);
  z[1] = (double)((A[0][0] * v - A[1][0] * x) / det);
}

/* Tells whether a set holds a state, but for a whole turn. */
static inline void place_of(const quad end[2], const kz_enclosure *set, double z[2]) {
  const quad turn = 2 * 3.14159265358979323846264338327950288419716939937510582Q;
  quad x = end[0] - set->theta[0] - set->theta[1] - set->theta[2];
  if (x > 3) x -= turn;
  if (x < -3) x += turn;
  place_at(x, end[1] - set->velocity[0] - set->velocity[1] - set->velocity[2], set, z);
}
