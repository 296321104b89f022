#include "catalogue.h"

#include <math.h>
#include <stdlib.h>

static const double two_pi = 6.28318530717958647692;

double kz_point_distance(double theta, double velocity, const kz_strobe_point *point) {
  return hypot(remainder(theta - point->theta, two_pi), velocity - point->velocity);
}

static bool read_pendulum(FILE *in, kz_pendulum *p) {
  if (fscanf(in, "%lf %lf %lf %lf %lf %d", &p->k, &p->beta, &p->m, &p->torque, &p->torque_amplitude, &p->harmonics) !=
      6)
    return false;
  if (p->harmonics < 0 || p->harmonics > KZ_HARMONICS) return false;
  p->unmirrored = p->torque != 0 || p->torque_amplitude != 0;
  for (int j = 0; j < p->harmonics; j++) {
    double *up = p->vertical[j], *aside = p->horizontal[j];
    if (fscanf(in, "%lf %lf %lf %lf", &up[0], &up[1], &aside[0], &aside[1]) != 4) return false;
    if (aside[0] != 0 || aside[1] != 0) p->unmirrored = 1;
  }
  return true;
}

static bool read_attractor(FILE *in, kz_catalogue *c, int attractor) {
  int period;
  if (fscanf(in, "%d", &period) != 1 || period < 1) return false;
  kz_strobe_point *points = realloc(c->points, (size_t)(c->n_points + period) * sizeof *points);
  if (!points) return false;
  c->points = points;
  for (int phase = 0; phase < period; phase++) {
    kz_strobe_point *point = &points[c->n_points + phase];
    if (fscanf(in, "%lf %lf", &point->theta, &point->velocity) != 2) return false;
    point->attractor = attractor;
    point->next = c->n_points + (phase + 1) % period;
  }
  c->n_points += period;
  return true;
}

bool kz_catalogue_read(FILE *in, kz_catalogue *catalogue) {
  int n_attractors;
  *catalogue = (kz_catalogue){0};
  kz_pendulum *pendulum = &catalogue->pendulum;
  if (!read_pendulum(in, pendulum)) return false;
  if (fscanf(in, "%ld %d", &catalogue->max_periods, &n_attractors) != 2) return false;
  for (int attractor = 0; attractor < n_attractors; attractor++)
    if (!read_attractor(in, catalogue, attractor)) return false;
  return true;
}

void kz_catalogue_free(kz_catalogue *catalogue) {
  free(catalogue->points);
  *catalogue = (kz_catalogue){0};
}
