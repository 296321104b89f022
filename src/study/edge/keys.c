/* The study `edge`: its row, and the table of its keys. */
#define KEYS_OF edge

#include "kapitza/study_key_rows.h"
#include "plan.h"

#define EDGE_START(place, help)                                                                                             \
  MAPPING("edge." #place, NULL, help), REAL("edge." #place ".theta", "rad", -1e6, 1e6, NULL, place[0], "Angle from down."), \
      REAL("edge." #place ".velocity", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, NULL, place[1], "Velocity.")

static const kz_key keys[] = {
    STUDY("Study: the saddle on the edge between the basins of two starts, by edge tracking."),
    EDGE_START(first, "A start; the edge of its basin is followed."),
    EDGE_START(second, "A start that ends elsewhere."),
    INTEGER("edge.periods", 1, 1e6, "2000", periods, "Largest number of drive periods for which the edge is followed."),
    INTEGER("edge.max_period", 1, KZ_EDGE_MOST_PERIOD, "16", max_period, "Longest period of a cycle that is recognised."),
    {.path = NULL},
};

KZ_STUDY_ROW(.damped = true, .needs = {{"a list of attractors", "basin|attractors"}});
