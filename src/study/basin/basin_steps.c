/* The steps of a basin: chosen, checked and reported beside its cells. */
#include <math.h>

#include "accuracy/reference.h"
#include "basin.h"
#include "common/step_check.h"

static kz_motions motions_of_basin(const kz_scene *scene) {
  kz_motions motions =
      kz_motions_of(scene, kz_axis_fastest(&scene->basin.velocity), "numerics.steps_per_period|basin.velocity");
  kz_motions_label_cells(&scene->basin, &motions);
  return motions;
}

void kz_steps_choose(kz_scene *scene) {
  kz_numerics chosen;
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  scene->numerics.steps_per_period = scheme.default_steps;
  if (!scene->has_basin || !isnan(scene->basin.accuracy) || !(scene->parameters.pendulum.beta > 0)) return;
  const kz_motions motions = motions_of_basin(scene);
  if (motions.lost < KZ_STEPS_LOST && kz_motions_find_steps(&motions, &chosen)) scene->numerics = chosen;
}

/* Without damping nothing is labelled. What basin.accuracy chooses is compared with reference labels. */
kz_status kz_basin_check(const kz_scene *scene) {
  const kz_motions motions = motions_of_basin(scene);
  kz_numerics reference;
  if (!(motions.pendulum.beta > 0)) return KZ_OK;
  if (isnan(scene->basin.accuracy)) return kz_motions_check(&motions);
  return kz_reference_labels_numerics(&scene->basin, &motions.pendulum, &reference);
}

double kz_basin_warn_steps(const kz_scene *scene, FILE *summary) {
  const kz_motions motions = motions_of_basin(scene);
  const kz_speed_errors classes = kz_step_error_classes(&motions.pendulum, &motions.numerics, motions.fastest);
  const double worst = kz_worst_error(&classes);
  kz_scheme scheme;
  kz_scheme_row(motions.numerics.scheme, &scheme);
  fprintf(summary, "%s, %d steps a drive period", scheme.name, (int)motions.numerics.steps_per_period);
  if (motions.numerics.steps_per_period != scheme.default_steps)
    fprintf(summary, " (its own number is %d)", (int)scheme.default_steps);
  fprintf(summary, ": a period is off by at most %.2g rad, %.2g of a cell\n", worst, worst / motions.cell);
  kz_motions_warn(&motions, summary);
  return worst;
}
