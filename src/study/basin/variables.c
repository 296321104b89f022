/* Variables of the group basin of the result file. */
#include "variable_words.h"
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
    {"velocity_offset", KZ_REAL, {"velocity"}, NONE,
     "angular velocity less the attribute velocity_centre, in units of velocity_width"},
    {"theta_offset", KZ_REAL, {"theta"}, NONE,
     "angle of the cell centre less the attribute theta_centre, in units of theta_width"},
    {"attractor", KZ_INT16, {"velocity", "theta"}, NONE, "id of the attractor that is reached; -1 = not settled"},
    {"settling_time", KZ_UINT32, {"velocity", "theta"}, PERIODS,
     "time after which it is certain where the start ends (inside a trapping region)"},
    {"evidence", KZ_UINT8, {"velocity", "theta"}, NONE, "how the label is known", {EVIDENCE}},
    {"other_attractor", KZ_INT16, {"velocity", "theta"}, NONE,
     "id of the second candidate of an undecided cell; -1 = none"},
    {"turns", KZ_INT32, {"velocity", "theta"}, NONE, "net turns until the end, counterclockwise +"},
    {0},
};
/* clang-format on */
