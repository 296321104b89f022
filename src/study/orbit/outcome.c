/* How a motion of the pendulum goes on: its largest Lyapunov exponent, and the attractor that it settles on. */
#include "labelling/search.h"
#include "orbit.h"

/* Blocks of a record; periods that an exponent is followed on. */
enum { BLOCKS = 10, LEAST_AHEAD = 1000, MOST_AHEAD = 100000 };
/* Periods that a motion is followed: what damping takes to shrink areas by exp(-SHRUNK), within bounds. */
enum { SHRUNK = 30, LEAST_PERIODS = 2000, MOST_STEPS = 1000000, LONGEST_CYCLE = 48 };
/* The most steps a period with which an open record is looked ahead. */
enum { AHEAD_STEPS = 1500 };
/* An orbit that starts within rounding (1e-16) of an unstable cycle has left it when its neighbours have parted by
 * exp(ESCAPE). */
static const double ESCAPE = 40;
/* An exponent counts as positive if it exceeds so many standard errors. */
static const double CONFIDENCE = 5;

/* Carries a unit deviation through one period; returns the logarithm of its growth. */
static double ahead_growth(const kz_model *model, kz_state *x, double *deviation) {
  double matrix[4];
  int64_t turns = 0;
  kz_advance_tangent(model->flow, 1, 1, &x->theta, &x->velocity, &turns, matrix);
  const double a = matrix[0] * deviation[0] + matrix[1] * deviation[1];
  const double b = matrix[2] * deviation[0] + matrix[3] * deviation[1];
  const double length = hypot(a, b);
  deviation[0] = a / length;
  deviation[1] = b / length;
  return log(length);
}

static void exponent_along(const kz_model *model, int64_t periods, kz_state start, double *mean, double *error) {
  double deviation[2] = {1, 0}, block[BLOCKS] = {0}, total = 0, square = 0;
  const int64_t length = periods / BLOCKS; /* periods that do not fill the blocks come first and are left out */
  for (int64_t i = 0; i < periods - BLOCKS * length; i++) ahead_growth(model, &start, deviation);
  for (int64_t i = 0; i < BLOCKS * length; i++)
    block[i / length] += ahead_growth(model, &start, deviation) / (double)length;
  for (int i = 0; i < BLOCKS; i++) total += block[i] / BLOCKS;
  for (int i = 0; i < BLOCKS; i++) square += (block[i] - total) * (block[i] - total);
  *mean = length > 0 ? total : NAN;
  *error = length > 0 ? sqrt(square / (BLOCKS * (BLOCKS - 1))) : NAN;
}

void kz_orbit_exponent(kz_orbit *orbit) {
  exponent_along(&orbit->model, orbit->motion.periods, orbit->cycle.state, &orbit->lyapunov, &orbit->lyapunov_error);
}

static bool is_positive(double mean, double error) {
  return mean > 0 && mean > CONFIDENCE * error;
}

/* Whether the exponent from `start` on is still positive. `mean` is that of the past; it gives the number of periods,
 * so many that an orbit near an unstable cycle has left it. */
static bool stays_positive(const kz_model *model, kz_state start, double mean) {
  double later, error, periods = fmax(LEAST_AHEAD, ceil(2 * ESCAPE / mean));
  if (!(periods <= MOST_AHEAD)) return false;
  exponent_along(model, (int64_t)periods, start, &later, &error);
  return is_positive(later, error) && later * periods > ESCAPE;
}

/* The name of the attractor that the pendulum settles on from a state; "" if there is none, or if it has not settled
 * within the periods that the damping needs. `fastest` = a velocity that the motion reaches. */
static kz_status find_attractor(const kz_model *model, kz_state state, double fastest, char *name) {
  const double beta = model->pendulum.beta;
  if (!(beta > 0)) return KZ_OK;
  const double periods =
      fmin(MOST_STEPS / model->numerics.steps_per_period, fmax(LEAST_PERIODS, SHRUNK / (2 * M_PI * beta)));
  const kz_window window = {-M_PI, M_PI, -fastest, fastest};
  double start[2] = {remainder(state.theta, 2 * M_PI) / M_PI, state.velocity};
  int32_t label;
  kz_attractor row;
  KZ_AUTOFREE_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_dynamics_create(&model->pendulum, &model->numerics, LONGEST_CYCLE);
  kz_dynamics_regions(dynamics, 0, kz_dynamics_max_velocity(dynamics, &window));
  KZ_TRY(kz_discover(NULL, dynamics, 0, (int64_t)periods, 1, start, &label));
  if (label <= 0) return KZ_OK;
  kz_dynamics_attractor(dynamics, label, &row);
  kz_orbit_name(row.period, row.winding, row.centre, name);
  return KZ_OK;
}

kz_status kz_orbit_look_ahead(kz_orbit *orbit) {
  const kz_model *model = &orbit->model;
  const kz_orbit_motion *motion = &orbit->motion;
  const int64_t last = motion->periods * motion->samples;
  const kz_state end = {remainder(motion->theta[last], 2 * M_PI), motion->velocity[last]};
  double fastest = 0;
  if (model->numerics.steps_per_period > AHEAD_STEPS) return KZ_OK;
  orbit->parting = is_positive(orbit->lyapunov, orbit->lyapunov_error) && stays_positive(model, end, orbit->lyapunov);
  if (orbit->parting) return KZ_OK;
  for (int64_t i = last - motion->samples; i <= last; i++) fastest = fmax(fastest, fabs(motion->velocity[i]));
  return find_attractor(model, end, fastest, orbit->settles_on);
}
