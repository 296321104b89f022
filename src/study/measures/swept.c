/* Measures of a sweep: smallest shocks of the branches, and those of the table at single points. */
#define KEYS_OF swept

#include "option_keys.h"
#include "points.h"

#define BARRED(word, ...) "|" #word
static const char WORDS_OF_PART[] = "resilience" KZ_MEASURES(BARRED, BARRED, BARRED, BARRED, BARRED);
static const char *swept_words(void) {
  return WORDS_OF_PART;
}

static const kz_key keys[] = {
    KZ_ROW(
        "sweep.measure", KZ_KEY_WORDS, NULL, KZ_ROW_NOWHERE,
        "Along one key also resilience: smallest shocks that leave the basins. Along one and over a plane: the words "
        "of "
        "measures.names.",
        .unit = "", .words_from = swept_words),
    MEASURE_OPTIONS(sweep, "64"),
    {.path = NULL},
};

/* Smallest shocks over an attractor's strobe points. Catalogues of a sweep and a file have one order. */
static kz_status find_shocks(const kz_scene *scene, const kz_sweep_value_at *at, kz_sweep_catalogue *catalogue) {
  const kz_resilience_plan plan = {.scale = scene->swept->options.shock_scale,
                                   .farthest = 2 * kz_axis_fastest(at->velocity),
                                   .max_periods = at->max_periods};
  KZ_AUTOFREE_BY(kz_catalogue_free) kz_catalogue listed = {0};
  int64_t n;
  kz_catalogue_make(at->dynamics, at->hits, &listed);
  KZ_AUTOFREE kz_resilience *point = kz_resilience_list(at->dynamics, &listed, &n);
  KZ_TRY(kz_resilience_run(at->run, at->dynamics, &plan, n, point));
  for (int64_t i = 0; i < n; i++)
    for (int kind = 0; kind < 3; kind++) {
      double *least = &catalogue->entries[listed.id_of[point[i].number]].number[kind];
      *least = fmin(*least, point[i].shock[kind].size); /* fmin of a number and NaN is the number */
    }
  return KZ_OK;
}

static kz_integers names_of(const kz_sweep_plan *plan);

static kz_cost swept_cost(const kz_scene *scene) {
  const kz_integers names = names_of(scene->sweep);
  const kz_points points = kz_points_of(scene, &names);
  return kz_points_cost(&points);
}

static kz_status run_points(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_integers names = names_of(scene->sweep);
  const kz_points points = kz_points_of(scene, &names);
  return kz_points_run(&points, run, store, summary);
}

static const char *const SHOCKS[] = {"shock_angle", "shock_kick", "shock_size", NULL};
static const kz_sweep_part part = {.words = WORDS_OF_PART,
                                   .of_branches = 1,
                                   .numbers = SHOCKS,
                                   .value = find_shocks,
                                   .cost = swept_cost,
                                   .run = run_points};

/* The rows of kz_measures that a sweep names. */
static kz_integers names_of(const kz_sweep_plan *plan) {
  kz_integers names = kz_sweep_part_words(plan, &part, false);
  for (int64_t i = 0; i < names.count; i++) names.values[i] -= part.of_branches;
  return names;
}

static const char *swept_lack(const kz_scene *scene) {
  const kz_measure_options *options = &scene->swept->options;
  const kz_integers names = names_of(scene->sweep);
  for (int64_t i = 0; i < names.count; i++) {
    const kz_measure *measure = kz_measures + names.values[i];
    if (measure->shape == KZ_PER_PAIR) return "measure: intermingled_with is for one pendulum; name intermingledness";
    if (measure->shape == KZ_PER_SIZE && options->sizes.count != 1)
      return "sizes: a sweep takes one size for harmless; leave the others out";
  }
  return kz_measures_lack(&names, options);
}

KZ_PART_ROW("sweep", has_sweep, .of_sweep = &part, .lack = swept_lack);
