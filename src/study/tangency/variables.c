/* Variables of the group tangency of the result file. */
#include "kapitza/store_variables.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_tangency_variables[] = {
    {"strobe", KZ_INT32, {"strobe"}, PERIODS, "since the point at which the manifolds touch"},
    {"theta", KZ_REAL, {"strobe"}, ANGLE, "angle from down of the orbit through that point"},
    {"velocity", KZ_REAL, {"strobe"}, VELOCITY, "angular velocity of this orbit"},
    {0},
};
/* clang-format on */
