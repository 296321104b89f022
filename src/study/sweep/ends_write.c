/* The ends in the file's group /plane, and the summary. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "ends.h"

static const char *const GROUP = "plane";

#define COLUMN(type, name, count, expression) KZ_COLUMN(store, "plane", name, count, type, expression)

static kz_status write_group(const kz_sweep_plan *plan, const kz_chart_ending *e, kz_store *store) {
  const int64_t starts = plan->ends.theta.count, n = starts * plan->x.values.count * plan->y.values.count;
  KZ_TRY(kz_store_dimension(store, GROUP, "start", starts, NULL));
  KZ_TRY(kz_store_variable(store, GROUP, "start_theta", plan->ends.theta.values));
  COLUMN(double, "start_velocity", starts, kz_ends_velocity(plan, i));
  COLUMN(int16_t, "end_period", n, e[i].period > 0 ? e[i].period : 0);
  COLUMN(int8_t, "end", n, e[i].period > 0 ? 0 : 1 - e[i].period);
  COLUMN(int32_t, "end_winding", n, e[i].winding);
  COLUMN(int8_t, "end_centre", n, e[i].centre);
  COLUMN(double, "exponent", n, e[i].exponent);
  COLUMN(int32_t, "settling_time", n, e[i].settling_time);
  return KZ_OK;
}

/* Shares of the ends of one start. */
static void print_start(const kz_sweep_plan *plan, int64_t place, const kz_chart_ending *e, FILE *summary) {
  static const char *const names[] = {"about down", "about inverted", "rotating",          "other cycles",
                                      "chaotic",    "not settled",    "no damped pendulum"};
  enum { KINDS = 7 };
  const int64_t n = plan->x.values.count * plan->y.values.count;
  int64_t counts[KINDS] = {0};
  for (int64_t i = 0; i < n; i++) counts[e[i].period > 0 ? e[i].centre : 4 - e[i].period]++;
  fprintf(summary, "  start %.10g, %.10g:", plan->ends.theta.values[place], kz_ends_velocity(plan, place));
  const char *before = " ";
  for (int kind = 0; kind < KINDS; kind++) {
    if (counts[kind] == 0) continue;
    fprintf(summary, "%s%s %.2f %%", before, names[kind], 100.0 * (double)counts[kind] / (double)n);
    before = ", ";
  }
  fprintf(summary, "\n");
}

kz_status kz_ends_publish(const kz_sweep_plan *plan, const kz_chart_ending *endings, kz_store *store, FILE *summary) {
  KZ_TRY(write_group(plan, endings, store));
  fprintf(summary, "ends: %" PRId64 " values of %s x %" PRId64 " of %s, %" PRId64 " start%s\n", plan->x.values.count,
          kz_sweep_parameters[plan->x.parameter].name, plan->y.values.count, kz_sweep_parameters[plan->y.parameter].name,
          plan->ends.theta.count, plan->ends.theta.count == 1 ? "" : "s");
  for (int64_t place = 0; place < plan->ends.theta.count; place++)
    print_start(plan, place, endings + place * plan->x.values.count * plan->y.values.count, summary);
  return KZ_OK;
}
