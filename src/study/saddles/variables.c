/* Variables of the group saddles of the result file. */
#include "kapitza/store_variables.h"
#include "saddles.h"

/* clang-format off */
const kz_variable kz_saddles_variables[] = {
    {"saddle", KZ_INT32, {"saddle"}, NONE, "id of the unstable cycle"},
    {"phase", KZ_INT32, {"phase"}, NONE, "place of the strobe point along the orbit"},
    {"pair", KZ_INT32, {"pair"}, NONE, "place of the Floquet multiplier, larger modulus first"},
    {"period", KZ_INT32, {"saddle"}, PERIODS, "period of the orbit"},
    {"winding", KZ_INT32, {"saddle"}, NONE, "net turns in one period of the orbit, + counterclockwise"},
    {"centre", KZ_INT8, {"saddle"}, NONE, "what the orbit moves about", {CENTRES}},
    {"name", KZ_TEXT, {"saddle"}, NONE, "name of the unstable cycle; names may repeat"},
    {"symmetric", KZ_INT8, {"saddle"}, NONE, "whether the orbit is its own mirror image", {"no", "yes"}},
    {"mirror", KZ_INT32, {"saddle"}, NONE, "id of the mirror image under (theta, velocity) -> -(theta, velocity)"},
    {"index", KZ_INT8, {"saddle"}, NONE, "fixed-point index of each of its points under F^period: sign of (1 - mu1)(1 - mu2)"},
    {"strobe_theta", KZ_REAL, {"saddle", "phase"}, ANGLE, "angle of the strobe point from down"},
    {"strobe_velocity", KZ_REAL, {"saddle", "phase"}, VELOCITY, "angular velocity of the strobe point"},
    {"multiplier_re", KZ_REAL, {"saddle", "pair"}, NONE, "Floquet multiplier over one period of the orbit, real part"},
    {"multiplier_im", KZ_REAL, {"saddle", "pair"}, NONE, "Floquet multiplier over one period of the orbit, imaginary part"},
    {"sum", KZ_INT32, {"sum"}, NONE, "place in the list of index sums"},
    {"sum_period", KZ_INT32, {"sum"}, PERIODS, "n of the fixed points of F^n in the sum"},
    {"sum_winding", KZ_INT32, {"sum"}, NONE, "turns of these fixed points in n periods"},
    {"sum_points", KZ_INT32, {"sum"}, NONE, "number of these fixed points, attracting ones included"},
    {"index_sum", KZ_INT32, {"sum"}, NONE, "sum of their fixed-point indices; 0 where none is missing"},
    {0},
};
/* clang-format on */
