/* dynamics: cycles, attracting or not, for a catalogue; manifolds of saddles (Fortran; layer 1, a part of dynamics). */
#pragma once

#include "kapitza/dynamics.h"

/* A search for cycles along a line of starts. */
typedef struct {
  int64_t max_period;  /* largest period of cycles, drive periods, <= 64 */
  int64_t most_starts; /* number of starts above which the search ends early */
  int64_t most;        /* number of cycles above which it ends early */
  double window[4];    /* least and largest angle, least and largest velocity: a cycle counts if it has a point there */
  /* Largest trace of the cycles, of the map that closes them (for symmetric ones half of their period), in that of a
   * multiplier of 1; no piece shorter than 0.1 rad / steepest is halved. INFINITY: cycles of any trace. */
  double steepest;
} kz_line_search;
/* Searches cycles, attracting or not, along a line through n_nodes states node [n_nodes][2] (rad, rad per drive
 * radian). Wherever an image of the line passes near the line, multiple shooting begins. found [most][2 + 2
 * max_period]: period, largest speed, and each point as half-turns and velocity, right to about 1e-8; a cycle may occur
 * twice. work [2]: number of starts followed, number of orbits that shooting tried to close. Returns the number of
 * cycles. */
int64_t kz_dynamics_search_line(const kz_pendulum *pendulum, const kz_line_search *search, int64_t n_nodes,
                                const double *node, double *found, int64_t work[2]);
/* Adds n cycles from such searches, in the order of periods and speeds, and their mirror images to an empty catalogue.
 * They become cycles of the map of published values, whose points are right to rounding. The catalogue then serves for
 * reading and ordering; it has no trapping regions. */
void kz_dynamics_add_cycles(kz_dynamics *dynamics, int64_t max_period, int64_t n, const double *found);

/* Adds the cycle of `period` <= max_period drive periods within 0.2 rad of a strobe point (rad, rad per drive radian),
 * and its mirror image, to the catalogue, if it attracts and is not there. */
void kz_dynamics_add_cycle(kz_dynamics *dynamics, int64_t period, double theta, double velocity);

/* One branch of the stable or unstable manifold of a saddle of the map of published values. */
typedef struct {
  double theta, velocity;       /* a point of the saddle: rad, rad per drive radian */
  int32_t period, stable, side; /* stable: 0 or 1; side: 1 or -1, along the eigenvector or against it */
  double spacing;               /* largest distance of neighbouring points, rad */
  double length;                /* length of the branch, rad and rad per drive radian together */
  double fastest;               /* largest speed, rad per drive radian: faster parts are left out of the length */
} kz_branch;

/* Computes the branch from the saddle on. point [most][4]: theta in [-pi, pi), velocity, arc length, number of the
 * unbroken part. Returns the number of points; the branch ends if `most` is reached. */
int64_t kz_manifold_grow(const kz_pendulum *pendulum, const kz_branch *branch, int64_t most, double *point);
