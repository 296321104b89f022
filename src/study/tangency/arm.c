#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "arm.h"

/* rad: a trace begins here; neighbours of a trace, about. */
static const double BESIDE = 1e-3, SPACING = 0.05;
/* Of places: neighbours of a trace. */
static const double WIDEST = 0.05;
enum { MOST_PLACES = 20000 };

/* The pendulum whose motions are those of `pendulum` in reversed time: (theta, -v) obeys the equation with -beta, and the sines of the drive change
 * their signs. */
static kz_pendulum reversed_time(const kz_pendulum *pendulum) {
  kz_pendulum back = *pendulum;
  back.beta = -pendulum->beta;
  for (int i = 0; i < KZ_HARMONICS; i++) {
    back.vertical[i][1] = -pendulum->vertical[i][1];
    back.horizontal[i][1] = -pendulum->horizontal[i][1];
  }
  return back;
}

/* The eigenvector of the larger multiplier over one return; over two if it is negative. */
static bool set_direction(kz_arm *arm) {
  double theta = arm->point[0], velocity = arm->point[1], a[4];
  int64_t turns = 0;
  kz_advance_tangent(arm->flow, 1, arm->periods, &theta, &velocity, &turns, a);
  const double half = (a[0] + a[3]) / 2, rest = half * half - (a[0] * a[3] - a[1] * a[2]);
  if (!(rest > 0)) return false;
  const double multiplier = half + copysign(sqrt(rest), half);
  double x = a[1], y = multiplier - a[0];
  if (hypot(x, y) < fabs(multiplier - a[3])) {
    x = multiplier - a[3];
    y = a[2];
  }
  arm->direction[0] = x / hypot(x, y);
  arm->direction[1] = y / hypot(x, y);
  arm->multiplier = multiplier > 0 ? multiplier : multiplier * multiplier;
  if (multiplier < 0) arm->periods *= 2;
  return fabs(multiplier) > 1;
}

bool kz_arm_make(const kz_pendulum *pendulum, const kz_hinge *hinge, int32_t phase, int32_t side, bool stable, double nearness,
                 kz_arm *arm) {
  const kz_pendulum own = stable ? reversed_time(pendulum) : *pendulum;
  kz_numerics fine;
  kz_numerics_fine(&own, &fine);
  *arm = (kz_arm){.flow = kz_flow_create(&own, &fine),
                  .point = {hinge->theta[phase], stable ? -hinge->velocity[phase] : hinge->velocity[phase]},
                  .nearness = nearness,
                  .periods = hinge->period,
                  .reversed = stable};
  const bool is_saddle = set_direction(arm);
  for (int i = 0; i < 2; i++) arm->direction[i] *= side;
  return is_saddle;
}

void kz_arm_free(kz_arm *arm) {
  kz_flow_free(arm->flow);
  arm->flow = NULL;
}

static kz_arm_point point_at(const kz_arm *arm, double place) {
  const double returns = floor(place), far = arm->nearness * pow(arm->multiplier, place - returns);
  double theta = arm->point[0] + far * arm->direction[0], velocity = arm->point[1] + far * arm->direction[1];
  double a[4] = {1, 0, 0, 1};
  int64_t turns = 0;
  if (returns > 0) kz_advance_tangent(arm->flow, 1, (int64_t)returns * arm->periods, &theta, &velocity, &turns, a);
  const double growth = far * log(arm->multiplier), sign = arm->reversed ? -1 : 1;
  return (kz_arm_point){theta,
                        sign * velocity,
                        {growth * (a[0] * arm->direction[0] + a[1] * arm->direction[1]),
                         sign * growth * (a[2] * arm->direction[0] + a[3] * arm->direction[1])}};
}

void kz_arm_points(const kz_arm *arm, int64_t n, const double *place, kz_arm_point *point) {
  for (int64_t i = 0; i < n; i++) point[i] = point_at(arm, place[i]);
}

kz_arm_trace kz_arm_trace_make(const kz_arm *arm, double length) {
  kz_arm_trace t = {.place = kz_malloc(MOST_PLACES * sizeof *t.place), .point = kz_malloc(MOST_PLACES * sizeof *t.point)};
  double at = log(BESIDE / arm->nearness) / log(arm->multiplier), so_far = 0;
  for (; t.n < MOST_PLACES && so_far < length; t.n++) {
    t.place[t.n] = at;
    t.point[t.n] = point_at(arm, at);
    const double speed = hypot(t.point[t.n].tangent[0], t.point[t.n].tangent[1]), step = fmin(WIDEST, SPACING / speed);
    if (!isfinite(speed) || !(at + step > at)) break;
    so_far += step * speed;
    at += step;
  }
  return t;
}

void kz_arm_trace_free(kz_arm_trace *trace) {
  free(trace->place);
  free(trace->point);
}
