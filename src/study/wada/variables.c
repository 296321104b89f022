/* Variables of the group wada of the result file. */
#include "kapitza/store_variables.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_wada_variables[] = {
    {"saddle", KZ_INT32, {"saddle"}, NONE, "id of the unstable cycle"},
    {"side", KZ_INT32, {"side"}, NONE, "side of the cycle to which a branch of its unstable manifold leaves"},
    {"attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor"},
    {"other", KZ_INT32, {"other"}, NONE, "id of another attractor"},
    {"theta", KZ_REAL, {"saddle", "side", "attractor"}, ANGLE, "angle of a point of the branch that lies in the basin; NaN: none is known"},
    {"velocity", KZ_REAL, {"saddle", "side", "attractor"}, VELOCITY, "angular velocity of this point"},
    {"arc_length", KZ_REAL, {"saddle", "side", "attractor"}, ANGLE, "length of the branch up to this point"},
    {"periods", KZ_REAL, {"saddle", "side", "attractor"}, PERIODS, "from this point until a trapping region holds the motion"},
    {"followed", KZ_INT8, {"saddle", "side"}, NONE, "whether all points of the branch lie in one basin, the last one in a trapping region", {"no", "yes"}},
    {"basins", KZ_INT32, {"saddle"}, NONE, "number of basins that share the cycle's stable manifold as a boundary; 1: it bounds none"},
    {"wada", KZ_INT8, {"attractor"}, NONE, "whether three basins or more share the boundary of this one, at the known cycles", {"open", "no", "partly", "yes"}},
    {"pair_cycles", KZ_INT32, {"attractor", "other"}, NONE, "number of cycles whose stable manifolds bound both basins"},
    {"pair_shared", KZ_INT32, {"attractor", "other"}, NONE, "number of those that bound a third basin too"},
    {0},
};
/* clang-format on */
