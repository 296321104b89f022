/* The measure `ends`, a part of the study sweep: its row, and its keys. */
#define KEYS_OF ends

#include "ends.h"
#include "kapitza/study_key_rows.h"
#include "sweep/plan.h"

#define WORD_OF_PART "ends"
static const char *keys_words(void) {
  return WORD_OF_PART;
}

static const kz_key keys[] = {
    KZ_ROW("sweep.measure", KZ_KEY_WORDS, NULL, KZ_ROW_NOWHERE, "Over a plane: ends of the starts of sweep.ends.",
           .unit = "", .words_from = keys_words),
    KZ_ROW_MAPPING("sweep.ends", "",
                   "The measure ends: where the same starts end, at t = 0; each has a picture of its own."),
    KZ_ROW("sweep.ends.theta", KZ_KEY_REALS, NULL, KZ_ROW_AT(theta), "Angles from down.", .unit = "rad", .low = -1e6,
           .high = 1e6),
    KZ_ROW("sweep.ends.velocity", KZ_KEY_REALS, "[0]", KZ_ROW_AT(velocity),
           "Velocities: one for each angle, or one for all.", .unit = KZ_VELOCITY_UNIT, .low = -1e3, .high = 1e3),
    KZ_ROW_INTEGER("sweep.ends.max_period", 1, KZ_ENDS_MOST_PERIOD, "16", max_period,
                   "Longest period of a cycle that is recognised."),
    KZ_ROW_INTEGER(
        "sweep.ends.max_periods", 1, 1e8, "", max_periods,
        "Drive periods after which a motion counts as not settled; left out: the number that the damping needs, at "
        "least "
        "2000."),
    {.path = NULL},
};

static const kz_sweep_part part = {.words = WORD_OF_PART, .own_steps = true, .cost = kz_ends_cost, .run = kz_ends_run};

static bool is_named(const kz_scene *scene) {
  return kz_sweep_part_words(scene->sweep, &part, false).count > 0;
}

static const char *keys_lack(const kz_scene *scene) {
  const kz_ends_plan *plan = scene->ends;
  if (plan->theta.count > 0 && plan->velocity.count != 1 && plan->velocity.count != plan->theta.count)
    return "ends.velocity: has another number of values than theta; give one for each angle, or one for all";
  if (!is_named(scene)) return NULL;
  if (!kz_sweep_is_plane(scene->sweep))
    return "measure: ends is over a plane; give x and y instead of parameter, min, max and count";
  return plan->theta.count > 0 ? NULL : "ends: is missing, which the measure ends needs; give a mapping of theta";
}

static const char *keys_limit(const kz_scene *scene, kz_drive_need need) {
  return need == KZ_NEEDS_SINE && is_named(scene) ? KZ_ENDS_NEED_SINE : NULL;
}

KZ_PART_ROW("sweep", has_sweep, .of_sweep = &part, .lack = keys_lack, .limit = keys_limit);
