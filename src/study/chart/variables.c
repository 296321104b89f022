/* Variables of the group chart of the result file. */
#include "kapitza/store_variables.h"
#include "chart.h"

#define CHART {"start", "y", "x"}

/* clang-format off */
const kz_variable kz_chart_variables[] = {
    {"x", KZ_REAL, {"x"}, "@x_units", "value of the key x_parameter of the pendulum"},
    {"y", KZ_REAL, {"y"}, "@y_units", "value of the key y_parameter of the pendulum"},
    {"start", KZ_INT32, {"start"}, NONE, "place of the start in the list"},
    {"start_theta", KZ_REAL, {"start"}, ANGLE, "angle of the start from down"},
    {"start_velocity", KZ_REAL, {"start"}, VELOCITY, "angular velocity of the start"},
    {"period", KZ_INT16, CHART, PERIODS, "period of the cycle in which the motion ends; 0 = none"},
    {"end", KZ_INT8, CHART, NONE, "kind of the end of the motion", {"cycle", "chaotic", "not_settled", "no_damped_pendulum"}},
    {"winding", KZ_INT32, CHART, NONE, "net turns in one period of the cycle, + counterclockwise"},
    {"centre", KZ_INT8, CHART, NONE, "what the cycle moves about", {CENTRES}},
    {"exponent", KZ_REAL, CHART, RATE, "largest Lyapunov exponent of the end"},
    {"settling_time", KZ_INT32, CHART, PERIODS, "time until the motion is within 1e-5 rad of its state one period of the cycle before"},
    {0},
};
/* clang-format on */
