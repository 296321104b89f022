/* The part `deep` of the study basin: its row, and its keys. */
#define KEYS_OF deep

#include "deep.h"
#include "kapitza/study_key_rows.h"
#include "plan.h"

/* A key of the window, which is the basin's. */
#define OF_BASIN(path_, unit_, low_, high_, field, help_) \
  {.path = path_,                                         \
   .type = KZ_KEY_DECIMAL,                                \
   .fallback = "",                                        \
   .plan = offsetof(kz_scene, basin),                     \
   .offset = offsetof(kz_basin_plan, field),              \
   .help = help_,                                         \
   .unit = unit_,                                         \
   .low = low_,                                           \
   .high = high_,                                         \
   .form = "b"}

static const kz_key keys[] = {
    OF_BASIN("basin.theta.centre", "rad", -1e6, 1e6, theta.centre, KZ_ROW_CENTRE_HELP),
    OF_BASIN("basin.theta.width", "rad", 1e-300, 7, theta.width, "Width of the window."),
    OF_BASIN("basin.velocity.centre", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, velocity.centre,
             KZ_ROW_CENTRE_HELP),
    OF_BASIN("basin.velocity.width", KZ_VELOCITY_UNIT, 1e-300, 2e9, velocity.width, "Width of the window."),
    KZ_ROW_WORD(
        "basin.undecided", "flag|decide", "flag", undecided,
        "Cells that quad precision does not decide, by method exact. flag: flagged with two candidates; decide: "
        "followed in "
        "as many digits as needed, some 0.1 to 0.4 s a cell."),
    {.path = NULL},
};

static const char *keys_lack(const kz_scene *scene) {
  const bool exact = scene->basin->method == KZ_METHOD_EXACT && isnan(scene->basin->accuracy);
  if (scene->deep->undecided == KZ_UNDECIDED_FLAG || exact) return NULL;
  return "undecided: decide needs basin.method: exact; choose that method, or flag";
}

static const char *keys_limit(const kz_scene *scene, kz_drive_need need) {
  if (need != KZ_NEEDS_ONE_PHASE) return NULL;
  if (scene->deep->undecided == KZ_UNDECIDED_DECIDE)
    return "basin.undecided decide needs starts at one phase; choose flag";
  if (!scene->basin->theta.centre.text[0] && !scene->basin->velocity.centre.text[0]) return NULL;
  return "a window by centre and width needs starts at one phase; give min and max";
}

KZ_PART_ROW("basin", has_basin, .of_basin = &kz_deep_part, .lack = keys_lack, .limit = keys_limit,
            .levels = &kz_own_orbit_level, .n_levels = 1);
