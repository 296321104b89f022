/* The study `sweep`: its row, and the table of its keys. */
#define KEYS_OF sweep

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    STUDY("Study: quantities along one key of the pendulum mapping."),
    ROW("sweep.parameter", KZ_KEY_WORD, NULL, AT(parameter),
        "Key of the pendulum mapping, as written there, that takes the values.", .unit = "", .words_from = kz_sweep_words),
    REAL("sweep.min", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, values.min, "First value."),
    REAL("sweep.max", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, values.max, "Last value."),
    INTEGER("sweep.count", 2, 1e5, NULL, values.count, "Number of values, both ends included."),
    ROW("sweep.measure", KZ_KEY_WORDS, NULL, AT(measure),
        "attractors: branches joined by continuation, with their ends; basin_fractions: their shares of the cells of basin, or "
        "of the starts; lifetime: mean settling time of long transients; resilience: smallest shocks that leave the basins; "
        "phases: share of cells or starts that ends alike at all phases of release; flutter_amplitude: of the period-2 cycle "
        "about inverted; flutter_zone: how far it reaches when m is raised; release_angle: from rest; strobe: bifurcations.",
        .unit = "", .words_from = kz_sweep_measure_words),
    THETA_WINDOW(sweep, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    VELOCITY_WINDOW(sweep, KZ_MOST_SPEED, "", "-2", "2", "Velocities of the starts; a grid of basin has its own window."),
    INTEGER("sweep.starts", 1, 1e7, "2048", starts, "Starts of the search at each value."),
    INTEGER("sweep.max_period", 1, 512, "48", max_period, "Longest period of the search."),
    INTEGER("sweep.seed", 0, 9007199254740992.0, "1", seed, "Number that chooses the starts; another seed gives other starts."),
    MAPPING("sweep.start", "", "Where both walks of strobe start."),
    REAL("sweep.start.theta", "rad", -1e6, 1e6, "3.1", start_theta, "Angle from down."),
    REAL("sweep.start.velocity", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, "0", start_velocity, "Velocity."),
    INTEGER("sweep.transient", 0, 1e7, "400", transient, "Drive periods of strobe at each value before the record."),
    REAL("sweep.shock_scale", KZ_VELOCITY_UNIT, 1e-6, 1e6, "1", shock_scale,
         "Change of the velocity that counts as much as 1 rad in resilience."),
    INTEGER("sweep.phases", 2, 64, "8", phases, "Phases of release for the measure phases, evenly over a period."),
    INTEGER("sweep.samples", 1, 1e5, "64", samples, "Strobe points of each walk at each value."),
    {.path = NULL},
};

KZ_STUDY_ROW(kz_sweep_check);
