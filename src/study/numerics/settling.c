/* How long motions take to settle. Damping shrinks areas by e in 1/(2 pi beta) periods, its lifetime; the weaker it is,
 * the smaller are the trapping regions and the more lifetimes it takes to get there. */
#include "kapitza/study_basin.h"
#include "sweep/plan.h"

/* Mean number of lifetimes until a motion is trapped: that times the logarithm of the lifetime. Measured at Q = 5, 20,
 * 50, 200, 1000 (Omega = 11 and 8): 3.4, 5.9, 7.5, 10.9, 14.3 lifetimes of 9, 25, 88, 350, 1751 periods; 999 of 1000
 * are trapped within 21. */
static const double MEAN_LIFETIMES = 1.9, ALL_LIFETIMES = 40;
static const double LEAST = 2000, MOST = 1e6;

static double settling_lifetime(double beta) {
  return 1 / (2 * M_PI * beta);
}

double kz_settling_mean(double beta) {
  return MEAN_LIFETIMES * settling_lifetime(beta) * log(M_E + settling_lifetime(beta));
}

int64_t kz_settling_periods(double beta) {
  const double wanted = beta > 0 ? 100 * ceil(ALL_LIFETIMES / 100 * settling_lifetime(beta)) : 0;
  return (int64_t)(wanted > MOST ? LEAST : fmax(wanted, LEAST));
}

/* Damping changes one way along every key, so that it is weakest at an end. */
static double weakest_damping(const kz_scene *scene) {
  double beta = scene->parameters.pendulum.beta;
  const double ends[] = {scene->sweep->values.min, scene->sweep->values.max};
  kz_pendulum pendulum;
  for (int i = 0; scene->has_sweep && !kz_sweep_is_plane(scene->sweep) && i < 2; i++)
    if (kz_sweep_pendulum(scene, ends[i], &pendulum) && pendulum.beta > 0)
      beta = beta > 0 ? fmin(beta, pendulum.beta) : pendulum.beta;
  return beta;
}

int64_t kz_settling_scene(const kz_scene *scene) {
  return kz_settling_periods(weakest_damping(scene));
}

static void settling_warn(const char *key, double beta, int64_t max_periods, FILE *out) {
  const double mean = kz_settling_mean(beta);
  const int64_t enough = kz_settling_periods(beta);
  if ((double)max_periods >= mean / 2) return;
  fprintf(out, "warning: %s: few motions settle within %lld drive periods: with damping %g they need some %.2g; ", key,
          (long long)max_periods, beta, mean);
  if ((double)enough >= mean)
    fprintf(out, "give %lld, or leave it out\n", (long long)enough);
  else
    fprintf(out, "give more damping\n");
}

void kz_settling_warn(const kz_scene *scene, FILE *out) {
  const double beta = weakest_damping(scene);
  if (!(beta > 0) && (scene->has_basin || scene->has_attractors))
    fputs(
        "warning: pendulum: has no damping, so there are no attractors and no start gets a label; give damping, or ask "
        "for "
        "orbit or saddles\n",
        out);
  if (!(beta > 0)) return;
  if (scene->has_basin) settling_warn("basin.max_periods", beta, scene->basin->max_periods, out);
  if (scene->has_attractors) settling_warn("pendulum", beta, kz_settling_periods(beta), out);
}
