/* Variables of the groups plane, line and sweep of the result file that measures of a sweep write. */
#include "variable_words.h"
#include "kapitza/study.h"
#include "table.h"

#define OF(word, unit, name, of, ...) {#word, KZ_REAL, {__VA_ARGS__}, unit, name, .group = of},
#define INTERVAL_OF(word, unit, name, of, ...)                                                                        \
  OF(word, unit, name, of, __VA_ARGS__){#word "_low", KZ_REAL, {__VA_ARGS__}, unit, "lower end of its 95 % interval", \
                                        .group = of},                                                                 \
      {#word "_high", KZ_REAL, {__VA_ARGS__}, unit, "upper end of its 95 % interval", .group = of},
#define NONE_OF(word, needs, unit, name) /* for one pendulum alone */
#define CLASSES(of)                                                                                          \
  {"attractor", KZ_INT32, {"attractor"}, NONE, "number of the attractor", .group = of},                      \
      {"name", KZ_TEXT, {"attractor"}, NONE, "name of the attractor where it is seen first", .group = of},   \
      {"period", KZ_INT32, {"attractor"}, PERIODS, "period of the orbit; 0 = it never closes", .group = of}, \
      {"winding",                                                                                            \
       KZ_INT32,                                                                                             \
       {"attractor"},                                                                                        \
       NONE,                                                                                                 \
       "net turns in one period, + counterclockwise; of a running state 1 or -1",                            \
       .group = of},                                                                                         \
      {"centre", KZ_INT8, {"attractor"}, NONE, "what the orbit moves about", {CENTRES}, .group = of},        \
      {"points", KZ_INT32, {"attractor"}, NONE, "number of pendulums that have the attractor", .group = of},
#define PLANE(word, needs, unit, name) OF(word, unit, name, "plane", "attractor", "y", "x")
#define PLANE_INTERVAL(word, needs, unit, name) INTERVAL_OF(word, unit, name, "plane", "attractor", "y", "x")
#define PLANE_PENDULUM(word, needs, unit, name) OF(word, unit, name, "plane", "y", "x")
#define LINE(word, needs, unit, name) OF(word, unit, name, "line", "attractor", "value")
#define LINE_INTERVAL(word, needs, unit, name) INTERVAL_OF(word, unit, name, "line", "attractor", "value")
#define LINE_PENDULUM(word, needs, unit, name) OF(word, unit, name, "line", "value")

/* clang-format off */
const kz_variable kz_swept_variables[] = {
    CLASSES("plane")
    KZ_MEASURES(PLANE, PLANE_INTERVAL, PLANE, NONE_OF, PLANE_PENDULUM)
    {"value", KZ_REAL, {"value"}, "@parameter_units", "value of the swept key of the pendulum", .group = "line"},
    CLASSES("line")
    KZ_MEASURES(LINE, LINE_INTERVAL, LINE, NONE_OF, LINE_PENDULUM)
    {"shock_angle", KZ_REAL, {"value", "branch"}, ANGLE,
     "smallest change of the angle that leaves the basin", .group = "sweep"},
    {"shock_kick", KZ_REAL, {"value", "branch"}, VELOCITY,
     "smallest change of the velocity that leaves the basin", .group = "sweep"},
    {"shock_size", KZ_REAL, {"value", "branch"}, ANGLE,
     "size of the smallest shock that leaves the basin", .group = "sweep"},
    {0},
};
/* clang-format on */
