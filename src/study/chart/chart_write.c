/* The file's group /chart, and the summary. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "chart.h"

static const char *const GROUP = "chart";

/* One axis with its scale, its key and that key's unit. */
static kz_status write_axis(const char *name, const kz_chart_axis *axis, kz_store *store) {
  const kz_sweep_parameter *parameter = kz_sweep_parameters + axis->parameter;
  char attribute[32];
  snprintf(attribute, sizeof attribute, "%s_parameter", name);
  KZ_TRY(kz_store_text(store, GROUP, attribute, parameter->name));
  snprintf(attribute, sizeof attribute, "%s_units", name);
  KZ_TRY(kz_store_text(store, GROUP, attribute, parameter->unit));
  KZ_SCALE(store, GROUP, name, axis->values.count, kz_axis_value(&axis->values, i));
  return KZ_OK;
}

#define COLUMN(type, name, count, expression) KZ_COLUMN(store, "chart", name, count, type, expression)

static kz_status write_group(const kz_chart_plan *plan, const kz_chart_ending *e, kz_store *store) {
  const int64_t starts = plan->theta.count, n = starts * plan->x.values.count * plan->y.values.count;
  KZ_TRY(kz_store_dimension(store, GROUP, "start", starts, NULL));
  KZ_TRY(write_axis("y", &plan->y, store));
  KZ_TRY(write_axis("x", &plan->x, store));
  KZ_TRY(kz_store_variable(store, GROUP, "start_theta", plan->theta.values));
  COLUMN(double, "start_velocity", starts, kz_chart_velocity(plan, i));
  COLUMN(int16_t, "period", n, e[i].period > 0 ? e[i].period : 0);
  COLUMN(int8_t, "end", n, e[i].period > 0 ? 0 : 1 - e[i].period);
  COLUMN(int32_t, "winding", n, e[i].winding);
  COLUMN(int8_t, "centre", n, e[i].centre);
  COLUMN(double, "exponent", n, e[i].exponent);
  COLUMN(int32_t, "settling_time", n, e[i].settling_time);
  return KZ_OK;
}

/* Shares of the ends of one start. */
static void print_start(const kz_chart_plan *plan, int64_t place, const kz_chart_ending *e, FILE *summary) {
  static const char *const names[] = {"about down", "about inverted", "rotating",          "other cycles",
                                      "chaotic",    "not settled",    "no damped pendulum"};
  enum { KINDS = 7 };
  const int64_t n = plan->x.values.count * plan->y.values.count;
  int64_t counts[KINDS] = {0};
  for (int64_t i = 0; i < n; i++) counts[e[i].period > 0 ? e[i].centre : 4 - e[i].period]++;
  fprintf(summary, "  start %.10g, %.10g:", plan->theta.values[place], kz_chart_velocity(plan, place));
  const char *before = " ";
  for (int kind = 0; kind < KINDS; kind++) {
    if (counts[kind] == 0) continue;
    fprintf(summary, "%s%s %.2f %%", before, names[kind], 100.0 * (double)counts[kind] / (double)n);
    before = ", ";
  }
  fprintf(summary, "\n");
}

kz_status kz_chart_publish(const kz_chart_plan *plan, const kz_chart_ending *endings, kz_store *store, FILE *summary) {
  KZ_TRY(write_group(plan, endings, store));
  fprintf(summary, "chart: %" PRId64 " values of %s x %" PRId64 " of %s, ends of %" PRId64 " start%s\n", plan->x.values.count,
          kz_sweep_parameters[plan->x.parameter].name, plan->y.values.count, kz_sweep_parameters[plan->y.parameter].name,
          plan->theta.count, plan->theta.count == 1 ? "" : "s");
  for (int64_t place = 0; place < plan->theta.count; place++)
    print_start(plan, place, endings + place * plan->x.values.count * plan->y.values.count, summary);
  return KZ_OK;
}
