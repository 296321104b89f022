/* Variables of the group measures of the result file. */
#include "variable_words.h"
#include "measures.h"

#define NUMBER(word, needs, unit, name) {#word, KZ_REAL, {"attractor"}, unit, name},
#define INTERVAL(word, needs, unit, name)                                                                        \
  NUMBER(word, needs, unit, name){#word "_low", KZ_REAL, {"attractor"}, unit, "lower end of its 95 % interval"}, \
      {#word "_high", KZ_REAL, {"attractor"}, unit, "upper end of its 95 % interval"},
#define SIZES(word, needs, unit, name) {#word, KZ_REAL, {"attractor", "size"}, unit, name},
#define PAIR(word, needs, unit, name) {#word, KZ_REAL, {"attractor", "other"}, unit, name},
#define PENDULUM(word, needs, unit, name) /* an attribute of the group */

/* clang-format off */
const kz_variable kz_measures_variables[] = {
    {"attractor", KZ_INT32, {"attractor"}, NONE, "number of the attractor in this group"},
    {"other", KZ_INT32, {"other"}, NONE, "number of another attractor"},
    {"size", KZ_REAL, {"size"}, ANGLE, "size of the shocks"},
    {"name", KZ_TEXT, {"attractor"}, NONE, "name of the attractor; names may repeat"},
    {"period", KZ_INT32, {"attractor"}, PERIODS, "period of the orbit; 0 = it never closes"},
    {"winding", KZ_INT32, {"attractor"}, NONE,
     "net turns in one period, + counterclockwise; of a running state 1 or -1"},
    {"centre", KZ_INT8, {"attractor"}, NONE, "what the orbit moves about", {CENTRES}},
    {"theta", KZ_REAL, {"attractor"}, ANGLE,
     "angle of the first strobe point from down; of a chaotic one its mean, of a running one NaN"},
    {"velocity", KZ_REAL, {"attractor"}, VELOCITY,
     "angular velocity of the same strobe point; of one that never closes its mean"},
    KZ_MEASURES(NUMBER, INTERVAL, SIZES, PAIR, PENDULUM)
    {0},
};
/* clang-format on */
