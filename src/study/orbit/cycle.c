/* Closed orbits: their period and their exact place. */
#include <math.h>

#include "kapitza/dynamics.h"
#include "orbit.h"

/* A cycle must lie this near to the start (rad), or Newton has gone to another one. */
static const double MAX_DISTANCE = 0.3;
/* Linear orbits count as closed when they come back to this share of their size. */
static const double CLOSED = 1e-9;
enum { MOST_PERIODS = 512 };

/* Newton from `start` for period n; the cycle then has its smallest period. */
static bool close_with(const kz_model *model, int64_t n, kz_state start, kz_cycle *cycle) {
  KZ_FREED double *theta = kz_malloc((size_t)n * sizeof *theta), *velocity = kz_malloc((size_t)n * sizeof *velocity);
  theta[0] = start.theta;
  velocity[0] = start.velocity;
  kz_dynamics_close_cycle(&model->pendulum, &model->numerics, n, MAX_DISTANCE, theta, velocity, &cycle->row);
  cycle->period = cycle->row.period;
  cycle->state = (kz_state){theta[0], velocity[0]};
  return cycle->period > 0;
}

/* The shortest return within ever wider distances that Newton confirms. */
static kz_status find(const kz_model *model, kz_state start, kz_cycle *cycle) {
  static const double WITHIN[] = {1e-6, 1e-4, 1e-2, 1e-1};
  double back[MOST_PERIODS + 1];
  kz_state x = start;
  for (int n = 1; n <= MOST_PERIODS; n++) {
    kz_model_skip(model, 1, &x);
    back[n] = hypot(remainder(x.theta - start.theta, 2 * M_PI), x.velocity - start.velocity);
  }
  for (size_t i = 0; i < sizeof WITHIN / sizeof WITHIN[0]; i++) {
    for (int n = 1; n <= MOST_PERIODS; n++)
      if (back[n] < WITHIN[i] && close_with(model, n, start, cycle)) return KZ_OK;
  }
  return kz_fail(KZ_FAILED,
                 "orbit.closed: no cycle of up to %d periods near theta = %.9g, velocity = %.9g; give a nearer start, a longer "
                 "transient, or the period",
                 MOST_PERIODS, start.theta, start.velocity);
}

/* The linear model scales: its orbits close or not. */
static kz_status check_linear(const kz_model *model, int64_t period, kz_state start, kz_cycle *cycle) {
  *cycle = (kz_cycle){start, period, {.multiplier_re = {NAN, NAN}, .multiplier_im = {NAN, NAN}}};
  kz_state end = start;
  kz_model_skip(model, period, &end);
  double gap = hypot(end.theta - start.theta, end.velocity - start.velocity);
  if (gap <= CLOSED * hypot(start.theta - model->origin, start.velocity)) return KZ_OK;
  return kz_fail(KZ_FAILED,
                 "orbit.closed: the linear motion ends %.3g from its start after %lld periods; choose parameters on a curve of "
                 "this period, or leave closed out",
                 gap, (long long)period);
}

kz_status kz_cycle_close(const kz_model *model, int64_t period, kz_state start, kz_cycle *cycle) {
  if (!model->flow) return check_linear(model, period, start, cycle);
  if (period == 0) return find(model, start, cycle);
  if (!close_with(model, period, start, cycle))
    return kz_fail(KZ_FAILED,
                   "orbit.closed: no cycle of %lld periods within %g of theta = %.9g, velocity = %.9g; give a nearer start",
                   (long long)period, MAX_DISTANCE, start.theta, start.velocity);
  if (cycle->period == period) return KZ_OK;
  return kz_fail(KZ_FAILED,
                 "orbit.period: is %lld, but the cycle found there closes after %lld; give that period, or a nearer start",
                 (long long)period, (long long)cycle->period);
}
