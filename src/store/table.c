#include "table.h"

#include <string.h>

#define ANGLE "rad"
#define VELOCITY "rad per drive radian"
#define PERIODS "drive periods"
#define TIME "drive radians"
#define NONE "1"

const kz_variable kz_variables[] = {
    /* group, name, kind, dimensions, units, long name, flag meanings */
    {"attractors", "attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor", {0}},
    {"attractors", "phase", KZ_INT32, {"phase"}, NONE, "place of the strobe point along the orbit", {0}},
    {"attractors", "pair", KZ_INT32, {"pair"}, NONE, "place of the Floquet multiplier, larger modulus first", {0}},
    {"attractors", "line", KZ_INT32, {"line"}, NONE, "spectral line j: frequency j/period of the drive's", {0}},
    {"attractors", "period", KZ_INT32, {"attractor"}, PERIODS, "period of the orbit; 0 = aperiodic (chaotic)", {0}},
    {"attractors", "winding", KZ_INT32, {"attractor"}, NONE, "net turns in one period of the orbit, + counterclockwise", {0}},
    {"attractors",
     "centre",
     KZ_INT8,
     {"attractor"},
     NONE,
     "what the orbit moves about",
     {"down", "inverted", "rotating", "none"}},
    {"attractors", "name", KZ_TEXT, {"attractor"}, NONE, "name of the attractor; names may repeat", {0}},
    {"attractors", "symmetric", KZ_INT8, {"attractor"}, NONE, "whether the orbit is its own mirror image", {"no", "yes"}},
    {"attractors",
     "mirror",
     KZ_INT32,
     {"attractor"},
     NONE,
     "id of the mirror image under (theta, velocity) -> -(theta, velocity)",
     {0}},
    {"attractors", "amplitude", KZ_REAL, {"attractor"}, ANGLE, "largest angle from the centre over continuous time", {0}},
    {"attractors", "strobe_theta", KZ_REAL, {"attractor", "phase"}, ANGLE, "angle of the strobe point from down", {0}},
    {"attractors", "strobe_velocity", KZ_REAL, {"attractor", "phase"}, VELOCITY, "angular velocity of the strobe point", {0}},
    {"attractors",
     "multiplier_re",
     KZ_REAL,
     {"attractor", "pair"},
     NONE,
     "Floquet multiplier over one period of the orbit, real part",
     {0}},
    {"attractors",
     "multiplier_im",
     KZ_REAL,
     {"attractor", "pair"},
     NONE,
     "Floquet multiplier over one period of the orbit, imaginary part",
     {0}},
    {"attractors", "lyapunov", KZ_REAL, {"attractor"}, "1 per drive period", "largest Lyapunov exponent", {0}},
    {"attractors",
     "lyapunov_error",
     KZ_REAL,
     {"attractor"},
     "1 per drive period",
     "standard error of the largest Lyapunov exponent",
     {0}},
    {"attractors", "fraction", KZ_REAL, {"attractor"}, NONE, "share of the grid's cells", {0}},
    {"attractors",
     "line_amplitude",
     KZ_REAL,
     {"attractor", "line"},
     ANGLE,
     "amplitude of the spectral line; line 0 = |mean|",
     {0}},
    {"attractors",
     "line_phase",
     KZ_REAL,
     {"attractor", "line"},
     ANGLE,
     "phase of the spectral line at the first strobe point",
     {0}},
    {"attractors", "dominant_line", KZ_INT32, {"attractor"}, NONE, "number of the largest spectral line; 0 = at rest", {0}},

    {"basin", "velocity", KZ_REAL, {"velocity"}, VELOCITY, "angular velocity of the cell centre", {0}},
    {"basin", "theta", KZ_REAL, {"theta"}, ANGLE, "angle of the cell centre from down, counterclockwise", {0}},
    {"basin", "attractor", KZ_INT16, {"velocity", "theta"}, NONE, "id of the attractor that is reached; -1 = not settled", {0}},
    {"basin",
     "settling_time",
     KZ_UINT32,
     {"velocity", "theta"},
     PERIODS,
     "time until the orbit is inside a trapping region",
     {0}},
    {"basin",
     "evidence",
     KZ_UINT8,
     {"velocity", "theta"},
     NONE,
     "what the label rests on",
     {"unsettled", "started_inside_a_trapping_region", "followed_into_a_trapping_region", "re_integrated"}},

    {"orbit", "time", KZ_REAL, {"time"}, TIME, "time since the record began", {0}},
    {"orbit", "theta", KZ_REAL, {"time"}, ANGLE, "angle from down, counterclockwise, not wrapped", {0}},
    {"orbit", "velocity", KZ_REAL, {"time"}, VELOCITY, "angular velocity", {0}},
    {"orbit", "pivot", KZ_REAL, {"time"}, NONE, "height of the pivot m cos t, in units of I/(M r)", {0}},
    {"orbit", "strobe_time", KZ_REAL, {"strobe_time"}, TIME, "time of the strobe points, both ends of the record", {0}},
    {"orbit", "strobe_theta", KZ_REAL, {"strobe_time"}, ANGLE, "angle of the strobe point from down, not wrapped", {0}},
    {"orbit", "strobe_velocity", KZ_REAL, {"strobe_time"}, VELOCITY, "angular velocity of the strobe point", {0}},
    {"orbit", "maximum_time", KZ_REAL, {"maximum_time"}, TIME, "time of the turning points after the first sample", {0}},
    {"orbit", "maximum_angle", KZ_REAL, {"maximum_time"}, ANGLE, "angle of the turning point from the centre", {0}},
    {"orbit", "line_frequency", KZ_REAL, {"line_frequency"}, "drive frequencies", "frequency of the spectral line", {0}},
    {"orbit", "line_amplitude", KZ_REAL, {"line_frequency"}, ANGLE, "amplitude of the spectral line; line 0 = |mean|", {0}},
    {"orbit", "line_phase", KZ_REAL, {"line_frequency"}, ANGLE, "phase of the spectral line at the first sample", {0}},
};
const size_t kz_variable_count = sizeof kz_variables / sizeof *kz_variables;

const kz_variable *kz_variable_find(const char *group, const char *name) {
  for (size_t i = 0; i < kz_variable_count; ++i)
    if (strcmp(kz_variables[i].group, group) == 0 && strcmp(kz_variables[i].name, name) == 0) return &kz_variables[i];
  return NULL;
}
