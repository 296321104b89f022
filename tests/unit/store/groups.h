/* Groups of a result file that is only a test's. */
#include "kapitza/store.h"

/* 200 characters, as the meaning of a flag or in a name. */
#define TEN "abcdefghij"
#define FIFTY TEN TEN TEN TEN TEN
#define LONG_TEXT FIFTY FIFTY FIFTY FIFTY

static const kz_variable attractors[] = {
    {"attractor", KZ_INT32, {"attractor"}, "1", "id", {0}},
    {"phase", KZ_INT32, {"phase"}, "1", "place along the orbit", {0}},
    {"name", KZ_TEXT, {"attractor"}, "1", "name", {0}},
    {"period", KZ_INT32, {"attractor"}, "1|drive periods", "period", {0}},
    {"centre", KZ_INT8, {"attractor"}, "1", "centre", {"down", "up", "rotating", "none"}},
    {"kind", KZ_INT8, {"attractor"}, "1", LONG_TEXT LONG_TEXT, {LONG_TEXT, LONG_TEXT, LONG_TEXT, "last"}},
    {"strobe_theta", KZ_REAL, {"attractor", "phase"}, "rad", "angle", {0}},
    {"strobe_velocity", KZ_REAL, {"attractor", "phase"}, "1", "velocity", {0}},
    {0}};
static const kz_variable basin[] = {{"velocity", KZ_REAL, {"velocity"}, "1", "velocity", {0}},
                                    {"theta", KZ_REAL, {"theta"}, "rad", "angle", {0}},
                                    {"attractor", KZ_INT16, {"velocity", "theta"}, "1", "id", {0}},
                                    {"settling_time", KZ_UINT32, {"velocity", "theta"}, "1", "time", {0}},
                                    {"curve_#", KZ_REAL, {"theta"}, "1", "curve of a number", {0}},
                                    {0}};
static const kz_group groups[] = {{"attractors", attractors}, {"basin", basin}, {NULL, NULL}};
