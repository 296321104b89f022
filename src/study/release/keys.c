/* The part `release` of the study basin: its row, and its keys. */
#define KEYS_OF release

#include "release.h"
#include "kapitza/study_key_rows.h"

static const kz_key keys[] = {
    KZ_ROW(
        "basin.start_phase", KZ_KEY_REAL, "", KZ_ROW_AT(start_phase),
        "Phase of the drive at which the cells are released; the strobe points of the file are at phase 0 as always.",
        .unit = "rad", .low = -1e6, .high = 1e6),
    KZ_ROW_INTEGER(
        "basin.phases", 2, 64, "", phases,
        "Phases of the drive, spread evenly from 0 on, at which every cell is released as well; the result has the "
        "share "
        "that ends alike at all of them."),
    {.path = NULL},
};

KZ_PART_ROW("basin", has_basin, .of_basin = &kz_release_part, .check = kz_release_check, .begin = kz_release_begin,
            .describe = kz_release_describe);
