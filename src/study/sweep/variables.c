/* Variables of the groups sweep and plane of the result file. */
#include "variable_words.h"
#include "sweep.h"

#define OWN "@parameter_units" /* units of the swept key */
#define END_KINDS \
  "left_the_range", "fold", "period_doubling", "neimark_sacker", "symmetry_breaking", "not_located", "homoclinic"

/* clang-format off */
const kz_variable kz_sweep_variables[] = {
    {"value", KZ_REAL, {"value"}, OWN, "value of the swept key of the pendulum"},
    {"branch", KZ_INT32, {"branch"}, NONE, "number of the branch"},
    {"branch_name", KZ_TEXT, {"branch"}, NONE, "name of the attractor where the branch begins"},
    {"branch_period", KZ_INT32, {"branch"}, PERIODS, "period of the orbit; 0 = it never closes"},
    {"branch_winding", KZ_INT32, {"branch"}, NONE,
     "net turns in one period, + counterclockwise; of a running state 1 or -1"},
    {"branch_centre", KZ_INT8, {"branch"}, NONE, "what the orbit moves about where the branch begins", {CENTRES}},
    {"branch_symmetric", KZ_INT8, {"branch"}, NONE, "whether the orbit is its own mirror image", {"no", "yes"}},
    {"branch_stable", KZ_INT8, {"branch"}, NONE, "whether the orbit attracts along the branch", {"no", "yes"}},
    {"branch_mirror", KZ_INT32, {"branch"}, NONE, "number of the branch of mirror images; -1 = not seen"},
    {"branch_start", KZ_REAL, {"branch"}, OWN, "lowest value at which the branch exists, and attracts if it is stable"},
    {"branch_end", KZ_REAL, {"branch"}, OWN, "highest value at which the branch exists, and attracts if it is stable"},
    {"branch_start_kind", KZ_INT8, {"branch"}, NONE, "how the branch begins", {END_KINDS}},
    {"branch_end_kind", KZ_INT8, {"branch"}, NONE, "how the branch ends", {END_KINDS}},
    {"branch_amplitude", KZ_REAL, {"value", "branch"}, ANGLE, "largest angle from the centre; NaN = not there"},
    {"branch_multiplier", KZ_REAL, {"value", "branch"}, NONE, "modulus of the largest Floquet multiplier"},
    {"branch_theta", KZ_REAL, {"value", "branch"}, ANGLE, "angle of one strobe point from down"},
    {"branch_velocity", KZ_REAL, {"value", "branch"}, VELOCITY, "angular velocity of the same strobe point"},
    {"lifetime", KZ_REAL, {"value"}, PERIODS,
     "mean time from lifetime_after on until a motion settles; NaN = none settled"},
    {"lifetime_low", KZ_REAL, {"value"}, PERIODS, "lower end of its 95 % interval"},
    {"lifetime_high", KZ_REAL, {"value"}, PERIODS, "upper end of its 95 % interval"},
    {"lifetime_after", KZ_REAL, {"value"}, PERIODS, "time from which the mean lifetime is counted"},
    {"lifetime_open", KZ_REAL, {"value"}, NONE, "starts that had not settled in the end"},
    {"fraction", KZ_REAL, {"value", "branch"}, NONE, "share of the cells or starts; NaN = not there"},
    {"fraction_low", KZ_REAL, {"value", "branch"}, NONE, "lower end of the 95 % interval of the share (Wilson)"},
    {"fraction_high", KZ_REAL, {"value", "branch"}, NONE, "upper end of the 95 % interval of the share (Wilson)"},
    {"fraction_unsettled", KZ_REAL, {"value"}, NONE, "share of the cells or starts that ended on nothing known"},
    {"release_angle", KZ_REAL, {"value"}, ANGLE, "angle from inverted at which a release from rest first fails"},
    {"release_angle_scan", KZ_REAL, {"value"}, ANGLE, "the same by a scan in whole degrees, refined by bisection"},
    {"release_angle_largest", KZ_REAL, {"value"}, ANGLE, "end of the last interval of releases that stay"},
    {"release", KZ_REAL, {"release"}, ANGLE, "angle from inverted of a release from rest"},
    {"release_stays", KZ_UINT8, {"value", "release"}, NONE, "whether the release stays about inverted", {"no", "yes"}},
    {"sample", KZ_INT32, {"sample"}, PERIODS, "strobe points of the walk up, then of the walk down"},
    {"sample_walk", KZ_INT8, {"sample"}, NONE, "direction of the walk along the values", {"up", "down"}},
    {"strobe_theta", KZ_REAL, {"value", "sample"}, ANGLE, "angle of the strobe point from down"},
    {"strobe_velocity", KZ_REAL, {"value", "sample"}, VELOCITY, "angular velocity of the strobe point"},
    {0},
};

const kz_variable kz_plane_variables[] = {
    {"x", KZ_REAL, {"x"}, "@x_units", "value of the key x_parameter of the pendulum"},
    {"y", KZ_REAL, {"y"}, "@y_units", "value of the key y_parameter of the pendulum"},
    {0},
};
/* clang-format on */
