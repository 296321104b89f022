/* Variables that proofs add to the group attractors of the result file. */
#include "variable_words.h"
#include "proof.h"

/* clang-format off */
const kz_variable kz_proof_variables[] = {
    {"proved", KZ_INT8, {"attractor"}, NONE,
     "whether the orbit is proved to exist and to attract", {"no", "yes"}, .group = "attractors"},
    {"strobe_theta_half_width", KZ_REAL, {"attractor", "phase"}, ANGLE,
     "proved bound on strobe_theta's error", .group = "attractors"},
    {"strobe_velocity_half_width", KZ_REAL, {"attractor", "phase"}, VELOCITY,
     "proved bound on strobe_velocity's error", .group = "attractors"},
    {"multiplier_half_width", KZ_REAL, {"attractor", "pair"}, NONE,
     "proved bound on the multiplier's error", .group = "attractors"},
    {0},
};
/* clang-format on */
