/* Study `orbit`: its parts. */
#ifndef KAPITZA_STUDY_ORBIT_H
#define KAPITZA_STUDY_ORBIT_H

#include "features.h"

typedef struct {
  const kz_orbit_plan *plan;
  kz_pendulum pendulum;
  const kz_parameters *parameters;
  kz_model model;
  kz_cycle cycle; /* of a closed orbit; period 0 = open */
  kz_motion motion;
  kz_orbit_features features;
  double lyapunov,
      lyapunov_error; /* largest exponent along the record, per drive period; NaN for other models than the pendulum */
  bool parting;       /* neighbours of an open record separate for good */
  char settles_on[KZ_NAME_LENGTH]; /* name of the attractor that an open record of the pendulum leads to; "" = none is known */
} kz_orbit;

/* Group /orbit of the file. */
kz_status kz_orbit_write(const kz_orbit *orbit, kz_store *store);
/* A line for people. */
void kz_orbit_print(const kz_orbit *orbit, FILE *summary);

kz_cost kz_orbit_cost(const kz_scene *scene);
kz_status kz_orbit_measure(const kz_scene *scene, double *seconds);
kz_status kz_orbit_check(const kz_scene *scene);
kz_status kz_orbit_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);

/* What the study writes. */
extern const kz_variable kz_orbit_variables[];

#endif
