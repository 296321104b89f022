/* Variables of the group attractors of the result file. */
#include "variable_words.h"
#include "labelling/catalogue.h"

/* clang-format off */
const kz_variable kz_attractors_variables[] = {
    {"attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor"},
    KZ_MOTION_VARIABLES("attractor"),
    {"line", KZ_INT32, {"line"}, NONE, "spectral line j: frequency j/period of the drive's"},
    {"period", KZ_INT32, {"attractor"}, PERIODS, "period of the orbit; 0 = it never closes"},
    {"name", KZ_TEXT, {"attractor"}, NONE, "name of the attractor; names may repeat"},
    {"amplitude", KZ_REAL, {"attractor"}, ANGLE, "largest angle from the centre over continuous time"},
    {"mean_velocity", KZ_REAL, {"attractor"}, VELOCITY, "mean angular velocity over time"},
    {"lyapunov", KZ_REAL, {"attractor"}, RATE, "largest Lyapunov exponent"},
    {"lyapunov_error", KZ_REAL, {"attractor"}, RATE, "standard error of the largest Lyapunov exponent"},
    {"fraction", KZ_REAL, {"attractor"}, NONE, "share of the grid's cells"},
    {"line_amplitude", KZ_REAL, {"attractor", "line"}, ANGLE, "amplitude of the spectral line; line 0 = |mean|"},
    {"line_phase", KZ_REAL, {"attractor", "line"}, ANGLE, "phase of the spectral line at the first strobe point"},
    {"dominant_line", KZ_INT32, {"attractor"}, NONE, "number of the largest spectral line; 0 = at rest"},
    {0},
};
/* clang-format on */
