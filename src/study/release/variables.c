/* Variables of the groups phases and sweep of the result file that measures of releases write. */
#include "variable_words.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_release_variables[] = {
    {"phase", KZ_REAL, {"phase"}, ANGLE, "phase of the drive at which the cells are released", .group = "phases"},
    {"velocity", KZ_REAL, {"velocity"}, VELOCITY, "angular velocity of the cell centre", .group = "phases"},
    {"theta", KZ_REAL, {"theta"}, ANGLE, "angle of the cell centre from down, counterclockwise", .group = "phases"},
    {"attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor", .group = "phases"},
    {"fraction", KZ_REAL, {"phase", "attractor"}, NONE, "share of the cells that end there", .group = "phases"},
    {"common", KZ_INT16, {"velocity", "theta"}, NONE,
     "id of the attractor that is reached at all phases; -1 = none", .group = "phases"},
    {"ends", KZ_UINT8, {"velocity", "theta"}, NONE,
     "number of different ends; not settled counts as one", .group = "phases"},
    {0},
};

const kz_variable kz_ramp_variables[] = {{0}};

const kz_variable kz_alike_variables[] = {
    {"alike", KZ_REAL, {"value"}, NONE,
     "share of the cells or starts that end alike at all phases of release", .group = "sweep"},
    {"alike_low", KZ_REAL, {"value"}, NONE, "lower end of its 95 % interval (Wilson)", .group = "sweep"},
    {"alike_high", KZ_REAL, {"value"}, NONE, "upper end of its 95 % interval (Wilson)", .group = "sweep"},
    {0},
};
/* clang-format on */
