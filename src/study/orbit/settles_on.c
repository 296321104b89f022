#include "settles_on.h"

#include <math.h>

#include "attractors/search.h"

/* Periods that a motion is followed: what damping takes to shrink areas by exp(-SHRUNK), within bounds. */
enum { SHRUNK = 30, LEAST_PERIODS = 2000, MOST_STEPS = 1000000, LONGEST_CYCLE = 48 };

static void name_attractor(const kz_dynamics *dynamics, int64_t number, char *name) {
  kz_attractor row;
  kz_dynamics_attractor(dynamics, number, &row);
  kz_orbit_name(row.period, row.winding, row.centre, name);
}

kz_status kz_settles_on(const kz_model *model, kz_state state, double fastest, char *name) {
  const double beta = model->pendulum.beta;
  name[0] = '\0';
  if (!(beta > 0)) return KZ_OK;
  const double periods = fmin(MOST_STEPS / model->numerics.steps_per_period, fmax(LEAST_PERIODS, SHRUNK / (2 * M_PI * beta)));
  const kz_window window = {-M_PI, M_PI, -fastest, fastest};
  double start[2] = {remainder(state.theta, 2 * M_PI) / M_PI, state.velocity};
  int32_t label;
  kz_dynamics *dynamics = kz_dynamics_create(&model->pendulum, &model->numerics, LONGEST_CYCLE);
  kz_dynamics_coarse_regions(dynamics, kz_dynamics_max_velocity(dynamics, &window));
  const kz_status status = kz_discover(NULL, dynamics, (int64_t)periods, 1, start, &label);
  if (status == KZ_OK && label > 0) name_attractor(dynamics, label, name);
  kz_dynamics_free(dynamics);
  return status;
}
