/* Study `escape`: the least torque that takes a motion out of its basin, or into another one. */
#pragma once

#include "kapitza/kernel_paths.h"
#include "plan.h"

/* A cycle from which paths lead, or to which: its ends at each strobe, and its angle between them. */
typedef struct {
  int64_t period, winding;
  kz_path_end *end; /* [period] */
  int64_t *turns;   /* [period] turns from the angle of the end to the angle counted from strobe 0 */
  double *theta;    /* [period][samples] angle from each strobe on, as its end has it */
} kz_escape_cycle;

/* The numerics of a pendulum's paths. */
typedef struct {
  const kz_pendulum *pendulum;
  kz_hamilton *flow, *coarse; /* right to 1e-12 a period; right to some 1e-9, for searches */
  int32_t samples;            /* points a period of the discretised action */
} kz_escape_flow;

/* The flow, with derivatives of the action by k and m. */
kz_escape_flow kz_escape_flow_of(const kz_pendulum *pendulum);
void kz_escape_flow_free(kz_escape_flow *flow);

/* Finds the cycle near strobe points theta, velocity [period]; false where it is not an attractor, or a saddle.
 * kz_escape_cycle_free in every case. */
bool kz_escape_cycle_find(const kz_escape_flow *flow, int64_t period, bool attracts, const double *theta,
                          const double *velocity, kz_escape_cycle *cycle);
void kz_escape_cycle_free(kz_escape_cycle *cycle);

enum { KZ_ESCAPE_FAMILIES = 8, KZ_ESCAPE_NODES = 1280 };

/* Paths from one cycle to another. Families are local minima of the action, in the order of actions. */
typedef struct {
  int64_t count, starts; /* families; starts that led to any */
  double action[KZ_ESCAPE_FAMILIES];
  int64_t hits[KZ_ESCAPE_FAMILIES];
  kz_path least;                    /* action INFINITY = none was found; its node is the one below */
  double largest_torque;            /* largest torque of the path */
  int64_t phase;                    /* strobe of the first cycle where it begins; it ends at strobe 0 of the other */
  double node[4 * KZ_ESCAPE_NODES]; /* nodes, the first least.n + 1 count */
} kz_escape_route;

/* Searches from `starts` starts of the minimiser, of which `seed` gives the places. */
void kz_escape_search(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      int64_t starts, uint64_t seed, kz_escape_route *route);
/* Polishes a path; then again with more periods near its cycles, where it ends farther than `distance` (rad) from one.
 * False where that fails. */
bool kz_escape_polish(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, double distance,
                      kz_path *path);
/* The distance at which what is cut off changes no digit of the action, and one at which it changes less than 1e-9 of
 * it. */
#define KZ_ESCAPE_FINISHED 1e-7
#define KZ_ESCAPE_NEAR 1e-4
/* Polishes the least path again, to a distance from its cycles. False where that fails. */
bool kz_escape_finish(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                      double distance, kz_escape_route *route);
double kz_escape_torque(const kz_escape_flow *flow, const kz_path *path); /* Largest torque along a path */
/* Drive periods in which motions near a cycle change their distance by a factor e, at least; of a saddle in its stable
 * plane. */
double kz_escape_slowest(const kz_path_end *end);
