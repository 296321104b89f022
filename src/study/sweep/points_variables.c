/* Variables of the groups plane and line of the result file. */
#include "kapitza/store_variables.h"
#include "measures/table.h"
#include "sweep.h"

#define ENDS {"start", "y", "x"}
#define OF(word, unit, name, ...) {#word, KZ_REAL, {__VA_ARGS__}, unit, name},
#define INTERVAL_OF(word, unit, name, ...)                                                                         \
  OF(word, unit, name, __VA_ARGS__){#word "_low", KZ_REAL, {__VA_ARGS__}, unit, "lower end of its 95 % interval"}, \
      {#word "_high", KZ_REAL, {__VA_ARGS__}, unit, "upper end of its 95 % interval"},
#define NONE_OF(word, needs, unit, name) /* for one pendulum alone */
#define CLASSES                                                                                                              \
  {"attractor", KZ_INT32, {"attractor"}, NONE, "number of the attractor"},                                                   \
      {"name", KZ_TEXT, {"attractor"}, NONE, "name of the attractor where it is seen first"},                                \
      {"period", KZ_INT32, {"attractor"}, PERIODS, "period of the orbit; 0 = it never closes"},                              \
      {"winding", KZ_INT32, {"attractor"}, NONE, "net turns in one period, + counterclockwise; of a running state 1 or -1"}, \
      {"centre", KZ_INT8, {"attractor"}, NONE, "what the orbit moves about", {CENTRES}},                                     \
      {"points", KZ_INT32, {"attractor"}, NONE, "number of pendulums that have the attractor"},
#define PLANE(word, needs, unit, name) OF(word, unit, name, "attractor", "y", "x")
#define PLANE_INTERVAL(word, needs, unit, name) INTERVAL_OF(word, unit, name, "attractor", "y", "x")
#define PLANE_PENDULUM(word, needs, unit, name) OF(word, unit, name, "y", "x")
#define LINE(word, needs, unit, name) OF(word, unit, name, "attractor", "value")
#define LINE_INTERVAL(word, needs, unit, name) INTERVAL_OF(word, unit, name, "attractor", "value")
#define LINE_PENDULUM(word, needs, unit, name) OF(word, unit, name, "value")

/* clang-format off */
const kz_variable kz_plane_variables[] = {
    {"x", KZ_REAL, {"x"}, "@x_units", "value of the key x_parameter of the pendulum"},
    {"y", KZ_REAL, {"y"}, "@y_units", "value of the key y_parameter of the pendulum"},
    {"start", KZ_INT32, {"start"}, NONE, "place of the start in the list"},
    {"start_theta", KZ_REAL, {"start"}, ANGLE, "angle of the start from down"},
    {"start_velocity", KZ_REAL, {"start"}, VELOCITY, "angular velocity of the start"},
    {"end_period", KZ_INT16, ENDS, PERIODS, "period of the cycle in which the motion ends; 0 = none"},
    {"end", KZ_INT8, ENDS, NONE, "kind of the end of the motion", {"cycle", "chaotic", "not_settled", "no_damped_pendulum"}},
    {"end_winding", KZ_INT32, ENDS, NONE, "net turns in one period of the cycle, + counterclockwise"},
    {"end_centre", KZ_INT8, ENDS, NONE, "what the cycle moves about", {CENTRES}},
    {"exponent", KZ_REAL, ENDS, RATE, "largest Lyapunov exponent of the end"},
    {"settling_time", KZ_INT32, ENDS, PERIODS, "time until the motion is within 1e-5 rad of its state one period of the cycle before"},
    CLASSES
    KZ_MEASURES(PLANE, PLANE_INTERVAL, PLANE, NONE_OF, PLANE_PENDULUM)
    {0},
};

const kz_variable kz_line_variables[] = {
    {"value", KZ_REAL, {"value"}, "@parameter_units", "value of the swept key of the pendulum"},
    CLASSES
    KZ_MEASURES(LINE, LINE_INTERVAL, LINE, NONE_OF, LINE_PENDULUM)
    {0},
};
/* clang-format on */
