/* Study `potential`. One rank does it all: at most some hundred curves in closed form. */
#include "potential.h"

#include <math.h>
#include <stdlib.h>

#include "kapitza/analysis.h"

static const char *const GROUP = "potential";

/* Energies are [amplitude][theta]. */
typedef struct {
  const kz_potential_plan *plan;
  double *theta, *exact, *blackburn, *simple;
  double rim[KZ_LIST_MAX], rim_exact[KZ_LIST_MAX];
  uint8_t stable[KZ_LIST_MAX];
} curves;

kz_cost kz_potential_cost(const kz_scene *scene) {
  double points = (double)scene->potential.drive_amplitudes.count * (double)scene->potential.theta_count;
  return (kz_cost){.disk_bytes = 24 * points, .rank0_bytes = 24 * points};
}

static void potential_allocate(curves *c) {
  size_t columns = (size_t)c->plan->theta_count, points = columns * (size_t)c->plan->drive_amplitudes.count;
  c->theta = kz_malloc(columns * sizeof(double));
  c->exact = kz_malloc(points * sizeof(double));
  c->blackburn = kz_malloc(points * sizeof(double));
  c->simple = kz_malloc(points * sizeof(double));
}

static void release(curves *c) {
  free(c->theta);
  free(c->exact);
  free(c->blackburn);
  free(c->simple);
}

/* The whole circle from -pi to pi, both ends included. */
static void model(const kz_pendulum *pendulum, curves *c) {
  int64_t columns = c->plan->theta_count;
  for (int64_t i = 0; i < columns; i++) c->theta[i] = M_PI * (double)(2 * i - (columns - 1)) / (double)(columns - 1);
  for (int64_t j = 0; j < c->plan->drive_amplitudes.count; j++) {
    double m = c->plan->drive_amplitudes.values[j];
    kz_rim rim;
    kz_potential_rim(pendulum->k, pendulum->beta, m, &rim);
    c->rim[j] = rim.simple;
    c->rim_exact[j] = rim.exact;
    c->stable[j] = rim.stable_inverted;
    for (int64_t i = 0; i < columns; i++) {
      kz_energy energy;
      kz_potential_energy(pendulum->k, pendulum->beta, m, c->theta[i], &energy);
      c->exact[j * columns + i] = energy.exact;
      c->blackburn[j * columns + i] = energy.blackburn;
      c->simple[j * columns + i] = energy.simple;
    }
  }
}

static kz_status write(const curves *c, kz_store *store) {
  const kz_reals *amplitudes = &c->plan->drive_amplitudes;
  KZ_TRY(kz_store_dimension(store, GROUP, "theta", c->plan->theta_count, c->theta));
  KZ_TRY(kz_store_dimension(store, GROUP, "drive_amplitude", amplitudes->count, amplitudes->values));
  KZ_TRY(kz_store_variable(store, GROUP, "energy", c->exact));
  KZ_TRY(kz_store_variable(store, GROUP, "energy_blackburn", c->blackburn));
  KZ_TRY(kz_store_variable(store, GROUP, "energy_simple", c->simple));
  KZ_TRY(kz_store_variable(store, GROUP, "rim", c->rim));
  KZ_TRY(kz_store_variable(store, GROUP, "rim_exact", c->rim_exact));
  return kz_store_variable(store, GROUP, "stable_inverted", c->stable);
}

static void summarise(const curves *c, FILE *summary) {
  fprintf(summary, "potential: wells about the inverted position\n");
  for (int64_t j = 0; j < c->plan->drive_amplitudes.count; j++) {
    double m = c->plan->drive_amplitudes.values[j];
    if (!c->stable[j])
      fprintf(summary, "  m = %g: none\n", m);
    else
      fprintf(summary, "  m = %g: out to %.4g deg from the top (simple formula %.4g deg)\n", m,
              180 - c->rim_exact[j] * 180 / M_PI, 180 - c->rim[j] * 180 / M_PI);
  }
}

kz_status kz_potential_measure(const kz_scene *scene, double *seconds) {
  enum { ANGLES = 32 };
  const kz_potential_plan *plan = &scene->potential;
  const kz_pendulum *p = &scene->parameters.pendulum;
  kz_energy energy;
  const double start = kz_processor_clock();
  for (int i = 0; i < ANGLES; i++)
    kz_potential_energy(p->k, p->beta, plan->drive_amplitudes.values[0], M_PI * i / ANGLES, &energy);
  *seconds += (kz_processor_clock() - start) / ANGLES * (double)(plan->drive_amplitudes.count * plan->theta_count);
  return KZ_OK;
}

kz_status kz_potential_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  if (kz_rank(run->ranks) != 0) return KZ_OK;
  curves c = {.plan = &scene->potential};
  potential_allocate(&c);
  model(&scene->parameters.pendulum, &c);
  const kz_status status = write(&c, store);
  if (status == KZ_OK) summarise(&c, summary);
  release(&c);
  return status;
}
