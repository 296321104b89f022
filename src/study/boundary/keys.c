/* The part `boundary` of the study basin: its row, and its keys. */
#define KEYS_OF boundary

#include "boundary.h"
#include "kapitza/study_key_rows.h"

static const kz_key keys[] = {
    KZ_ROW(
        "basin.boundary", KZ_KEY_MAPPING, "", KZ_ROW_OF_SCENE(has_boundary),
        "How fractal the boundaries are: uncertainty exponents decade by decade, box-counting dimension, basins that "
        "share "
        "their boundary.",
        .unit = ""),
    KZ_ROW_INTEGER("basin.boundary.pairs", 100, 1e8, "50000", pairs,
                   "Starts of the window, each with a partner at `farthest`, a tenth of that, ... rad."),
    KZ_ROW_REAL("basin.boundary.farthest", "rad", 1e-300, 1, "0.01", farthest,
                "Distance of the first partner. With method exact it may be any share of the width of a deep window."),
    KZ_ROW_INTEGER(
        "basin.boundary.decades", KZ_BOUNDARY_FEWEST_DECADES, KZ_BOUNDARY_MOST_DECADES, "10", decades,
        "Decades of these distances: 10 go from 0.01 down to 1e-12 rad; nearer partners need basin.method exact."),
    {.path = NULL},
};

static const char *keys_limit(const kz_scene *scene, kz_drive_need need) {
  (void)scene;
  return need == KZ_NEEDS_STROBE ? "basin.boundary needs starts at phase 0 and no ramp; leave one of them out" : NULL;
}

KZ_PART_ROW("basin", has_boundary, .check = kz_boundary_check, .of_basin = &kz_boundary_part, .limit = keys_limit);
