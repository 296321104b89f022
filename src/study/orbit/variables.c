/* Variables of the group orbit of the result file. */
#include "variable_words.h"
#include "orbit.h"

#define TIME "rad|drive radians"

/* clang-format off */
const kz_variable kz_orbit_variables[] = {
    {"time", KZ_REAL, {"time"}, TIME, "time since the record began"},
    {"theta", KZ_REAL, {"time"}, ANGLE, "angle from down, counterclockwise, not wrapped"},
    {"velocity", KZ_REAL, {"time"}, VELOCITY, "angular velocity"},
    {"xi", KZ_REAL, {"time"}, ANGLE,
     "fast motion about the slow angle theta, -m sin(theta) cos(t), Blackburn (1992) Eq. (9)"},
    {"pivot", KZ_REAL, {"time"}, NONE, "height of the pivot, of a sine m cos t, in units of I/(M r)"},
    {"pivot_aside", KZ_REAL, {"time"}, NONE, "how far the pivot is aside, in units of I/(M r)"},
    {"strobe_time", KZ_REAL, {"strobe_time"}, TIME, "time of the strobe points, both ends of the record"},
    {"strobe_theta", KZ_REAL, {"strobe_time"}, ANGLE, "angle of the strobe point from down, not wrapped"},
    {"strobe_velocity", KZ_REAL, {"strobe_time"}, VELOCITY, "angular velocity of the strobe point"},
    {"maximum_time", KZ_REAL, {"maximum_time"}, TIME, "time of the turning points after the first sample"},
    {"maximum_angle", KZ_REAL, {"maximum_time"}, ANGLE, "angle of the turning point from the centre"},
    {"line_frequency", KZ_REAL, {"line_frequency"}, "1|drive frequencies", "frequency of the spectral line"},
    {"line_amplitude", KZ_REAL, {"line_frequency"}, "@line_units", "amplitude of the spectral line; line 0 = |mean|"},
    {"line_phase", KZ_REAL, {"line_frequency"}, ANGLE, "phase of the spectral line at the first sample"},
    {0},
};
/* clang-format on */
