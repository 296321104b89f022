/* The steps of a basin: checked and reported beside its cells. */
#include <math.h>

#include "accuracy/reference.h"
#include "basin.h"
#include "numerics/processed.h"
#include "numerics/resolve.h"
#include "proof.h"

static void print_numerics(const kz_scene *scene, FILE *summary) {
  const kz_numerics *numerics = &scene->numerics;
  kz_scheme scheme;
  kz_scheme_row(numerics->scheme, &scheme);
  fprintf(summary, "Integrator: %s%s, %d steps per drive period", scheme.name,
          kz_is_processed(numerics->scheme) ? " splitting" : "", (int)numerics->steps_per_period);
  if (kz_is_processed(scene->asked.scheme) && !kz_is_processed(numerics->scheme) && isnan(scene->basin.accuracy))
    fprintf(summary, " (processed does not reach numerics.tolerance = %g for this pendulum)", scene->asked.tolerance);
  else if (!kz_is_processed(numerics->scheme) && numerics->steps_per_period != scheme.default_steps)
    fprintf(summary, " (its default is %d)", (int)scheme.default_steps);
}

/* Pairs that are nearer than doubles can tell need labels in more precision. */
static kz_status check_boundary(const kz_basin_plan *plan) {
  const bool exact = isnan(plan->accuracy) && plan->method == KZ_METHOD_EXACT;
  if (!plan->has_boundary || plan->boundary.decades <= KZ_BOUNDARY_DECADES || exact) return KZ_OK;
  return kz_fail(
      KZ_REFUSED,
      "basin.boundary.decades: %lld go down to 1e-%lld rad, which double precision does not tell apart; it must be %d "
      "at most, or basin.method exact",
      (long long)plan->boundary.decades, (long long)plan->boundary.decades + 2, KZ_BOUNDARY_DECADES);
}

/* Without damping nothing is labelled. What basin.accuracy chooses is compared with reference labels. */
kz_status kz_basin_check(const kz_scene *scene) {
  const kz_motions motions = kz_motions_of_basin(scene);
  kz_numerics reference;
  if (!(motions.pendulum.beta > 0)) return KZ_OK;
  KZ_TRY(check_boundary(&scene->basin));
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
