/* Variables of the group saddles of the result file. */
#include "variable_words.h"
#include "saddles.h"

/* clang-format off */
const kz_variable kz_saddles_variables[] = {
    {"saddle", KZ_INT32, {"saddle"}, NONE, "id of the unstable cycle"},
    KZ_MOTION_VARIABLES("saddle"),
    {"period", KZ_INT32, {"saddle"}, PERIODS, "period of the orbit"},
    {"name", KZ_TEXT, {"saddle"}, NONE, "name of the unstable cycle; names may repeat"},
    {"index", KZ_INT8, {"saddle"}, NONE,
     "fixed-point index of each of its points under F^period: sign of (1 - mu1)(1 - mu2)"},
    {"sum", KZ_INT32, {"sum"}, NONE, "place in the list of index sums"},
    {"sum_period", KZ_INT32, {"sum"}, PERIODS, "n of the fixed points of F^n in the sum"},
    {"sum_winding", KZ_INT32, {"sum"}, NONE, "turns of these fixed points in n periods"},
    {"sum_points", KZ_INT32, {"sum"}, NONE, "number of these fixed points, attracting ones included"},
    {"index_sum", KZ_INT32, {"sum"}, NONE, "sum of their fixed-point indices; 0 where none is missing"},
    {0},
};
/* clang-format on */
