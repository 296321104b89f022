/* The study `escape`: its row, and the table of its keys. */
#define KEYS_OF escape

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    STUDY("Study: the least torque that takes a motion out of its basin, or into another one.", .former = "edge=escape"),
    ROW("escape.from", KZ_KEY_INTEGERS, "", AT(from), "Ids of the attractors that are left; left out: all that are cycles.",
        .unit = "", .low = 0, .high = 1e6),
    BOOLEAN("escape.into_every_basin", "false", everywhere, "Look for paths into every basin too, not only out of each."),
    INTEGER("escape.starts", 1, 1e6, "24", starts, "Guesses from each attractor to each saddle."),
    {.path = NULL},
};

KZ_STUDY_ROW(.damped = true, .needs = {{"a list of attractors", "basin|attractors"}, {"a list of unstable cycles", "saddles"}});
