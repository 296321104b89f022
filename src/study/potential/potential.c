/* Study `potential`. One rank does it all: at most some hundred curves in closed form. */
#include "plan.h"

static const char *const GROUP = "potential";

kz_cost kz_potential_cost(const kz_scene *scene) {
  double points = (double)scene->potential->drive_amplitudes.count * (double)scene->potential->theta_count;
  return (kz_cost){.disk_bytes = 24 * points, .rank0_bytes = 24 * points};
}

/* Angle i of the whole circle from -pi to pi, both ends included. */
static double angle_of(const kz_potential_plan *plan, int64_t i) {
  return M_PI * (double)(2 * i - (plan->theta_count - 1)) / (double)(plan->theta_count - 1);
}

#define COLUMN(name, n, type, expression) KZ_COLUMN(store, GROUP, name, n, type, expression)

/* energy [amplitude][theta], rim [amplitude] */
static kz_status potential_write(const kz_potential_plan *plan, const kz_energy *energy, const kz_rim *rim,
                                 kz_store *store) {
  const int64_t n = plan->drive_amplitudes.count, points = n * plan->theta_count;
  KZ_SCALE(store, GROUP, "theta", plan->theta_count, angle_of(plan, i));
  KZ_SCALE(store, GROUP, "drive_amplitude", n, plan->drive_amplitudes.values[i]);
  COLUMN("energy", points, double, energy[i].exact);
  COLUMN("energy_blackburn", points, double, energy[i].blackburn);
  COLUMN("energy_simple", points, double, energy[i].simple);
  COLUMN("rim", n, double, rim[i].simple);
  COLUMN("rim_exact", n, double, rim[i].exact);
  COLUMN("stable_inverted", n, uint8_t, rim[i].stable_inverted);
  return KZ_OK;
}

static void potential_summarise(const kz_potential_plan *plan, const kz_rim *rim, FILE *summary) {
  fprintf(summary, "potential: wells about the inverted position\n");
  for (int64_t j = 0; j < plan->drive_amplitudes.count; j++) {
    const double m = plan->drive_amplitudes.values[j];
    if (!rim[j].stable_inverted)
      fprintf(summary, "  m = %g: none\n", m);
    else
      fprintf(summary, "  m = %g: out to %.4g deg from the top (simple formula %.4g deg)\n", m,
              180 - rim[j].exact * 180 / M_PI, 180 - rim[j].simple * 180 / M_PI);
  }
}

kz_status kz_potential_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_potential_plan *plan = scene->potential;
  const kz_pendulum *p = &scene->parameters.pendulum;
  const int64_t columns = plan->theta_count;
  KZ_AUTOFREE kz_energy *energy = kz_malloc((size_t)(columns * plan->drive_amplitudes.count) * sizeof *energy);
  kz_rim rim[KZ_LIST_MAX];
  if (kz_rank(run->ranks) != 0) return KZ_OK;
  for (int64_t j = 0; j < plan->drive_amplitudes.count; j++) {
    const double m = plan->drive_amplitudes.values[j];
    kz_potential_rim(p->k, p->beta, m, rim + j);
    for (int64_t i = 0; i < columns; i++)
      kz_potential_energy(p->k, p->beta, m, angle_of(plan, i), energy + j * columns + i);
  }
  KZ_TRY(potential_write(plan, energy, rim, store));
  potential_summarise(plan, rim, summary);
  return KZ_OK;
}
