/* The study `sweep`: its row, and the table of its keys. */
#define KEYS_OF sweep

#include "kapitza/study_key_rows.h"
#include "plan.h"

/* An axis of a plane, whose mapping belongs to form c. */
#define PLANE_OF(axis, help)                                                                  \
  KZ_ROW("sweep." #axis, KZ_KEY_MAPPING, NULL, KZ_ROW_NOWHERE, help, .unit = "", .form = "c", \
         .range = KZ_RANGE_PARAMETER, .range_offset = offsetof(kz_sweep_plan, axis)),         \
      KZ_ROW_PLANE_KEYS(sweep, axis),                                                         \
      KZ_ROW_INTEGER("sweep." #axis ".count", 2, 1e5, NULL, axis.values.count,                \
                     "Number of values, both ends included.")

static const kz_key keys[] = {
    KZ_ROW_STUDY(
        "Study: quantities along one key of the pendulum mapping, at the values of a range (a) or a list (b), or "
        "over two "
        "keys (c).",
        .former = "chart=sweep.measure ends, with sweep.x, sweep.y and sweep.ends"),
    KZ_ROW("sweep.parameter", KZ_KEY_WORD, NULL, KZ_ROW_AT(parameter),
           "Key of the pendulum mapping, as written there, that takes the values; pendulum.KEY is the same.",
           .unit = "", .words_from = kz_sweep_words, .form = "ab"),
    KZ_ROW("sweep.min", KZ_KEY_REAL, NULL, KZ_ROW_AT(range.min), "First value.", .unit = KZ_OWN_UNIT, .low = -DBL_MAX,
           .high = DBL_MAX, .form = "a"),
    KZ_ROW("sweep.max", KZ_KEY_REAL, NULL, KZ_ROW_AT(range.max), "Last value.", .unit = KZ_OWN_UNIT, .low = -DBL_MAX,
           .high = DBL_MAX, .form = "a"),
    KZ_ROW_INTEGER("sweep.count", 2, 1e5, NULL, range.count, "Number of values, both ends included.", .form = "a"),
    KZ_ROW("sweep.values", KZ_KEY_REALS, NULL, KZ_ROW_AT(listed), "The values themselves, ascending, two or more.",
           .unit = KZ_OWN_UNIT, .low = -DBL_MAX, .high = DBL_MAX, .form = "b"),
    PLANE_OF(x, "Over a plane instead: the key along the horizontal axis."),
    PLANE_OF(y, "The key along the vertical axis."),
    KZ_ROW(
        "sweep.measure", KZ_KEY_WORDS, NULL, KZ_ROW_AT(measure),
        "attractors: branches joined by continuation, with their ends; basin_fractions: their shares of the cells of "
        "basin, or "
        "of the starts; lifetime: mean settling time of long transients; "
        "release_angle: from rest; strobe: "
        "bifurcations.",
        .unit = "", .words_from = kz_sweep_measure_words,
        .former = "flutter_amplitude=attractors|flutter_zone=attractors"),
    KZ_ROW_THETA_WINDOW(sweep, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    KZ_ROW_VELOCITY_WINDOW(sweep, KZ_MOST_SPEED, "", "-2", "2",
                           "Velocities of the starts; a grid of basin has its own window."),
    KZ_ROW_INTEGER("sweep.starts", 1, 1e7, "2048", starts, "Starts of the search at each value."),
    KZ_ROW_INTEGER("sweep.max_period", 1, 512, "48", max_period, "Longest period of the search."),
    KZ_ROW_INTEGER("sweep.seed", 0, 9007199254740992.0, "1", seed,
                   "Number that chooses the starts; another seed gives other starts."),
    KZ_ROW_MAPPING("sweep.start", "", "Where both walks of strobe start."),
    KZ_ROW_REAL("sweep.start.theta", "rad", -1e6, 1e6, "3.1", start_theta, "Angle from down."),
    KZ_ROW_REAL("sweep.start.velocity", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, "0", start_velocity,
                "Velocity."),
    KZ_ROW_INTEGER("sweep.transient", 0, 1e7, "400", transient,
                   "Drive periods of strobe at each value before the record."),
    KZ_ROW_INTEGER("sweep.samples", 1, 1e5, "64", samples, "Strobe points of each walk at each value."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_sweep_check, .lack = kz_sweep_lack);
