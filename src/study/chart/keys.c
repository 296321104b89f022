/* The study `chart`: its row, and the table of its keys. */
#define KEYS_OF chart

#include "kapitza/study_key_rows.h"
#include "plan.h"

#define CHART_COUNT(axis) \
  INTEGER("chart." #axis ".count", 2, 1e5, "500", axis.values.count, "Number of values, both ends included.")

static const kz_key keys[] = {
    STUDY("Study: where the same starts end, over a plane of two keys of the pendulum mapping."),
    PLANE_AXIS(chart, x, "The key along the horizontal axis."),
    CHART_COUNT(x),
    PLANE_AXIS(chart, y, "The key along the vertical axis."),
    CHART_COUNT(y),
    MAPPING("chart.start", NULL, "Starts, at t = 0; each has a chart of its own."),
    ROW("chart.start.theta", KZ_KEY_REALS, NULL, AT(theta), "Angles from down.", .unit = "rad", .low = -1e6, .high = 1e6),
    ROW("chart.start.velocity", KZ_KEY_REALS, "[0]", AT(velocity), "Velocities: one for each angle, or one for all.",
        .unit = KZ_VELOCITY_UNIT, .low = -1e3, .high = 1e3),
    INTEGER("chart.max_period", 1, KZ_CHART_MOST_PERIOD, "16", max_period, "Longest period of a cycle that is recognised."),
    INTEGER("chart.max_periods", 1, 1e8, "", max_periods,
            "Drive periods after which a motion counts as not settled; left out: the number that the damping needs, at least "
            "2000."),
    {.path = NULL},
};

KZ_STUDY_ROW(NULL);
