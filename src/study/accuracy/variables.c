/* Variables of the group tradeoff of the result file. */
#include "variable_words.h"
#include "accuracy.h"
#include "kapitza/study_basin.h"

/* clang-format off */
const kz_variable kz_tradeoff_variables[] = {
    {"setting", KZ_INT32, {"setting"}, NONE, "place in the list of settings"},
    {"label", KZ_TEXT, {"setting"}, NONE, "name of the setting"},
    {"method", KZ_INT8, {"setting"}, NONE, "how cells are labelled", {KZ_METHOD_WORDS}},
    {"scheme", KZ_TEXT, {"setting"}, NONE, "integrator"},
    {"steps_per_period", KZ_INT32, {"setting"}, NONE, "steps of the scheme in a drive period"},
    {"interpolation", KZ_INT8, {"setting"}, NONE,
     "interpolation of the map table, which a direct label does not use", {KZ_INTERPOLATION_WORDS}},
    {"table_nodes", KZ_INT32, {"setting"}, NONE, "nodes of the map table along each axis"},
    {"wrong", KZ_REAL, {"setting"}, NONE, "share of cells whose label differs from the reference"},
    {"wrong_low", KZ_REAL, {"setting"}, NONE, "lower end of its 95 % interval"},
    {"wrong_high", KZ_REAL, {"setting"}, NONE, "upper end of its 95 % interval"},
    {"undecided", KZ_REAL, {"setting"}, NONE, "share of cells that method exact does not decide"},
    {"wrong_inside", KZ_REAL, {"setting"}, NONE, "share of cells that are wrong without another label next to them"},
    {"wrong_distance", KZ_REAL, {"setting"}, "1|cells", "median distance of the wrong cells from another label"},
    {"fraction_error", KZ_REAL, {"setting"}, NONE, "largest error of a basin's share of the sample"},
    {"seconds", KZ_REAL, {"setting"}, "s", "processor time of one core for the map table and all cells of the basin"},
    {"seconds_per_million_cells", KZ_REAL, {"setting"}, "s", "processor time of one core to label a million cells"},
    {"pareto", KZ_INT8, {"setting"}, NONE, "whether no other setting is both as fast and as accurate", {"no", "yes"}},
    {0},
};
/* clang-format on */
