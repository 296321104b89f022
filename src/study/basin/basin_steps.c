/* The steps of a basin: checked and reported beside its cells. */
#include <math.h>

#include "accuracy/reference.h"
#include "basin.h"
#include "numerics/resolve.h"
#include "pairs.h"
#include "proof.h"

static void print_numerics(const kz_scene *scene, FILE *summary) {
  const kz_numerics *numerics = &scene->numerics;
  const kz_scheme scheme = kz_scheme_at(numerics->scheme);
  fprintf(summary, "Integrator: %s%s, %d steps per drive period", scheme.name,
          kz_is_processed(numerics->scheme) ? " splitting" : "", (int)numerics->steps_per_period);
  if (kz_is_processed(scene->asked.scheme) && !kz_is_processed(numerics->scheme) && isnan(scene->basin.accuracy))
    fprintf(summary, " (processed does not reach numerics.tolerance = %g for this pendulum)", scene->asked.tolerance);
  else if (!kz_is_processed(numerics->scheme) && numerics->steps_per_period != scheme.default_steps)
    fprintf(summary, " (its default is %d)", (int)scheme.default_steps);
}

/* Without damping nothing is labelled. What basin.accuracy chooses is compared with reference labels. */
kz_status kz_basin_check(const kz_scene *scene) {
  const kz_motions motions = kz_motions_of_basin(scene);
  kz_numerics reference;
  if (!(motions.pendulum.beta > 0)) return KZ_OK;
  KZ_TRY(kz_pairs_check(&scene->basin));
  kz_proof *proof;
  const kz_status status = kz_proof_plan(scene, &proof);
  kz_proof_free(proof);
  KZ_TRY(status);
  if (isnan(scene->basin.accuracy)) return kz_motions_check(&motions);
  return kz_reference_labels_numerics(&scene->basin, &motions.pendulum, &reference);
}

double kz_basin_warn_steps(const kz_scene *scene, FILE *summary) {
  const kz_motions motions = kz_motions_of_basin(scene);
  const kz_speed_errors classes = kz_motions_errors(&motions);
  const double worst = kz_worst_error(&classes);
  print_numerics(scene, summary);
  fprintf(summary, " (error per period <= %.2g rad, %.2g of a cell).\n", worst, worst / motions.cell);
  kz_motions_warn(&motions, &classes, summary);
  return worst;
}
