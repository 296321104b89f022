/* Where running states are born without any drive: the motion that leaves the saddle, inverted but for the torque,
 * comes back to it a turn later, on a homoclinic orbit. With more torque it passes the saddle and runs on, with less it
 * falls back. */
#include "sweep.h"

enum { SAMPLES = 96, MOST_PERIODS = 4000, HALVINGS = 100 };
static const double LEAVES = 1e-6; /* rad: distance of the first state from the saddle, in its unstable direction */

/* Whether the motion that leaves the saddle with a velocity of this sign passes the next one. */
static bool running_passes(const kz_pendulum *p, int sign) {
  double theta[SAMPLES + 1], velocity[SAMPLES + 1];
  const double saddle = p->k > 0 ? M_PI - asin(p->torque / p->k) : asin(p->torque / p->k);
  const double rate = (sqrt(p->beta * p->beta - 4 * p->k * cos(saddle)) - p->beta) / 2;
  kz_numerics fine;
  kz_numerics_fine(p, &fine);
  KZ_AUTOFREE_BY(kz_flow_freed) kz_flow *flow = kz_flow_create(p, &fine);
  theta[SAMPLES] = saddle + sign * LEAVES, velocity[SAMPLES] = sign * rate * LEAVES;
  for (int period = 0; period < MOST_PERIODS; period++) {
    kz_sample(flow, 1, SAMPLES, theta[SAMPLES], velocity[SAMPLES], theta, velocity);
    for (int i = 1; i <= SAMPLES; i++) {
      if (sign * velocity[i] <= 0) return false;
      if (sign * (theta[i] - saddle) >= 2 * M_PI) return true;
    }
  }
  return false;
}

/* 1 if the pendulum at a value has a running state of this sign, 0 if not, -1 where that is not known. */
static int running_runs(const kz_path *path, double value, int sign) {
  kz_pendulum p;
  if (!path->pendulum(path->context, value, &p) || kz_is_driven(&p) || !(p.beta > 0)) return -1;
  return fabs(p.torque) >= fabs(p.k) ? sign * p.torque > 0 : running_passes(&p, sign);
}

double kz_running_birth(const kz_path *path, int32_t winding) {
  double with = path->from, without = path->to;
  if (running_runs(path, with, winding) != 1 || running_runs(path, without, winding) != 0) return NAN;
  for (int i = 0; i < HALVINGS; i++) {
    const double middle = with + (without - with) / 2;
    const int here = running_runs(path, middle, winding);
    if (here < 0) return NAN;
    if (middle == with || middle == without) break;
    *(here ? &with : &without) = middle;
  }
  return with;
}
