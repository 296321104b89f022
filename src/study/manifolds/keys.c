/* The study `manifolds`: its row, and the table of its keys. */
#define KEYS_OF manifolds

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    STUDY("Study: stable and unstable manifolds of the cycles of saddles, as polylines; stable ones bound the basins."),
    ROW("manifolds.saddles", KZ_KEY_INTEGERS, "", AT(saddles), "Ids of the cycles in the group saddles; left out: all of them.",
        .unit = "", .low = 0, .high = 1e6),
    WORD("manifolds.kind", "both|stable|unstable", "both", kind, "Which manifolds."),
    REAL("manifolds.length", "rad", KZ_ABOVE_ZERO, 1e5, "20", length,
         "Length of each branch: rad and rad per drive radian together, below max_speed."),
    REAL("manifolds.spacing", "rad", 1e-6, 1, "0.02", spacing,
         "Largest distance of neighbouring points; up to 32 times smaller where a manifold bends by over 0.3 rad."),
    REAL("manifolds.max_speed", KZ_VELOCITY_UNIT, KZ_ABOVE_ZERO, 1e3, "2", max_speed, "Parts at larger speeds are left out."),
    {.path = NULL},
};

KZ_STUDY_ROW(.needs = {{"a list of unstable cycles", "saddles"}});
