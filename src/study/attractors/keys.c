/* The study `attractors`: its row, and the table of its keys. */
#define KEYS_OF attractors

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: the attractors of a window of starts, without a grid."),
    KZ_ROW_THETA_WINDOW(attractors, "Angles of the starts; left out: the whole circle [-pi, pi)."),
    KZ_ROW_VELOCITY_WINDOW(attractors, KZ_MOST_SPEED, NULL, NULL, NULL, "Velocities of the starts."),
    KZ_ROW_INTEGER("attractors.starts", 1, 1e8, "8192", starts, "Starts of the search."),
    KZ_ROW_INTEGER("attractors.max_period", 1, 512, "48", max_period, "Longest period of the search."),
    KZ_ROW_INTEGER("attractors.seed", 0, 9007199254740992.0, "1", seed,
                   "Number that chooses the starts; another seed gives other starts."),
    {.path = NULL},
};

static void window_of(const kz_scene *scene, const kz_axis *axis[2]) {
  axis[0] = &scene->attractors->theta, axis[1] = &scene->attractors->velocity;
}

KZ_STUDY_ROW(.check = kz_attractors_check, .follows = true, .window = window_of);
