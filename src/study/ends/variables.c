/* Variables of the group plane of the result file that the measure ends writes. */
#include "variable_words.h"
#include "kapitza/study.h"

#define ENDS {"start", "y", "x"}

/* clang-format off */
const kz_variable kz_ends_variables[] = {
    {"start", KZ_INT32, {"start"}, NONE, "place of the start in the list", .group = "plane"},
    {"start_theta", KZ_REAL, {"start"}, ANGLE, "angle of the start from down", .group = "plane"},
    {"start_velocity", KZ_REAL, {"start"}, VELOCITY, "angular velocity of the start", .group = "plane"},
    {"end_period", KZ_INT16, ENDS, PERIODS, "period of the cycle in which the motion ends; 0 = none", .group = "plane"},
    {"end", KZ_INT8, ENDS, NONE,
     "kind of the end of the motion", {"cycle", "chaotic", "not_settled", "no_damped_pendulum"}, .group = "plane"},
    {"end_winding", KZ_INT32, ENDS, NONE, "net turns in one period of the cycle, + counterclockwise", .group = "plane"},
    {"end_centre", KZ_INT8, ENDS, NONE, "what the cycle moves about", {CENTRES}, .group = "plane"},
    {"exponent", KZ_REAL, ENDS, RATE, "largest Lyapunov exponent of the end", .group = "plane"},
    {"settling_time", KZ_INT32, ENDS, PERIODS,
     "time until the motion is within 1e-5 rad of its state one period of the cycle before", .group = "plane"},
    {0},
};
/* clang-format on */
