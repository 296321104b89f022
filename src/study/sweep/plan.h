/* Plan of the study `sweep`. */
#pragma once

#include "kapitza/study.h"

/* The measures of a sweep: code, word in the scene, the function that runs it. The first three come from the branches
 * and have no functions of their own; all go along one key. Further words are those of parts (kz_sweep_part). */
#define KZ_SWEEP_MEASURES(MEASURE)                                   \
  MEASURE(KZ_SWEEP_ATTRACTORS, "attractors", NULL)                   \
  MEASURE(KZ_SWEEP_BASIN_FRACTIONS, "basin_fractions", NULL)         \
  MEASURE(KZ_SWEEP_LIFETIME, "lifetime", NULL)                       \
  MEASURE(KZ_SWEEP_RELEASE_ANGLE, "release_angle", kz_sweep_release) \
  MEASURE(KZ_SWEEP_STROBE, "strobe", kz_sweep_strobe)
#define KZ_MEASURE_CODE(code, word, run) code,
enum { KZ_SWEEP_MEASURES(KZ_MEASURE_CODE) KZ_SWEEP_OWN /* number of them: words of parts follow */ };

struct kz_sweep_plan {
  int32_t parameter;       /* number of kz_sweep_parameter_at; KZ_UNSET_WORD = over a plane */
  kz_axis range;           /* as the scene gives it, or `listed`; NaN = not given */
  kz_reals listed;         /* ascending */
  kz_axis values;          /* the range, or the ends and the number of the list: kz_sweep_value has each */
  kz_plane_axis x, y;      /* axes of a plane */
  kz_integers measure;     /* indices in the list of kz_sweep_measure_words() */
  kz_axis theta, velocity; /* window of starts; the counts of the axes are not used */
  int64_t starts, max_period, seed;
  double start_theta, start_velocity; /* start of the bifurcation diagram */
  int64_t transient, samples;         /* drive periods at each value: before the record, and recorded */
};

/* Whether a list has something twice. */
bool kz_words_repeat(const kz_integers *alike_words);
/* A part of the study sweep that another folder adds: the row of kz_studies with `of_sweep`. */
typedef struct kz_sweep_catalogue kz_sweep_catalogue;
typedef struct kz_sweep_value_at kz_sweep_value_at;
struct kz_sweep_part {
  /* Words of sweep.measure that it adds, joined by '|', as its row of that key has them too. The first `of_branches`
   * are of the branches, all others of single points. */
  const char *words;
  int64_t of_branches;
  /* Variables over value and branch, and over value, of `value`: at most KZ_SWEEP_NUMBERS, then NULL; NULL = none. */
  const char *const *numbers, *const *of_values;
  bool on_grid;                            /* with the study basin it follows its cells, else the starts of the sweep */
  int64_t (*times)(const kz_scene *scene); /* how often it follows them; NULL = it does not */
  /* Fills numbers of the entries of a value, and of the value, if a word of the branches is named. Collective. */
  kz_status (*value)(const kz_scene *scene, const kz_sweep_value_at *at, kz_sweep_catalogue *catalogue);
  bool own_steps; /* points have numerics of their own, not the scene's */
  /* Cost of single points, and of all. Collective. */
  kz_cost (*cost)(const kz_scene *scene);
  kz_status (*run)(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
};

/* Whether it measures what is a word of its own. */
bool kz_sweep_measures(const kz_sweep_plan *plan, int64_t measure);
/* The words of a part that the sweep names, by their places in its list; those of the branches, or of points. */
kz_integers kz_sweep_part_words(const kz_sweep_plan *plan, const kz_sweep_part *part, bool of_branches);
/* The next part of which the sweep names such words, from number *i of kz_studies on; NULL = none. */
const kz_sweep_part *kz_sweep_part_next(const kz_sweep_plan *plan, bool of_branches, int *i);
/* Whether it names measures of single points that take the numerics of the scene. */
bool kz_sweep_has_points(const kz_sweep_plan *plan);
/* NULL, or what is wrong with the measures of a sweep, as "KEY: what is wrong" where KEY is a key of it. */
const char *kz_sweep_lack(const kz_scene *scene);

static inline bool kz_sweep_is_plane(const kz_sweep_plan *plan) {
  return plan->x.parameter >= 0 && plan->parameter < 0;
}
