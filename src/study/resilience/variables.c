/* Variables of the group shocks of the result file. */
#include "variable_words.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_shocks_variables[] = {
    {"point", KZ_INT32, {"point"}, NONE, "place of the strobe point in the list"},
    {"size", KZ_REAL, {"size"}, ANGLE, "largest size of the shocks: hypot(dtheta, dv / scale)"},
    {"attractor", KZ_INT32, {"point"}, NONE, "id of the attractor"},
    {"phase", KZ_INT32, {"point"}, NONE, "place of the strobe point along the orbit"},
    {"strobe_theta", KZ_REAL, {"point"}, ANGLE, "angle of the strobe point from down"},
    {"strobe_velocity", KZ_REAL, {"point"}, VELOCITY, "angular velocity of the strobe point"},
    {"angle", KZ_REAL, {"point"}, ANGLE, "smallest change of the angle alone that leaves the basin; NaN = none does"},
    {"angle_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"kick", KZ_REAL, {"point"}, VELOCITY, "smallest change of the velocity alone that leaves the basin; NaN = none"},
    {"kick_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"shock_theta", KZ_REAL, {"point"}, ANGLE, "change of the angle of the smallest shock that leaves the basin"},
    {"shock_velocity", KZ_REAL, {"point"}, VELOCITY, "change of the velocity of the smallest shock"},
    {"shock_size", KZ_REAL, {"point"}, ANGLE, "size of the smallest shock: hypot(dtheta, dv / scale)"},
    {"shock_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"harmless", KZ_REAL, {"point", "size"}, NONE, "share of the shocks up to a size that stay in the basin"},
    {"return_time", KZ_REAL, {"point", "size"}, PERIODS, "mean time until a harmless shock is trapped again"},
    {0},
};
/* clang-format on */
