/* Variables of the group escape of the result file. */
#include "variable_words.h"
#include "kapitza/study.h"

#define ACTION "1|units of I omega^2"
#define TORQUE "1|units of I omega^2"

/* clang-format off */
const kz_variable kz_escape_variables[] = {
    {"route", KZ_INT32, {"route"}, NONE, "place in the list of paths"},
    {"family", KZ_INT32, {"family"}, NONE, "local minima of the action, the least first"},
    {"from", KZ_INT32, {"route"}, NONE, "id of the attractor that the path leaves"},
    {"saddle", KZ_INT32, {"route"}, NONE, "id of the unstable cycle at which it ends"},
    {"is_gate", KZ_INT8, {"route"}, NONE,
     "whether this cycle lies on the edge of the attractor's basin", {"no", "yes"}},
    {"before", KZ_INT32, {"route"}, NONE,
     "id of the attractor on this side of the unstable cycle; another one than `from`: the path goes over another "
     "basin; -1 = none"},
    {"into", KZ_INT32, {"route"}, NONE, "id of the attractor on the other side; -1 = none"},
    {"barrier", KZ_REAL, {"route"}, ACTION, "least action that was found: integral of torque^2 / (4 beta) over time"},
    {"barrier_by_k", KZ_REAL, {"route"}, NONE, "derivative of the action by k"},
    {"barrier_by_m", KZ_REAL, {"route"}, NONE, "derivative of the action by m"},
    {"barrier_by_beta", KZ_REAL, {"route"}, NONE, "derivative of the action by beta"},
    {"largest_torque", KZ_REAL, {"route"}, TORQUE, "largest torque along the path"},
    {"periods", KZ_INT32, {"route"}, PERIODS, "length of the path"},
    {"starts", KZ_INT32, {"route"}, NONE, "guesses that led to a minimum"},
    {"agrees", KZ_INT8, {"route"}, NONE,
     "whether the search for the mirror image found the same action to 1e-9", {"no", "yes"}},
    {"family_barrier", KZ_REAL, {"route", "family"}, ACTION, "action of each minimum that was found"},
    {"family_hits", KZ_INT32, {"route", "family"}, NONE, "guesses that led to it"},
    {"attractor", KZ_INT32, {"attractor"}, NONE, "id of the attractor"},
    {"way_out", KZ_INT32, {"attractor"}, NONE, "path of least action out of its basin; -1 = none was sought or found"},
    {"barrier_out", KZ_REAL, {"attractor"}, ACTION, "action of this path"},
    {"life_exponent", KZ_REAL, {"attractor"}, ACTION,
     "limit of T ln(mean life) for weak noise of intensity 2 beta T, islands included"},
    {"island", KZ_INT32, {"attractor"}, NONE,
     "id of the attractor over which the way leads that decides the life; -1 = none"},
    {"target", KZ_INT32, {"target"}, NONE, "id of the attractor that a path leads to"},
    {"way_into", KZ_INT32, {"attractor", "target"}, NONE,
     "path of least action to the edge of that basin; on the diagonal out of the own one; -1 = none"},
    {"barrier_into", KZ_REAL, {"attractor", "target"}, ACTION, "action of this path"},
    {"temperature", KZ_REAL, {"temperature"}, ACTION, "temperature T of white noise of intensity 2 beta T"},
    {"life", KZ_REAL, {"attractor", "temperature"}, PERIODS, "mean life that was counted"},
    {"life_low", KZ_REAL, {"attractor", "temperature"}, PERIODS, "lower end of its 95 % interval"},
    {"life_high", KZ_REAL, {"attractor", "temperature"}, PERIODS, "upper end of its 95 % interval"},
    {"life_ended", KZ_INT32, {"attractor", "temperature"}, NONE, "number of lives that ended"},
    {"point", KZ_INT32, {"point"}, NONE, "place in the list of points of paths"},
    {"path", KZ_INT32, {"point"}, NONE, "path of the point: its place in `route`"},
    {"time", KZ_REAL, {"point"}, PERIODS, "time since the path's first strobe"},
    {"theta", KZ_REAL, {"point"}, ANGLE, "angle from down, not wrapped"},
    {"velocity", KZ_REAL, {"point"}, VELOCITY, "angular velocity"},
    {"torque", KZ_REAL, {"point"}, TORQUE, "torque of least action"},
    {0},
};
/* clang-format on */
