/* The study `escape`: its row, and the table of its keys. */
#define KEYS_OF escape

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: the least torque that takes a motion out of its basin, or into another one.",
                 .former = "edge=escape"),
    KZ_ROW("escape.from", KZ_KEY_INTEGERS, "", KZ_ROW_AT(from),
           "Ids of the attractors that are left; left out: all that are cycles.", .unit = "", .low = 0, .high = 1e6),
    KZ_ROW_BOOLEAN("escape.into_every_basin", "false", everywhere,
                   "Look for paths into every basin too, not only out of each."),
    KZ_ROW_INTEGER("escape.starts", 1, 1e6, "24", starts, "Guesses from each attractor to each saddle."),
    KZ_ROW("escape.temperatures", KZ_KEY_REALS, "", KZ_ROW_AT(temperatures),
           "Temperatures T, in units of I omega^2, at which mean lives are counted.", .unit = "", .low = KZ_ABOVE_ZERO,
           .high = 1e6),
    KZ_ROW_INTEGER("escape.walkers", 1, 1e7, "400", walkers, "Motions under noise for each attractor and temperature."),
    KZ_ROW_INTEGER("escape.max_periods", 1, 1e12, "1000000", max_periods,
                   "Longest life of such a motion, in drive periods."),
    KZ_ROW_REAL("escape.angle", "rad", KZ_ABOVE_ZERO, 1e6, "2.6", angle,
                "A life has ended when a strobe lies farther from the undisturbed motion."),
    KZ_ROW_RANGE("escape.x", KZ_RANGE_PARAMETER, x, "",
                 "Barriers along this key of the pendulum mapping too, out of the basins that are left."),
    KZ_ROW_PLANE_KEYS(escape, x),
    KZ_ROW_INTEGER("escape.x.count", 2, 1e5, NULL, x.values.count, "Number of values, both ends included."),
    KZ_ROW_RANGE("escape.y", KZ_RANGE_PARAMETER, y, "", "Over a plane: the key along the vertical axis."),
    KZ_ROW_PLANE_KEYS(escape, y),
    KZ_ROW_INTEGER("escape.y.count", 2, 1e5, NULL, y.values.count, "Number of values, both ends included."),
    KZ_ROW_INTEGER("escape.search_every", 1, KZ_ESCAPE_MOST_PATCH, "8", patch,
                   "Values of x, and of y, between two searches; in between paths are continued."),
    {.path = NULL},
};

static const char *keys_lack(const kz_scene *scene) {
  return scene->escape->y.parameter >= 0 && scene->escape->x.parameter < 0
             ? "y: is the second axis of a plane; give x for a line along one key, or x and y"
             : NULL;
}

KZ_STUDY_ROW(.damped = true, .lack = keys_lack,
             .needs = {{"a list of attractors", "basin|attractors"}, {"a list of unstable cycles", "saddles"}});
