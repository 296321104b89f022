/* The measure `ends`: tiles of points of the plane, each a pendulum of its own. */
#include "ends.h"

#include <inttypes.h>

#include "numerics/cells.h"
#include "numerics/steps.h"
#include "sweep/plan.h"

/* ---- the file's group /plane, and the summary ---- */

static const char *const GROUP = "plane";

#define COLUMN(type, name, count, expression) KZ_COLUMN(store, "plane", name, count, type, expression)

static int64_t points_of(const kz_sweep_plan *plan) {
  return plan->x.values.count * plan->y.values.count;
}

/* The velocity of start number `place`, rad per drive radian. */
static double velocity_of(const kz_ends_plan *plan, int64_t place) {
  return plan->velocity.values[plan->velocity.count == 1 ? 0 : place];
}

static kz_status write_group(const kz_ends_plan *plan, int64_t points, const kz_plane_ending *e, kz_store *store) {
  const int64_t starts = plan->theta.count, n = starts * points;
  KZ_TRY(kz_store_dimension(store, GROUP, "start", starts, NULL));
  KZ_TRY(kz_store_variable(store, GROUP, "start_theta", plan->theta.values));
  COLUMN(double, "start_velocity", starts, velocity_of(plan, i));
  COLUMN(int16_t, "end_period", n, e[i].period > 0 ? e[i].period : 0);
  COLUMN(int8_t, "end", n, e[i].period > 0 ? 0 : 1 - e[i].period);
  COLUMN(int32_t, "end_winding", n, e[i].winding);
  COLUMN(int8_t, "end_centre", n, e[i].centre);
  COLUMN(double, "exponent", n, e[i].exponent);
  COLUMN(int32_t, "settling_time", n, e[i].settling_time);
  return KZ_OK;
}

/* Shares of the ends of one start. */
static void print_start(const kz_ends_plan *plan, int64_t place, int64_t n, const kz_plane_ending *e, FILE *summary) {
  static const char *const names[] = {"about down", "about inverted", "rotating",          "other cycles",
                                      "chaotic",    "not settled",    "no damped pendulum"};
  enum { KINDS = 7 };
  int64_t counts[KINDS] = {0};
  for (int64_t i = 0; i < n; i++) counts[e[i].period > 0 ? e[i].centre : 4 - e[i].period]++;
  fprintf(summary, "  start %.10g, %.10g:", plan->theta.values[place], velocity_of(plan, place));
  const char *before = " ";
  for (int kind = 0; kind < KINDS; kind++) {
    if (counts[kind] == 0) continue;
    fprintf(summary, "%s%s %.2f %%", before, names[kind], 100.0 * (double)counts[kind] / (double)n);
    before = ", ";
  }
  fprintf(summary, "\n");
}

/* Writes ends to the group /plane and the summary from endings [starts][y][x]. Rank 0. */
static kz_status publish_ends(const kz_scene *scene, const kz_plane_ending *endings, kz_store *store, FILE *summary) {
  const kz_sweep_plan *plan = scene->sweep;
  const kz_ends_plan *starts = scene->ends;
  KZ_TRY(write_group(starts, points_of(plan), endings, store));
  fprintf(summary, "ends: %" PRId64 " values of %s x %" PRId64 " of %s, %" PRId64 " start%s\n", plan->x.values.count,
          kz_sweep_parameter_at(plan->x.parameter)->name, plan->y.values.count,
          kz_sweep_parameter_at(plan->y.parameter)->name, starts->theta.count, starts->theta.count == 1 ? "" : "s");
  for (int64_t place = 0; place < starts->theta.count; place++)
    print_start(starts, place, points_of(plan), endings + place * points_of(plan), summary);
  return KZ_OK;
}

enum { LEAST_STEPS = 8, MOST_STEPS = 4000 };
/* Error allowed in a drive period, rad: Newton's method refines final cycles, a motion only has to be led to one. */
static const double TOLERANCE = 1e-8;

/* The pendulum of a point; false if there is none, or if it has no damping. */
static bool pendulum_of(const kz_scene *scene, int64_t point, kz_pendulum *pendulum) {
  const kz_sweep_plan *plan = scene->sweep;
  const int64_t columns = plan->x.values.count;
  const int32_t parameter[] = {plan->x.parameter, plan->y.parameter};
  const double value[] = {kz_axis_value(&plan->x.values, point % columns),
                          kz_axis_value(&plan->y.values, point / columns)};
  return kz_pendulum_at(scene, 2, parameter, value, pendulum) && pendulum->beta > 0;
}

static int64_t periods_of(const kz_ends_plan *plan, double beta) {
  return plan->max_periods < 0 ? kz_settling_periods(beta) : plan->max_periods;
}

kz_cost kz_ends_cost(const kz_scene *scene) {
  const double motions = (double)points_of(scene->sweep) * (double)scene->ends->theta.count;
  return (kz_cost){.cells = (int64_t)motions,
                   .disk_bytes = 2 * motions * sizeof(kz_plane_ending),
                   .rank0_bytes = 3 * motions * sizeof(kz_plane_ending)};
}

/* Steps of split6 that keep the error of a period of the strongest of n pendulums. */
static int32_t steps_for(int64_t n, const kz_pendulum *pendulum, double start_speed) {
  const kz_pendulum *strongest = pendulum;
  for (int64_t i = 1; i < n; i++)
    if (kz_stiffness(pendulum + i) > kz_stiffness(strongest)) strongest = pendulum + i;
  kz_numerics numerics = kz_steps_plain();
  numerics.steps_per_period = (int32_t)fmin(kz_steps_by_stiffness(strongest, numerics.steps_per_period), MOST_STEPS);
  return kz_steps_scaled(strongest, &numerics, fmax(start_speed, 1 + 2 * sqrt(kz_stiffness(strongest))), TOLERANCE,
                         LEAST_STEPS, MOST_STEPS);
}

void kz_ends_points(const kz_scene *scene, int64_t place, int64_t n, const int64_t *point, kz_plane_ending *ending) {
  const kz_ends_plan *plan = scene->ends;
  KZ_AUTOFREE kz_pendulum *pendulum = kz_malloc((size_t)n * sizeof *pendulum);
  int64_t periods[KZ_ENDS_POINTS];
  double start[2];
  for (int64_t i = 0; i < n; i++) {
    const bool damped = pendulum_of(scene, point[i], pendulum + i);
    if (!damped) pendulum[i] = (kz_pendulum){0, 0, 0};
    periods[i] = damped ? periods_of(plan, pendulum[i].beta) : 0;
  }
  kz_start_state(plan->theta.values[place], velocity_of(plan, place), start);
  kz_ends_follow(steps_for(n, pendulum, fabs(start[1])), n, pendulum, start, (int32_t)plan->max_period, periods,
                 ending);
  for (int64_t i = 0; i < n; i++)
    if (periods[i] == 0) ending[i] = (kz_plane_ending){.period = KZ_NO_PENDULUM, .centre = 3, .exponent = NAN};
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
  const kz_ends_plan *plan = scene->ends;
  const int64_t points = points_of(scene->sweep);
  const kz_stage stage = kz_stage_of_rows("ends", plan->theta.count, points, KZ_ENDS_POINTS,
                                          KZ_ENDS_POINTS * sizeof(kz_plane_ending), find_ends, (void *)scene);
  KZ_AUTOFREE kz_plane_ending *endings = store ? kz_malloc((size_t)stage.n_tiles * stage.record_bytes) : NULL;
  KZ_TRY(kz_stage_run(run, &stage, endings));
  if (!store) return KZ_OK;
  for (int64_t place = 1; place < plan->theta.count; place++) /* without the ends of the last tile of each start */
    memmove(endings + place * points, endings + place * (stage.n_tiles / stage.rows) * KZ_ENDS_POINTS,
            (size_t)points * sizeof *endings);
  return publish_ends(scene, endings, store, summary);
}
