/* The study `orbit`: its row, and the table of its keys. */
#define KEYS_OF orbit

#include "kapitza/study_key_rows.h"
#include "kapitza/study_orbit.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: one motion, its strobe points, turning points and spectrum."),
    KZ_ROW_MAPPING("orbit.start", "", "The start, at t = 0. Give this or an attractor."),
    KZ_ROW_REAL("orbit.start.theta", "rad", -1e6, 1e6, NULL, theta, "Angle from down."),
    KZ_ROW_REAL("orbit.start.velocity", KZ_VELOCITY_UNIT, -1e9, 1e9, NULL, velocity, "Velocity."),
    KZ_ROW_INTEGER(
        "orbit.attractor", 0, 32767, "", attractor,
        "Id in the catalogue of the basin or attractors study of the same scene: its closed orbit from the first "
        "strobe "
        "point."),
    KZ_ROW_WORD(
        "orbit.model", "pendulum|mathieu|effective", "pendulum", model,
        "pendulum: the full equation; mathieu: linear about down or inverted; effective: the slow equation of the "
        "effective "
        "potential."),
    KZ_ROW_WORD("orbit.about", "down|inverted", "", about,
                "Position that the model mathieu is linear about; left out: down."),
    KZ_ROW_INTEGER("orbit.transient", 0, 1e9, "0", transient, "Drive periods before the record begins."),
    KZ_ROW_INTEGER(
        "orbit.periods", 1, 1e6, "", periods,
        "Drive periods of the record; left out: 100, or the period of a closed orbit; a closed orbit is recorded "
        "once at "
        "least."),
    KZ_ROW_INTEGER("orbit.samples_per_period", 4, 4096, "96", samples_per_period,
                   "Points of the series in a drive period."),
    KZ_ROW_BOOLEAN(
        "orbit.closed", "false", closed,
        "The cycle near the start, by Newton's method, instead of the motion from it; of the model mathieu: the motion "
        "must close."),
    KZ_ROW_INTEGER("orbit.period", 1, 512, "", period,
                   "Period of the closed orbit in drive periods. Left out: the program finds it."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_orbit_check, .follows = true);
