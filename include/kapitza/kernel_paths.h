/* kernel, paths: the torque of least action that takes the pendulum from one cycle to another (a part of kernel).
 *
 * theta'' + beta theta' + a(t) sin theta - b(t) cos theta - torque(t) = u(t) costs int u^2 / (4 beta) dt, with beta >
 * 0. Where white noise of intensity 2 beta T takes the place of u, the mean life grows as exp(cost / T). With u = 2
 * beta p2 the least cost belongs to solutions of Hamilton's equations of H = p1 v + p2 (-beta v - force) + beta p2^2.
 * States are (theta, velocity, p1, p2): rad, rad per drive radian, and momenta; theta is not wrapped. */
#pragma once

#include "kapitza/model.h"

/* force [n][3] = a(t), b(t) and torque(t) at t = 2 pi (i + share) / n. */
void kz_path_forces(const kz_pendulum *pendulum, int32_t n, double share, double *force);

/* Hamilton's flow, by split6 with n_steps >= 1 steps a period. pendulum [3]: the pendulum, and the derivatives of its
 * numbers by two parameters p and q. */
typedef struct kz_hamilton kz_hamilton;
kz_hamilton *kz_hamilton_create(const kz_pendulum *pendulum, int32_t n_steps);
void kz_hamilton_free(kz_hamilton *flow);
/* Frees a local variable at the end of its scope (KZ_AUTOFREE_BY). */
static inline void kz_hamilton_freed(kz_hamilton **flow) {
  kz_hamilton_free(*flow);
}
/* Advances n states through one period, state [n][4]. tangent [n][4][4], if asked for: derivatives of each by its
 * start, row by row; integral [n][4]: action, and its derivatives by p, q and beta along the path. */
void kz_hamilton_advance(const kz_hamilton *flow, int64_t n, double *state, int32_t with_tangent, double *tangent,
                         int32_t with_integral, double *integral);
/* Fills sample [n][samples][4], n states after each equal part of a period; `samples` divides the number of steps. */
void kz_hamilton_sample(const kz_hamilton *flow, int32_t samples, int64_t n, const double *state, double *sample);

/* A strobe point of a cycle, p = 0, and the plane in which paths leave or approach it. */
typedef struct {
  int64_t period, winding;
  double state[4];
  double own[2][2];     /* monodromy of (theta, velocity) */
  double growth;        /* the multiplier of larger modulus; of a complex pair the modulus */
  double away[2];       /* unit vector of a saddle's unstable direction */
  double covariance[3]; /* covariance / T of weak noise at an attractor: tt, tv, vv */
  double plane[4][2];   /* orthonormal: of an attractor the unstable plane (X p, p), of a saddle the stable one */
  double along[2][2];   /* how a period moves coordinates in the plane; for an attractor the inverse */
} kz_path_end;
/* Sets an end from a state near the cycle (rad, rad per drive radian). False where no cycle is near, and where it is
 * not an attractor, or a saddle. */
bool kz_path_end_find(const kz_hamilton *flow, int64_t period, bool attracts, double theta, double velocity,
                      kz_path_end *end);

/* A path of n periods between two ends, from strobe to strobe. */
typedef struct {
  int64_t n;
  double *node;     /* [n + 1][4] */
  double turns[2];  /* by which the ends are moved on the line */
  double action;    /* with the pieces before the first and behind the last node */
  double slope[3];  /* derivatives of the action by p, q and beta, without these pieces */
  double mismatch;  /* largest jump at a node */
  double beyond[2]; /* distances of the first and the last node from their cycles */
  int32_t iterations;
} kz_path;

/* Newton's method for the least discretised action near a guess: theta [n samples + 1], of which the first and the last
 * four stay. Returns the action; INFINITY where it finds no minimum, and where it gives up because that will have an
 * action above `most`. node [n + 1][4]: the states at strobes, for kz_path_polish. */
double kz_path_relax(const kz_pendulum *pendulum, int64_t n, int32_t samples, double most, double *theta, double *node);
/* Newton's method by multiple shooting, in least-norm steps: time shifts are almost free. False if not converged. */
bool kz_path_polish(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, kz_path *path);
/* One step of Newton's method for a path and the parameter of its pendulum together, for folds, beyond which the path
 * does not exist. Flows and ends: at the parameter's value, and at one that is larger by `apart`. Path and parameter
 * move least. Returns the step of the parameter, NaN where there is none; path->mismatch is the largest jump before it.
 */
double kz_path_turn(const kz_hamilton *const flow[2], const kz_path_end *const from[2], const kz_path_end *const to[2],
                    double apart, kz_path *path);
/* Adds `cycles` [2] cycles of each end to the path, along its planes. The node moves to other memory of kz_realloc. */
void kz_path_lengthen(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, const int64_t cycles[2],
                      kz_path *path);

/* Motions under white noise of intensity 2 beta T, with `steps` steps a period. */
typedef struct {
  int32_t steps;
  double half, decay, noise; /* half a step; of the velocity in a step; standard deviation of what a step adds to it */
  double (*force)[3];        /* forces (kz_path_forces) at the middle of each step */
} kz_walker;
kz_walker *kz_walker_create(const kz_pendulum *pendulum, double temperature, int32_t steps);
void kz_walker_free(kz_walker *walker);
/* Advances a state through drive period number `period` of the motion `seed`. theta is not wrapped. */
void kz_walker_advance(const kz_walker *walker, uint64_t seed, uint64_t period, double *theta, double *velocity);
/* Random bits, and a number in [0, 1): hashes of a counter. */
uint64_t kz_path_hash(uint64_t seed, uint64_t counter);
double kz_path_random(uint64_t seed, uint64_t counter);
