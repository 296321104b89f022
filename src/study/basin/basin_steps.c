/* The steps of a basin: chosen, checked and reported beside its cells. */
#include <math.h>

#include "accuracy/reference.h"
#include "basin.h"
#include "numerics/processed.h"
#include "numerics/step_check.h"
#include "proof.h"

static kz_motions motions_of_basin(const kz_scene *scene) {
  kz_motions motions =
      kz_motions_of(scene, kz_axis_fastest(&scene->basin.velocity), "numerics.steps_per_period|basin.velocity");
  if (scene->basin.method == KZ_METHOD_EXACT) /* errors are followed: they need not be small beside a cell */
    motions.cell = kz_cell_size(&scene->basin);
  else
    kz_motions_label_cells(&scene->basin, &motions);
  return motions;
}

/* The scheme's own number of steps, or more for small cells; `enough`: or more for any cells. */
static void choose_steps(kz_scene *scene, bool enough) {
  kz_numerics chosen;
  kz_scheme scheme;
  kz_scheme_row(scene->numerics.scheme, &scheme);
  scene->numerics.steps_per_period = scheme.default_steps;
  if (!scene->has_basin || !isnan(scene->basin.accuracy) || !(scene->parameters.pendulum.beta > 0)) return;
  const kz_motions motions = motions_of_basin(scene);
  if ((enough || motions.lost < KZ_STEPS_LOST) && kz_motions_find_steps(&motions, &chosen)) scene->numerics = chosen;
}

void kz_numerics_resolve(kz_scene *scene) {
  const kz_numerics_keys *asked = &scene->asked;
  const bool processed = kz_is_processed(asked->scheme);
  if (processed && kz_processed_choose(scene)) return;
  scene->numerics = (kz_numerics){.scheme = processed ? kz_scheme_find("split6") : asked->scheme,
                                  .steps_per_period = asked->steps_per_period};
  if (processed || asked->steps_per_period == KZ_AUTO) choose_steps(scene, processed);
}

static void print_numerics(const kz_scene *scene, FILE *summary) {
  const kz_numerics *numerics = &scene->numerics;
  kz_scheme scheme;
  kz_scheme_row(numerics->scheme, &scheme);
  fprintf(summary, "%s, %d steps a drive period", scheme.name, (int)numerics->steps_per_period);
  if (kz_is_processed(scene->asked.scheme) && !kz_is_processed(numerics->scheme) && isnan(scene->basin.accuracy))
    fprintf(summary, " (processed does not reach numerics.tolerance = %g here)", scene->asked.tolerance);
  else if (!kz_is_processed(numerics->scheme) && numerics->steps_per_period != scheme.default_steps)
    fprintf(summary, " (its own number is %d)", (int)scheme.default_steps);
}

/* Pairs that are nearer than doubles can tell need labels in more precision. */
static kz_status check_boundary(const kz_basin_plan *plan) {
  const bool exact = isnan(plan->accuracy) ? plan->method == KZ_METHOD_EXACT : plan->accuracy >= 1;
  if (!plan->has_boundary || plan->boundary.decades <= KZ_BOUNDARY_DECADES || exact) return KZ_OK;
  return kz_fail(
      KZ_REFUSED,
      "basin.boundary.decades: %lld go down to 1e-%lld rad, which double precision does not tell apart; it must be %d "
      "at most, or basin.method exact",
      (long long)plan->boundary.decades, (long long)plan->boundary.decades + 2, KZ_BOUNDARY_DECADES);
}

/* Without damping nothing is labelled. What basin.accuracy chooses is compared with reference labels. */
kz_status kz_basin_check(const kz_scene *scene) {
  const kz_motions motions = motions_of_basin(scene);
  kz_numerics reference;
  if (!(motions.pendulum.beta > 0)) return KZ_OK;
  KZ_TRY(check_boundary(&scene->basin));
  kz_proof *proof;
  const kz_status status = kz_proof_plan(scene, &proof);
  kz_proof_free(proof);
  KZ_TRY(status);
  if (isnan(scene->basin.accuracy)) return kz_motions_check(&motions);
  if (scene->basin.accuracy >= 1) return KZ_OK;
  return kz_reference_labels_numerics(&scene->basin, &motions.pendulum, &reference);
}

double kz_basin_warn_steps(const kz_scene *scene, FILE *summary) {
  const kz_motions motions = motions_of_basin(scene);
  const kz_speed_errors classes = kz_motions_errors(&motions);
  const double worst = kz_worst_error(&classes);
  print_numerics(scene, summary);
  fprintf(summary, ": a period is off by at most %.2g rad, %.2g of a cell\n", worst, worst / motions.cell);
  kz_motions_warn(&motions, &classes, summary);
  return worst;
}
