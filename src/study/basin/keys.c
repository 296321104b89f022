/* The study `basin`: its row, and the table of its keys. */
#define KEYS_OF basin

#include "kapitza/study_key_rows.h"
#include "kapitza/study_basin.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: the attractors, then a label for every cell of a window.",
                 .former = "flag_undecided=basin.method exact"),
    KZ_ROW_MAPPING(
        "basin.theta", "",
        "Angles of the cells; min and max, or centre and width, at most 2 pi; neither: the whole circle [-pi, pi)."),
    KZ_ROW_EDGE("basin.theta.min", "rad", 1e6, "", theta_edges.min, "Lower edge of the window."),
    KZ_ROW_EDGE("basin.theta.max", "rad", 1e6, "", theta_edges.max, "Upper edge of the window."),
    KZ_ROW_INTEGER("basin.theta.count", 1, 1e6, "1000", theta.count, "Cells along theta."),
    KZ_ROW_MAPPING("basin.velocity", NULL, "Velocities of the cells."),
    KZ_ROW_EDGE("basin.velocity.min", KZ_VELOCITY_UNIT, KZ_MOST_SPEED, NULL, velocity_edges.min,
                "Lower edge of the window."),
    KZ_ROW_EDGE("basin.velocity.max", KZ_VELOCITY_UNIT, KZ_MOST_SPEED, NULL, velocity_edges.max,
                "Upper edge of the window."),
    KZ_ROW_INTEGER("basin.velocity.count", 1, 1e6, "1000", velocity.count, "Cells along the velocity."),
    KZ_ROW_WORD(
        "basin.method", KZ_JOIN_WORDS(KZ_METHOD_WORDS), "exact", method,
        "exact: every label is decided, in more precision if needed, or flagged in evidence; direct: double precision "
        "alone, "
        "doubtful labels are marked; icm: interpolated cell mapping, as in the papers. A sweep uses direct.",
        .former = "hybrid=direct", KZ_ROW_CHOSEN),
    KZ_ROW_MAPPING("basin.icm", "", "The map table of method icm."),
    KZ_ROW_INTEGER("basin.icm.theta", 8, 1e5, "1000", table_theta, "Nodes along theta.", KZ_ROW_CHOSEN),
    KZ_ROW_INTEGER("basin.icm.velocity", 8, 1e5, "1000", table_velocity, "Nodes along the velocity.", KZ_ROW_CHOSEN),
    KZ_ROW("basin.icm.interpolation", KZ_KEY_WORD, "quintic", KZ_ROW_AT(interpolation),
           "Interpolation between the nodes.", .unit = "", .words = KZ_JOIN_WORDS(KZ_INTERPOLATION_WORDS),
           .former = "cubic=quintic", KZ_ROW_CHOSEN),
    KZ_ROW_INTEGER(
        "basin.max_periods", 1, 4e9, "", max_periods,
        "Drive periods after which a cell counts as not settled; left out: the number that the damping needs, at "
        "least 2000."),
    KZ_ROW_MAPPING("basin.attractors", "", "The search for attractors before the cells are labelled."),
    KZ_ROW_INTEGER("basin.attractors.starts", 1, 1e8, "8192", starts, "Starts of the first round."),
    KZ_ROW_INTEGER("basin.attractors.max_period", 1, 512, "48", max_period, "Longest period of the search."),
    KZ_ROW_INTEGER("basin.attractors.seed", 0, 9007199254740992.0, "1", seed,
                   "Number that chooses the starts; another seed gives other starts."),
    KZ_ROW_BOOLEAN("basin.turns", "false", turns,
                   "Count the net turns of each cell until an oscillation on which it ends: variable `turns`."),
    KZ_ROW_REAL(
        "basin.accuracy", "", 0.5, 0.999999, "", accuracy,
        "Share of right labels, instead of method, icm and numerics: the cheapest setting that reaches it (95 % "
        "bound) is "
        "taken."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_basin_check, .follows = true);
