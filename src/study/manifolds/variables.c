/* Variables of the group manifolds of the result file. */
#include "kapitza/store_variables.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_manifolds_variables[] = {
    {"point", KZ_INT32, {"point"}, NONE, "place of the point in the list"},
    {"theta", KZ_REAL, {"point"}, ANGLE, "angle from down, counterclockwise"},
    {"velocity", KZ_REAL, {"point"}, VELOCITY, "angular velocity"},
    {"arc_length", KZ_REAL, {"point"}, ANGLE, "length of the branch from the cycle on, parts left out not counted"},
    {"saddle", KZ_INT32, {"point"}, NONE, "id of the unstable cycle"},
    {"branch", KZ_INT32, {"point"}, NONE, "twice the place of the strobe point along the cycle, plus 1 for its other side"},
    {"kind", KZ_INT8, {"point"}, NONE, "which manifold", {"unstable", "stable"}},
    {"polyline", KZ_INT32, {"point"}, NONE, "neighbours in the list are joined where this is the same"},
    {0},
};
/* clang-format on */
