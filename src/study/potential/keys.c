/* The study `potential`: its row, and the table of its keys. */
#define KEYS_OF potential

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: the effective potential of the slow motion over the whole circle."),
    KZ_ROW("potential.drive_amplitudes", KZ_KEY_REALS, NULL, KZ_ROW_AT(drive_amplitudes),
           "Values of m (epsilon), instead of the pendulum's.", .unit = "", .low = -1e6, .high = 1e6),
    KZ_ROW_MAPPING("potential.theta", "", "Angles from -pi to pi, both ends included."),
    KZ_ROW_INTEGER("potential.theta.count", 2, 1e6, "721", theta_count, "Number of angles."),
    {.path = NULL},
};

KZ_STUDY_ROW();
