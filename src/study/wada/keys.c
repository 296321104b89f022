/* The study `wada`: its row, and the table of its keys. */
#define KEYS_OF wada

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    STUDY("Study: the basins that the unstable manifold of each cycle of saddles meets, and which boundaries more than two "
          "basins share."),
    REAL("wada.length", "rad", KZ_ABOVE_ZERO, 1e5, "10", length,
         "Length of each branch of an unstable manifold: rad and rad per drive radian together, below max_speed."),
    REAL("wada.spacing", "rad", 1e-6, 1, "0.02", spacing, "Largest distance of neighbouring points, as in manifolds."),
    REAL("wada.max_speed", KZ_VELOCITY_UNIT, KZ_ABOVE_ZERO, 1e3, "10", max_speed, "Parts at larger speeds are left out."),
    {.path = NULL},
};

KZ_STUDY_ROW(.damped = true, .needs = {{"a list of attractors", "basin|attractors"}, {"a list of unstable cycles", "saddles"}});
