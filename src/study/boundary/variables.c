/* Variables of the group boundary of the result file. */
#include "variable_words.h"
#include "kapitza/study.h"

/* clang-format off */
const kz_variable kz_boundary_variables[] = {
    {"distance", KZ_REAL, {"distance"}, ANGLE, "distance of the pairs"},
    {"uncertain_share", KZ_REAL, {"distance"}, NONE, "share of the pairs that end differently"},
    {"uncertain_low", KZ_REAL, {"distance"}, NONE, "lower end of its 95 % interval (Wilson)"},
    {"uncertain_high", KZ_REAL, {"distance"}, NONE, "upper end of its 95 % interval (Wilson)"},
    {"slope", KZ_REAL, {"distance"}, NONE, "uncertainty exponent between this distance and the next"},
    {"slope_low", KZ_REAL, {"distance"}, NONE, "lower end of its 95 % interval"},
    {"slope_high", KZ_REAL, {"distance"}, NONE, "upper end of its 95 % interval"},
    {"box", KZ_INT32, {"box"}, NONE, "level of the boxes"},
    {"basin", KZ_INT32, {"basin"}, NONE, "id of the attractor; 63 stands for all larger ids too"},
    {"box_cells", KZ_INT32, {"box"}, NONE, "cells along an edge of a box"},
    {"boxes", KZ_INT32, {"box"}, NONE, "boxes that hold more than one label"},
    {"dimension", KZ_REAL, {"box"}, NONE, "box-counting dimension between this size and the next"},
    {"shared", KZ_REAL, {"box", "basin"}, NONE, "share of these boxes that hold the basin"},
    {0},
};
/* clang-format on */
