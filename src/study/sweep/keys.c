/* The study `sweep`: its row, and the table of its keys. */
#define KEYS_OF sweep

#include "kapitza/study_key_rows.h"
#include "plan.h"

/* An axis of a plane, whose mapping belongs to form c. */
#define PLANE_OF(axis, help)                                                                                     \
  ROW("sweep." #axis, KZ_KEY_MAPPING, NULL, NOWHERE, help, .unit = "", .form = "c", .range = KZ_RANGE_PARAMETER, \
      .range_offset = offsetof(kz_sweep_plan, axis)),                                                            \
      PLANE_KEYS(sweep, axis),                                                                                   \
      INTEGER("sweep." #axis ".count", 2, 1e5, NULL, axis.values.count, "Number of values, both ends included.")

static const kz_key keys[] = {
    STUDY("Study: quantities along one key of the pendulum mapping, at the values of a range (a) or a list (b), or "
          "over two "
          "keys (c).",
          .former = "chart=sweep.measure ends, with sweep.x, sweep.y and sweep.ends"),
    ROW("sweep.parameter", KZ_KEY_WORD, NULL, AT(parameter),
        "Key of the pendulum mapping, as written there, that takes the values; pendulum.KEY is the same.", .unit = "",
        .words_from = kz_sweep_words, .form = "ab"),
    ROW("sweep.min", KZ_KEY_REAL, NULL, AT(range.min), "First value.", .unit = KZ_OWN_UNIT, .low = -DBL_MAX,
        .high = DBL_MAX, .form = "a"),
    ROW("sweep.max", KZ_KEY_REAL, NULL, AT(range.max), "Last value.", .unit = KZ_OWN_UNIT, .low = -DBL_MAX,
        .high = DBL_MAX, .form = "a"),
    INTEGER("sweep.count", 2, 1e5, NULL, range.count, "Number of values, both ends included.", .form = "a"),
    ROW("sweep.values", KZ_KEY_REALS, NULL, AT(listed), "The values themselves, ascending, two or more.",
        .unit = KZ_OWN_UNIT, .low = -DBL_MAX, .high = DBL_MAX, .form = "b"),
    PLANE_OF(x, "Over a plane instead: the key along the horizontal axis."),
    PLANE_OF(y, "The key along the vertical axis."),
    ROW("sweep.measure", KZ_KEY_WORDS, NULL, AT(measure),
        "attractors: branches joined by continuation, with their ends; basin_fractions: their shares of the cells of "
        "basin, or "
        "of the starts; lifetime: mean settling time of long transients; "
        "release_angle: from rest; strobe: "
        "bifurcations.",
        .unit = "", .words_from = kz_sweep_measure_words,
        .former = "flutter_amplitude=attractors|flutter_zone=attractors"),
    THETA_WINDOW(sweep, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    VELOCITY_WINDOW(sweep, KZ_MOST_SPEED, "", "-2", "2",
                    "Velocities of the starts; a grid of basin has its own window."),
    INTEGER("sweep.starts", 1, 1e7, "2048", starts, "Starts of the search at each value."),
    INTEGER("sweep.max_period", 1, 512, "48", max_period, "Longest period of the search."),
    INTEGER("sweep.seed", 0, 9007199254740992.0, "1", seed,
            "Number that chooses the starts; another seed gives other starts."),
    MAPPING("sweep.start", "", "Where both walks of strobe start."),
    REAL("sweep.start.theta", "rad", -1e6, 1e6, "3.1", start_theta, "Angle from down."),
    REAL("sweep.start.velocity", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, "0", start_velocity, "Velocity."),
    INTEGER("sweep.transient", 0, 1e7, "400", transient, "Drive periods of strobe at each value before the record."),
    INTEGER("sweep.samples", 1, 1e5, "64", samples, "Strobe points of each walk at each value."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_sweep_check, .lack = kz_sweep_lack);
