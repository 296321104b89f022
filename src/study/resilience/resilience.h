/* How far each attractor's motion is from the edge of its basin, at every strobe point. */
#ifndef KAPITZA_STUDY_RESILIENCE_H
#define KAPITZA_STUDY_RESILIENCE_H

#include "attractors/catalogue.h"
#include "kapitza/parallel.h"
#include "kapitza/study.h"
#include "shocks.h"

/* The settings, the same for all points. */
typedef struct {
  double scale, farthest; /* as in kz_shock_problem */
  int64_t n_sizes;
  double size[KZ_MOST_SHOCK_SIZES];
  int64_t max_periods;
} kz_resilience_plan;

/* A strobe point and its shocks; ends are numbers of kz_dynamics, 0 = not settled. */
typedef struct {
  int64_t number, phase;
  double theta, velocity;
  kz_shock shock[3]; /* of the angle, of the velocity, of both */
  kz_harmless harmless[KZ_MOST_SHOCK_SIZES];
} kz_resilience;

/* All strobe points of the non-chaotic attractors of a catalogue, [*n]; the caller frees them. */
kz_resilience *kz_resilience_list(const kz_dynamics *dynamics, const kz_catalogue *catalogue, int64_t *n);

/* Fills point [n] on every rank, in a kept stage. Collective. */
kz_status kz_resilience_run(const kz_run *run, kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n,
                            kz_resilience *point);

/* Does the same for one of the points, to measure its time; *own = number of points that are not mirror images of others. */
kz_status kz_resilience_try(kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n, const kz_resilience *point,
                            int64_t *own);

#endif
