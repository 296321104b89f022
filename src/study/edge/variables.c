/* Variables of the group edge of the result file. */
#include "kapitza/store_variables.h"
#include "edge.h"

/* clang-format off */
const kz_variable kz_edge_variables[] = {
    {"strobe", KZ_INT32, {"strobe"}, PERIODS, "since the first state on the edge"},
    {"phase", KZ_INT32, {"phase"}, NONE, "place of the strobe point along the cycle"},
    {"theta", KZ_REAL, {"strobe"}, ANGLE, "angle of a state on the edge from down"},
    {"velocity", KZ_REAL, {"strobe"}, VELOCITY, "angular velocity of a state on the edge"},
    {"strobe_theta", KZ_REAL, {"phase"}, ANGLE, "angle of the cycle's strobe point from down"},
    {"strobe_velocity", KZ_REAL, {"phase"}, VELOCITY, "angular velocity of the cycle's strobe point"},
    {0},
};
/* clang-format on */
