/* Variables of the group potential of the result file. */
#include "variable_words.h"
#include "kapitza/study.h"

#define BY_DRIVE {"drive_amplitude", "theta"}
#define ENERGY "1|units of I omega^2"

/* clang-format off */
const kz_variable kz_potential_variables[] = {
    {"theta", KZ_REAL, {"theta"}, ANGLE, "slow angle from down, counterclockwise"},
    {"drive_amplitude", KZ_REAL, {"drive_amplitude"}, NONE, "drive amplitude m"},
    {"energy", KZ_REAL, BY_DRIVE, ENERGY, "effective potential of the slow equation, Blackburn (1992) Eq. (10), exact"},
    {"energy_blackburn", KZ_REAL, BY_DRIVE, ENERGY, "effective potential by Blackburn (1992) Eq. (11)"},
    {"energy_simple", KZ_REAL, BY_DRIVE, ENERGY, "effective potential by Blackburn (1992) Eq. (12)"},
    {"rim", KZ_REAL, {"drive_amplitude"}, ANGLE,
     "rim of the inverted well from down, cos = -2 k/m^2 of Eq. (12); NaN: no well"},
    {"rim_exact", KZ_REAL, {"drive_amplitude"}, ANGLE,
     "rim of the inverted well of the exact potential from down; NaN: no well"},
    {"stable_inverted", KZ_UINT8, {"drive_amplitude"}, NONE,
     "whether the exact potential has an inverted well", {"no", "yes"}},
    {0},
};
/* clang-format on */
