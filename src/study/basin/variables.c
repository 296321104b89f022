/* Variables of the groups basin, phases, boundary and shocks of the result file. */
#include "kapitza/store_variables.h"
#include "basin.h"

#define EVIDENCE                                                                                                      \
  "unsettled", "started_inside_a_trapping_region", "followed_into_a_trapping_region", "undecided",                    \
      "decided_in_quad_precision", "decided_in_pairs_of_doubles", "proved_in_doubles",                                \
      "decided_in_double_precision_with_more_steps", "decided_in_as_many_digits_as_it_took", "followed_but_doubtful", \
      "proved_in_pairs_of_doubles", "proved_in_triples_of_doubles", "running_by_averages"

/* clang-format off */
const kz_variable kz_basin_variables[] = {
    {"velocity", KZ_REAL, {"velocity"}, VELOCITY, "angular velocity of the cell centre"},
    {"theta", KZ_REAL, {"theta"}, ANGLE, "angle of the cell centre from down, counterclockwise"},
    {"velocity_offset", KZ_REAL, {"velocity"}, NONE, "angular velocity less the attribute velocity_centre, in units of velocity_width"},
    {"theta_offset", KZ_REAL, {"theta"}, NONE, "angle of the cell centre less the attribute theta_centre, in units of theta_width"},
    {"attractor", KZ_INT16, {"velocity", "theta"}, NONE, "id of the attractor that is reached; -1 = not settled"},
    {"settling_time", KZ_UINT32, {"velocity", "theta"}, PERIODS, "time after which it is certain where the start ends (inside a trapping region)"},
    {"evidence", KZ_UINT8, {"velocity", "theta"}, NONE, "how the label is known", {EVIDENCE}},
    {"other_attractor", KZ_INT16, {"velocity", "theta"}, NONE, "id of the second candidate of an undecided cell; -1 = none"},
    {"turns", KZ_INT32, {"velocity", "theta"}, NONE, "net turns until the end, counterclockwise +"},
    {0},
};

const kz_variable kz_phases_variables[] = {
    {"phase", KZ_REAL, {"phase"}, ANGLE, "phase of the drive at which the cells are released"},
    {"velocity", KZ_REAL, {"velocity"}, VELOCITY, "angular velocity of the cell centre"},
    {"theta", KZ_REAL, {"theta"}, ANGLE, "angle of the cell centre from down, counterclockwise"},
    {"attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor"},
    {"fraction", KZ_REAL, {"phase", "attractor"}, NONE, "share of the cells that end there"},
    {"common", KZ_INT16, {"velocity", "theta"}, NONE, "id of the attractor that is reached at all phases; -1 = none"},
    {"ends", KZ_UINT8, {"velocity", "theta"}, NONE, "number of different ends; not settled counts as one"},
    {0},
};

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

const kz_variable kz_shocks_variables[] = {
    {"point", KZ_INT32, {"point"}, NONE, "place of the strobe point in the list"},
    {"size", KZ_REAL, {"size"}, ANGLE, "largest size of the shocks: hypot(dtheta, dv / scale)"},
    {"attractor", KZ_INT32, {"point"}, NONE, "id of the attractor"},
    {"phase", KZ_INT32, {"point"}, NONE, "place of the strobe point along the orbit"},
    {"strobe_theta", KZ_REAL, {"point"}, ANGLE, "angle of the strobe point from down"},
    {"strobe_velocity", KZ_REAL, {"point"}, VELOCITY, "angular velocity of the strobe point"},
    {"angle", KZ_REAL, {"point"}, ANGLE, "smallest change of the angle alone that leaves the basin; NaN = none does"},
    {"angle_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"kick", KZ_REAL, {"point"}, VELOCITY, "smallest change of the velocity alone that leaves the basin; NaN = none"},
    {"kick_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"shock_theta", KZ_REAL, {"point"}, ANGLE, "change of the angle of the smallest shock that leaves the basin"},
    {"shock_velocity", KZ_REAL, {"point"}, VELOCITY, "change of the velocity of the smallest shock"},
    {"shock_size", KZ_REAL, {"point"}, ANGLE, "size of the smallest shock: hypot(dtheta, dv / scale)"},
    {"shock_end", KZ_INT32, {"point"}, NONE, "id of the attractor where it leads; -1 = none"},
    {"harmless", KZ_REAL, {"point", "size"}, NONE, "share of the shocks up to a size that stay in the basin"},
    {"return_time", KZ_REAL, {"point", "size"}, PERIODS, "mean time until a harmless shock is trapped again"},
    {0},
};
/* clang-format on */
