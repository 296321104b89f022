/* The mapping pendulum.ramp, a part of the study basin: its row, and its keys. */
#define KEYS_OF ramp

#include "release.h"
#include "kapitza/study_key_rows.h"

#define WORDS_OF_PART "ramp.periods|ramp.from"
static const char *ramp_words(void) {
  return WORDS_OF_PART;
}

static const kz_key keys[] = {
    KZ_ROW("pendulum.ramp", KZ_KEY_MAPPING, "", KZ_ROW_OF_SCENE(has_ramp),
           "Damping or drive has the value `from` when a cell of a basin is released, and the pendulum's own after "
           "`periods`.",
           .unit = ""),
    KZ_ROW_WORD("pendulum.ramp.key", "damping|drive_amplitude", NULL, key,
                "The quantity that changes: beta, or all of the drive in proportion."),
    KZ_ROW_REAL("pendulum.ramp.from", "", -1e6, 1e6, NULL, from, "beta or m at the beginning, t = 0."),
    KZ_ROW_REAL("pendulum.ramp.periods", "", 0, 1e5, NULL, periods, "Number of drive periods that the change takes."),
    KZ_ROW_WORD("pendulum.ramp.shape", "linear|smooth", "linear", shape,
                "linear in time; smooth: 3 s^2 - 2 s^3, which begins and ends without a kink."),
    KZ_ROW("sweep.parameter", KZ_KEY_WORD, NULL, KZ_ROW_NOWHERE, "Of a ramp: its length and its beginning.", .unit = "",
           .words_from = ramp_words),
    {.path = NULL},
};

#define SWEPT(field) {"ramp." #field, "1", .plan = offsetof(kz_scene, ramp), .offset = offsetof(kz_ramp_plan, field)}
static const kz_sweep_parameter swept[] = {SWEPT(periods), SWEPT(from), {.name = NULL}};

static const kz_basin_part part = {0};
KZ_PART_ROW("basin", has_ramp, .of_basin = &part, .check = kz_ramp_check, .describe = kz_ramp_describe,
            .parameters = swept);
