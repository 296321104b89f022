/* The study `atlas`: its row, and the table of its keys. */
#define KEYS_OF atlas

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY(
        "Study: curves on which cycles are born, lose their stability or their symmetry, over a plane of two keys of "
        "the "
        "pendulum mapping, the attractors of every point of it, and an estimate of how many curves are missing."),
    KZ_ROW_PLANE_AXIS(atlas, x, "The key along the horizontal axis."),
    KZ_ROW_PLANE_AXIS(atlas, y, "The key along the vertical axis."),
    KZ_ROW_INTEGER("atlas.max_period", 1, KZ_ATLAS_MOST_PERIOD, "6", max_period,
                   "Longest period of the cycles, drive periods."),
    KZ_ROW_INTEGER(
        "atlas.checks", 0, 1e5, "100", checks,
        "Random points of a round whose attractors are compared with the lists, after a search of cycles at 20 further "
        "places. Two rounds in a row that find nothing end the search, 16 at most; 0: no rounds."),
    KZ_ROW_INTEGER(
        "atlas.seeds", 2, 1000, "40", seeds,
        "Places whose cycles, attracting or not, are searched first: each is followed to the curve on which it is "
        "born or "
        "loses its stability or symmetry."),
    KZ_ROW_INTEGER("atlas.points", 16, 4000, "400", points,
                   "Cells along each axis for the number and the lists of attractors."),
    KZ_ROW_INTEGER(
        "atlas.shares", 0, 1e6, "0", shares,
        "Starts at one point of each of the largest regions, whose ends give the shares of the basins there; 0 = "
        "none."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_atlas_check);
