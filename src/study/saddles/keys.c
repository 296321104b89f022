/* The study `saddles`: its row, and the table of its keys. */
#define KEYS_OF saddles

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: all unstable cycles of the strobe map up to a period, and a test whether any is missing.",
                 .former = "manifolds=kapitza.manifolds(...) in Python|wada=kapitza.wada(...) in Python|"
                           "tangency=kapitza.tangency(...) in Python"),
    KZ_ROW_THETA_WINDOW(saddles, "Angles of the cycles' points; left out: the whole circle [-pi, pi)."),
    KZ_ROW_VELOCITY_WINDOW(saddles, 1e3, NULL, NULL, NULL, "Velocities of the cycles' points."),
    KZ_ROW_INTEGER("saddles.max_period", 1, KZ_SADDLES_MAX_PERIOD, "1", max_period,
                   "Longest period, in drive periods; their number and the time grow exponentially with it."),
    {.path = NULL},
};

KZ_STUDY_ROW(.follows = true);
