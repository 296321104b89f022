/* The measure `ends`: tiles of points of the plane, each a pendulum of its own. */
#include "ends.h"

#include <math.h>
#include <string.h>

#include "numerics/cells.h"
#include "numerics/steps.h"
#include "sweep.h"

enum { LEAST_STEPS = 8, MOST_STEPS = 4000 };
/* Error that a drive period may have, rad: ends are cycles that Newton's method finds, and a motion only has to be led to its own. */
static const double TOLERANCE = 1e-8;

static int64_t points_of(const kz_sweep_plan *plan) {
  return plan->x.values.count * plan->y.values.count;
}

/* The pendulum of a point; false if there is none, or if it has no damping. */
static bool pendulum_of(const kz_scene *scene, int64_t point, kz_pendulum *pendulum) {
  const kz_sweep_plan *plan = scene->sweep;
  const int64_t columns = plan->x.values.count;
  const int32_t parameter[] = {plan->x.parameter, plan->y.parameter};
  const double value[] = {kz_axis_value(&plan->x.values, point % columns), kz_axis_value(&plan->y.values, point / columns)};
  return kz_pendulum_at(scene, 2, parameter, value, pendulum) && pendulum->beta > 0;
}

static int64_t periods_of(const kz_sweep_plan *plan, double beta) {
  return plan->ends.max_periods < 0 ? kz_settling_periods(beta) : plan->ends.max_periods;
}

kz_cost kz_ends_cost(const kz_scene *scene) {
  const kz_sweep_plan *plan = scene->sweep;
  const double motions = (double)points_of(plan) * (double)plan->ends.theta.count;
  return (kz_cost){.cells = (int64_t)motions,
                   .disk_bytes = 2 * motions * sizeof(kz_chart_ending),
                   .rank0_bytes = 3 * motions * sizeof(kz_chart_ending)};
}

/* Steps of split6 that keep the error of a period of the strongest of n pendulums. */
static int32_t steps_for(int64_t n, const kz_pendulum *pendulum, double start_speed) {
  const kz_pendulum *strongest = pendulum;
  for (int64_t i = 1; i < n; i++)
    if (kz_stiffness(pendulum + i) > kz_stiffness(strongest)) strongest = pendulum + i;
  kz_numerics numerics = kz_steps_plain();
  numerics.steps_per_period = (int32_t)fmin(kz_steps_by_stiffness(strongest, numerics.steps_per_period), MOST_STEPS);
  return kz_steps_scaled(strongest, &numerics, fmax(start_speed, 1 + 2 * sqrt(kz_stiffness(strongest))), TOLERANCE, LEAST_STEPS,
                         MOST_STEPS);
}

void kz_ends_points(const kz_scene *scene, int64_t place, int64_t n, const int64_t *point, kz_chart_ending *ending) {
  const kz_sweep_plan *plan = scene->sweep;
  KZ_FREED kz_pendulum *pendulum = kz_malloc((size_t)n * sizeof *pendulum);
  int64_t periods[KZ_ENDS_POINTS];
  double start[2];
  for (int64_t i = 0; i < n; i++) {
    const bool damped = pendulum_of(scene, point[i], pendulum + i);
    if (!damped) pendulum[i] = (kz_pendulum){0, 0, 0};
    periods[i] = damped ? periods_of(plan, pendulum[i].beta) : 0;
  }
  kz_start_state(plan->ends.theta.values[place], kz_ends_velocity(plan, place), start);
  kz_chart_ends(steps_for(n, pendulum, fabs(start[1])), n, pendulum, start, (int32_t)plan->ends.max_period, periods, ending);
  for (int64_t i = 0; i < n; i++)
    if (periods[i] == 0) ending[i] = (kz_chart_ending){.period = KZ_NO_PENDULUM, .centre = 3, .exponent = NAN};
}

static kz_status find_ends(void *context, int64_t first, int64_t n, void *record) {
  const kz_scene *scene = context;
  const int64_t points = points_of(scene->sweep);
  int64_t point[KZ_ENDS_POINTS];
  for (int64_t i = 0; i < n; i++) point[i] = first % points + i;
  kz_ends_points(scene, first / points, n, point, record);
  return KZ_OK;
}

kz_status kz_ends_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = scene->sweep;
  const int64_t points = points_of(plan);
  const kz_stage stage = kz_stage_of_rows("ends", plan->ends.theta.count, points, KZ_ENDS_POINTS,
                                          KZ_ENDS_POINTS * sizeof(kz_chart_ending), find_ends, (void *)scene);
  KZ_FREED kz_chart_ending *endings = store ? kz_malloc((size_t)stage.n_tiles * stage.record_bytes) : NULL;
  KZ_TRY(kz_stage_run(run, &stage, endings));
  if (!store) return KZ_OK;
  for (int64_t place = 1; place < plan->ends.theta.count; place++) /* without the ends of the last tile of each start */
    memmove(endings + place * points, endings + place * (stage.n_tiles / stage.rows) * KZ_ENDS_POINTS,
            (size_t)points * sizeof *endings);
  return kz_ends_publish(plan, endings, store, summary);
}
