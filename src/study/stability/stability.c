#include "stability.h"

/* Points of a tile of the chart, and values of k of a tile of a curve. */
enum { POINTS = 2048, PIECE = 64 };

static kz_axis stability_times(const kz_axis *axis, double factor) {
  return (kz_axis){.min = axis->min * factor, .max = axis->max * factor, .count = axis->count};
}

kz_chart_axes kz_stability_axes(const kz_stability_plan *plan) {
  if (isnan(plan->a.min)) return (kz_chart_axes){plan->k, plan->m};
  return (kz_chart_axes){stability_times(&plan->a, 0.25), stability_times(&plan->q, 0.5)};
}

kz_cost kz_stability_cost(const kz_scene *scene) {
  const kz_stability_plan *plan = scene->stability;
  const kz_chart_axes axes = kz_stability_axes(plan);
  double points = (double)axes.k.count * (double)axes.m.count;
  double curves = (double)kz_chart_row(&axes) * (double)(plan->curves.count + plan->subharmonics.count);
  return (kz_cost){
      .cells = (int64_t)points, .disk_bytes = 34 * points + 32 * curves, .rank0_bytes = 34 * points + 32 * curves};
}

/* Values from min to max, both exactly. */
static double *axis_values(const kz_axis *axis) {
  double *values = kz_malloc((size_t)axis->count * sizeof *values), last = (double)(axis->count - 1);
  for (int64_t i = 0; i < axis->count; i++)
    values[i] = last > 0 ? (axis->min * (last - (double)i) + axis->max * (double)i) / last : axis->min;
  return values;
}

static bool stability_contains(const kz_integers *list, int64_t count, int64_t value) {
  for (int64_t i = 0; i < count; i++)
    if (list->values[i] == value) return true;
  return false;
}

/* Whether the chart asks for a row of kz_curves; `word`: its place in the list of names. */
static bool is_asked(const kz_stability_plan *plan, int32_t row, int64_t *word) {
  *word += strcmp(kz_curves[row].name, kz_curves[row].asked) == 0;
  return stability_contains(&plan->curves, plan->curves.count, *word);
}

bool kz_stability_has_curve(const kz_stability_plan *plan, const char *stability_begin) {
  int64_t word = -1;
  bool has = false;
  for (int32_t row = 0; row < kz_curve_count; row++)
    has |= is_asked(plan, row, &word) && strncmp(kz_curves[row].name, stability_begin, strlen(stability_begin)) == 0;
  return has;
}

bool kz_stability_needs_sine(const kz_stability_plan *plan) {
  int64_t word = -1;
  bool needs = plan->subharmonics.count > 0;
  for (int32_t row = 0; row < kz_curve_count; row++) needs |= is_asked(plan, row, &word) && !kz_curves[row].edge;
  return needs;
}

/* Every curve asked for with its upper branch, in the table's order; then the subharmonic orders, each once. */
static void make_tasks(kz_chart *chart) {
  const kz_integers *orders = &chart->plan->subharmonics;
  int64_t word = -1;
  for (int32_t row = 0; row < kz_curve_count; row++)
    if (is_asked(chart->plan, row, &word)) chart->tasks[chart->n_tasks++] = (kz_curve_task){row, 0};
  for (int64_t i = 0; i < orders->count; i++)
    if (!stability_contains(orders, i, orders->values[i]))
      chart->tasks[chart->n_tasks++] = (kz_curve_task){-1, (int32_t)orders->values[i]};
}

static kz_chart chart_begin(const kz_scene *scene) {
  const kz_stability_plan *plan = scene->stability;
  const kz_chart_axes axes = kz_stability_axes(plan);
  kz_chart chart = {.plan = plan,
                    .axes = axes,
                    .damping = {isnan(plan->damping) ? 0 : plan->damping, plan->quality_factor},
                    .k = axis_values(&axes.k),
                    .m = axis_values(&axes.m),
                    .tasks = kz_malloc((size_t)(kz_curve_count + plan->subharmonics.count) * sizeof *chart.tasks)};
  kz_drive_form(&scene->parameters, &chart.form);
  make_tasks(&chart);
  return chart;
}

static void stability_release(kz_chart *chart) {
  free(chart->k);
  free(chart->m);
  free(chart->tasks);
  free(chart->points);
  free(chart->curves);
}

static kz_status chart_points(void *context, int64_t first, int64_t n, void *record) {
  const kz_chart *chart = context;
  kz_chart_point *out = record;
  double k[POINTS] = {0}, beta[POINTS] = {0}, m[POINTS] = {0}, log_multiplier[POINTS], angle[POINTS];
  uint8_t stable[POINTS];
  const int64_t columns = chart->axes.k.count;
  for (int64_t i = 0; i < n; i++) {
    k[i] = chart->k[(first + i) % columns];
    m[i] = chart->m[(first + i) / columns];
    beta[i] = kz_damping_at(&chart->damping, k[i]);
  }
  kz_linear_floquet(&chart->form, n, k, beta, m, log_multiplier, angle, stable);
  for (int64_t i = 0; i < n; i++) out[i] = (kz_chart_point){log_multiplier[i], angle[i], stable[i]};
  return KZ_OK;
}

/* The number of values of a curve: of k, or of m. */
static int64_t values_of(const kz_chart *chart, const kz_curve_task *task) {
  return task->row >= 0 && kz_curves[task->row].edge ? chart->axes.m.count : chart->axes.k.count;
}

/* Values of a curve: a row. It may be shorter than others. */
static kz_status curve_points(void *context, int64_t item, int64_t most, void *record) {
  const kz_chart *chart = context;
  kz_curve_point *out = record;
  double m[2][PIECE] = {{0}};
  const int64_t first = item % kz_chart_row(&chart->axes);
  const kz_curve_task *task = &chart->tasks[item / kz_chart_row(&chart->axes)];
  const kz_curve *curve = task->row < 0 ? NULL : &kz_curves[task->row];
  const int64_t left = values_of(chart, task) - first, n = kz_smaller(left, most);
  if (!curve)
    kz_subharmonic_values(task->order, n, chart->k + first, m[0], m[1]);
  else if (!curve->edge)
    kz_curve_values(curve, &chart->damping, n, chart->k + first, m[0]);
  else
    for (int64_t i = 0; i < n; i++) m[0][i] = curve->edge(&chart->form, curve->number, chart->m[first + i]);
  for (int64_t i = 0; i < n; i++) out[i] = (kz_curve_point){{m[0][i], m[1][i]}};
  return KZ_OK;
}

/* Runs a stage; rank 0 gets its records, the others NULL. */
static kz_status run_stage(const kz_run *run, const kz_stage *stage, void *records) {
  void *all = kz_rank(run->ranks) == 0 ? kz_malloc((size_t)stage->n_tiles * stage->record_bytes) : NULL;
  memcpy(records, &all, sizeof all);
  return kz_stage_run(run, stage, all);
}

kz_status kz_stability_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(stability_release) kz_chart chart = chart_begin(scene);
  const int64_t points = chart.axes.k.count * chart.axes.m.count, row = kz_chart_row(&chart.axes);
  kz_stage of_points = kz_stage_of_items("chart", points, POINTS, POINTS * sizeof *chart.points, chart_points, &chart);
  of_points.everywhere = false;
  const kz_stage of_curves =
      kz_stage_of_rows("curves", chart.n_tasks, row, PIECE, PIECE * sizeof *chart.curves, curve_points, &chart);
  chart.stride = (row + PIECE - 1) / PIECE * PIECE;
  KZ_TRY(run_stage(run, &of_points, &chart.points));
  if (chart.n_tasks > 0) KZ_TRY(run_stage(run, &of_curves, &chart.curves));
  if (!store) return KZ_OK;
  kz_chart_summarise(&chart, summary);
  return kz_chart_write(&chart, store);
}
