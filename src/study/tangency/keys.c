/* The study `tangency`: its row, and the table of its keys. */
#define KEYS_OF tangency

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    STUDY("Study: the value of a key of the pendulum at which an unstable and a stable manifold touch and begin to cross.",
          .range = KZ_RANGE_PARAMETER, .range_offset = offsetof(kz_tangency_plan, axis)),
    ROW("tangency.parameter", KZ_KEY_WORD, NULL, AT(axis.parameter), "Key of the pendulum mapping, as written there.",
        .unit = "", .words_from = kz_motion_words),
    REAL("tangency.min", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, axis.values.min,
         "First value; the manifolds cross at one end only."),
    REAL("tangency.max", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, axis.values.max, "Last value."),
    INTEGER("tangency.saddle", 0, 1e6, "0", saddle, "Id, in the group saddles, of the cycle of the unstable manifold."),
    INTEGER("tangency.into", 0, 1e6, "", into, "Id of the cycle of the stable manifold; left out: the same cycle."),
    REAL("tangency.length", "rad", KZ_ABOVE_ZERO, 100, "8", length,
         "Length of each branch that is looked at: rad and rad per drive radian together."),
    {.path = NULL},
};

KZ_STUDY_ROW(.needs = {{"a list of unstable cycles", "saddles"}});
