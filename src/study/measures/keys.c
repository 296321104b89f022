/* The study `measures`: its row, and the table of its keys. */
#define KEYS_OF measures

#include "measures.h"
#include "option_keys.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: numbers about each attractor and its basin; docs/explanation/measures.md defines them."),
    KZ_ROW_WORDS("measures.names", kz_measure_words, NULL, names, "The measures; what is not named is not computed."),
    KZ_ROW_THETA_WINDOW(measures, "Angles of the starts and of the picture; left out: the whole circle [-pi, pi)."),
    KZ_ROW_VELOCITY_WINDOW(measures, KZ_MOST_SPEED, NULL, NULL, NULL, "Velocities of the starts and of the picture."),
    KZ_ROW_INTEGER("measures.starts", 1, 1e7, "4096", starts,
                   "Starts that are spread evenly over the window, or over the weight."),
    KZ_ROW_INTEGER("measures.max_period", 1, 512, "48", max_period, "Longest period of the search for attractors."),
    KZ_ROW_INTEGER("measures.seed", 0, 9007199254740992.0, "1", seed,
                   "Number that chooses the starts; another seed gives other starts."),
    KZ_ROW_WORD(
        "measures.method", "exact|direct", "exact", method,
        "exact: every label is decided, in as many digits as it needs; direct: double precision alone, for motions "
        "that stay "
        "chaotic for long."),
    MEASURE_OPTIONS(measures, "256"),
    {.path = NULL},
};

static void window_of(const kz_scene *scene, const kz_axis *axis[2]) {
  axis[0] = &scene->measures->theta, axis[1] = &scene->measures->velocity;
}

static const char *keys_lack(const kz_scene *scene) {
  return kz_measures_lack(&scene->measures->names, &scene->measures->options);
}

KZ_STUDY_ROW(.check = kz_measures_check, .follows = true, .lack = keys_lack, .window = window_of);
