/* The part `shocks` of the study basin: its row, and its keys. */
#define KEYS_OF shocks

#include "kapitza/study_key_rows.h"
#include "resilience.h"

static const kz_key keys[] = {
    KZ_ROW("basin.shocks", KZ_KEY_MAPPING, "", KZ_ROW_OF_SCENE(has_shocks),
           "The smallest shocks (a sudden change of angle, of velocity, of both) that push each attractor out of its "
           "basin.",
           .unit = ""),
    KZ_ROW_REAL("basin.shocks.scale", KZ_VELOCITY_UNIT, 1e-6, 1e6, "1", scale,
                "Change of the velocity that counts as much as 1 rad; the size of a shock is hypot(dtheta, dv/scale)."),
    KZ_ROW("basin.shocks.sizes", KZ_KEY_REALS, "[0.1, 0.3, 1]", KZ_ROW_AT(sizes),
           "Sizes, ascending, for which the share of harmless shocks is computed.", .unit = "rad", .low = KZ_ABOVE_ZERO,
           .high = 1e3),
    {.path = NULL},
};

static const char *keys_lack(const kz_scene *scene) {
  return kz_sizes_lack(&scene->shocks->sizes);
}

KZ_PART_ROW("basin.shocks", has_shocks, .of_basin = &kz_shocks_part, .lack = keys_lack);
