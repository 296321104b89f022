/* study: the studies that a scene can contain, one folder each (C; layer 3). The scene comes as plain structs; results
 * go to the store and, for people, to a summary. */
#pragma once

#include "kapitza/analysis.h"
#include "kapitza/parallel.h"
#include "kapitza/powers.h"
#include "kapitza/study_axis.h"

/* The labels of the settings that a trade-off compares, joined by '|'. */
const char *kz_tradeoff_words(void);

/* The mapping `numerics` as written. */
typedef struct {
  int32_t scheme;           /* row of the kernel's table */
  int32_t steps_per_period; /* KZ_AUTO, or as given */
  double tolerance;         /* rad: the largest error of a drive period with KZ_AUTO and the processed splitting */
} kz_numerics_keys;
enum { KZ_AUTO = 0 };

/* Studies in the order in which they run, then those of the powers of this build (cmake/Powers.cmake). Everything else
 * about a study stands in its folder: plan.h has what a scene says of it, keys.c its keys and its row, variables.c what
 * it writes. */
#define KZ_STUDIES(STUDY) \
  STUDY(basin)            \
  STUDY(attractors)       \
  STUDY(orbit)            \
  STUDY(stability)        \
  STUDY(potential)        \
  STUDY(sweep)            \
  STUDY(tradeoff)         \
  KZ_POWER_STUDIES(STUDY)

#define KZ_STUDY_PLAN(name) typedef struct kz_##name##_plan kz_##name##_plan;
KZ_STUDIES(KZ_STUDY_PLAN)

typedef struct {
  char *title; /* may be "" */
  kz_parameters parameters;
  /* The numbers of a laboratory's pendulum that have no unit, with the units that they are taken in; "" = none. */
  char bare[400];
  kz_numerics_keys asked;
  kz_numerics numerics;   /* resolved from `asked` by kz_numerics_resolve */
  kz_kept_series *series; /* Splitting series of the pendulums, shared by copies; kz_scene_free frees it; NULL = none */
#define KZ_STUDY_FIELDS(name)                                \
  bool has_##name;        /* the scene asks for the study */ \
  kz_##name##_plan *name; /* never NULL in a scene of kz_plans_create */
  KZ_STUDIES(KZ_STUDY_FIELDS)
} kz_scene;

/* Steps a period of the study `orbit`: the scene's, or more for a fast motion; a multiple of the samples a period. */
enum { KZ_MOST_ORBIT_STEPS = 200000 };
double kz_orbit_steps(const kz_scene *scene);
/* Numerics of the study `orbit`: so many steps of the scene's scheme, or of split6 instead of the processed
 * splitting. */
kz_numerics kz_orbit_numerics(const kz_scene *scene);

/* Prints one line: whether the pendulum at rest is stable down and inverted (by the linear equation), and between which
 * amplitudes of the pivot, in the keys and units of the scene. Prints nothing without a pendulum. */
void kz_rest_print(const kz_parameters *parameters, FILE *out);
/* Range of the drive m of a sine in which a pendulum with gravity k > 0 stands upside down; NaN = none. */
void kz_standing_drives(const kz_pendulum *pendulum, double *low, double *high);

/* How far two pendulums are apart, of the size of their parameters; INFINITY where only one has mirror symmetry. */
double kz_pendulums_parted(const kz_pendulum *a, const kz_pendulum *b);

/* M r^2 of a pendulum in SI units, kg m2; true if its inertia is at least that, to rounding. */
double kz_point_inertia(const kz_pendulum_keys *written);
bool kz_inertia_is_possible(const kz_pendulum_keys *written);

/* Keys of the mapping `pendulum` that a sweep can change: those of motions, and those of powers that change
 * releases. */
typedef struct {
  const char *name, *unit;
  size_t offset; /* in kz_pendulum_keys, or in the plan */
  size_t plan;   /* offset in kz_scene of the pointer to the plan of a power; 0 = none */
} kz_sweep_parameter;
const kz_sweep_parameter *kz_sweep_parameter_at(int32_t parameter);
/* Names of keys that change motions (kz_sweep_words: of sweeps, with those of powers) and of measures, joined by
 * '|'. */
const char *kz_sweep_words(void);
const char *kz_motion_words(void);
const char *kz_sweep_measure_words(void);

/* Converts a unit of the drive to SI: *unit becomes "s" for "drive periods", "rad/s" for "rad per drive radian";
 * returns 1 and leaves *unit for other units and where omega (of the pivot, rad/s) is NaN. kz_periods_print: prints "50
 * drive periods (1 s)". kz_rate_print: prints a rate per drive period with its standard error, and per unit of the
 * scene's time: s, 1/omega0 where the scene has drive_frequency or omega, else drive radian. */
double kz_si_factor(double omega, const char **unit);
void kz_periods_print(int64_t periods, double omega, FILE *out);
void kz_rate_print(const kz_parameters *parameters, double tradeoff_rate, double error, FILE *out);

/* Returns a value along an axis in the unit that the scene writes; the name of this unit, "" of a pure number. */
double kz_axis_written(const kz_axis *values, double value);
const char *kz_axis_unit(const kz_axis *values, int32_t parameter);
/* Writes "amplitude = 8 mm", with that many digits, to text [bytes]. */
void kz_axis_print(const kz_axis *values, int32_t parameter, int digits, double value, char *text, size_t bytes);
/* Writes which key an axis is of, its unit, and the unit that the scene writes, as attributes of a group: `parameter`,
 * `parameter_units`, .., or with the name of the axis in front: `x_parameter`, `x_units`, .. */
kz_status kz_axis_describe(const kz_axis *values, int32_t parameter, const char *axis, const char *group,
                           kz_store *store);

/* Value i of an axis of values; both ends are exact. */
double kz_axis_value(const kz_axis *values, int64_t i);
double kz_sweep_value(const kz_sweep_plan *plan, int64_t i);

/* The scene's pendulum with n of its keys (numbers of kz_sweep_parameter_at) at other values; false if that is not
 * possible (not finite, negative damping, less inertia than a point mass). */
bool kz_pendulum_at(const kz_scene *scene, int n, const int32_t *parameter, const double *value, kz_pendulum *pendulum);

/* Pendulum of a scene with the swept parameter at `value`. */
bool kz_sweep_pendulum(const kz_scene *scene, double value, kz_pendulum *pendulum);
/* True if other values of a key than 0 make a drive that is not k - m cos t. */
bool kz_sweep_is_of_drive(int32_t parameter);

/* Estimated cost of a study. */
typedef struct {
  int64_t cells;
  double disk_bytes;   /* result file and checkpoint */
  double memory_bytes; /* on every rank */
  double rank0_bytes;  /* more on rank 0 */
  double shared_bytes; /* more on all ranks together */
} kz_cost;

typedef struct kz_basin_part kz_basin_part;
typedef struct kz_level kz_level;
typedef struct kz_sweep_part kz_sweep_part;
typedef struct kz_dynamics kz_dynamics;
/* A key of a scene (study_keys.h). */
typedef struct kz_key kz_key;

/* Studies of which a scene must have one beside a study, joined by '|', for what it lacks otherwise. */
typedef struct {
  const char *what, *studies;
} kz_study_need;

/* Requirements: a pivot that moves vertically as a sine; mirror symmetry; starts at a strobe of the final drive; starts
 * at one phase. */
typedef enum { KZ_NEEDS_SINE, KZ_NEEDS_MIRROR, KZ_NEEDS_STROBE, KZ_NEEDS_ONE_PHASE } kz_drive_need;

/* A study. All ranks call `run`; `summary` (text for people) and `store` are NULL on all ranks but rank 0. `check`
 * refuses a scene that the study cannot model, for example because the steps are too coarse (NULL = nothing to refuse);
 * its message begins with the keys that a user could change ("numerics.steps_per_period|basin.velocity: ..."). */
typedef struct {
  const char *name;
  size_t wanted, plan; /* offsets in kz_scene of has_NAME and of the pointer to the plan */
  size_t plan_bytes;
  const kz_key *keys; /* Keys of the study, the one of its mapping first; a key without path ends them */
  kz_cost (*cost)(const kz_scene *scene);
  kz_status (*run)(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
  kz_status (*check)(const kz_scene *scene);
  /* Complaint about the plan, "KEY: what is wrong", where KEY is one of the study; NULL = nothing, or no function. */
  const char *(*lack)(const kz_scene *scene);
  kz_study_need needs[2];
  /* It is a part of the study basin, whose run does its work (src/study/basin/label.h); NULL = it is not. */
  const kz_basin_part *of_basin;
  const kz_sweep_part *of_sweep; /* part for the study sweep (src/study/sweep/part.h) */
  /* Precision levels that it adds to the core's (src/study/labelling/levels.h), with their evidence. */
  const kz_level *levels;
  int32_t n_levels;
  /* Axes of its starts, theta and velocity, if the scene's own pendulum and numerics follow them; NULL = no starts. */
  void (*window)(const kz_scene *scene, const kz_axis *axis[2]);
  /* The complaint if the scene asks for what needs this of drive or starts; NULL = it does not, or no function. */
  const char *(*limit)(const kz_scene *scene, kz_drive_need need);
  /* Tells dynamics how cells begin for this pendulum instead of the scene's; swept: value of the sweep's key, or
   * NULL. */
  void (*begin)(const kz_scene *scene, const kz_pendulum *pendulum, const double *swept, kz_dynamics *dynamics);
  kz_status (*describe)(const kz_scene *scene, kz_store *store); /* adds attributes to a new file. Rank 0. */
  const kz_sweep_parameter *parameters; /* Parameters that a sweep may also take; a row without name ends them */
  bool damped;                          /* it has no meaning without damping */
  bool follows;                         /* it follows motions of the scene's own pendulum */
} kz_study;
static inline bool kz_study_is_wanted(const kz_study *study, const kz_scene *scene) {
  return *(const bool *)((const char *)scene + study->wanted);
}
/* True if the run of another study does its work. */
static inline bool kz_study_is_part(const kz_study *study) {
  return study->of_basin || study->of_sweep;
}
extern const kz_study *const kz_studies[];
extern const int kz_study_count;

/* Combines the answers of all studies of a scene (kz_study). */
void kz_studies_begin(const kz_scene *scene, const kz_pendulum *pendulum, const double *swept, kz_dynamics *dynamics);
kz_status kz_studies_describe(const kz_scene *scene, kz_store *store);

/* Gives a scene plans of its own, of zeros; copies of those that it shares with another; frees them. */
void kz_plans_create(kz_scene *scene);
void kz_plans_copy(kz_scene *scene);
void kz_plans_free(kz_scene *scene);

/* Declares what the folder of a study defines: its row, the row's functions (NAME_check if it has one), variables. */
#define KZ_STUDY_DECLARED(name)                                                                        \
  kz_cost kz_##name##_cost(const kz_scene *scene);                                                     \
  kz_status kz_##name##_check(const kz_scene *scene);                                                  \
  kz_status kz_##name##_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary); \
  extern const kz_study kz_##name##_study;                                                             \
  extern const kz_variable kz_##name##_variables[];
KZ_STUDIES(KZ_STUDY_DECLARED)
/* Variables and groups that a result file may hold, for kz_store_create. */
extern const kz_group kz_groups[];

/* FILE.truth, the reference labels of a window, begins with these words. */
#define KZ_REFERENCE_WORDS "kapitza truth"

/* The complaint of the first study of the scene that needs this; NULL = none does. */
const char *kz_drive_limit(const kz_scene *scene, kz_drive_need need);
/* KZ_REFUSED if the scene asks for what does not take its drive (src/study/drive_limits.c). */
kz_status kz_drive_check(const kz_scene *scene);
/* KZ_REFUSED with this complaint where the drive is not a sine, or a swept key makes another one. */
kz_status kz_drive_check_sine(const kz_scene *scene, const char *complaint);
/* KZ_REFUSED, with the message of the first study of the scene that does not pass its check. */
kz_status kz_studies_check(const kz_scene *scene);

/* Drive periods within which nearly all motions are trapped: at least 2000, and 2000 instead of above a million. */
int64_t kz_settling_periods(double beta);
/* The mean number of periods until a motion is trapped; beta > 0. */
double kz_settling_mean(double beta);

/* kz_settling_periods for the weakest damping in a scene, of its pendulum and its sweep. */
int64_t kz_settling_scene(const kz_scene *scene);

/* Prints a warning for each study whose max_periods leaves most motions unsettled; it names the key to change. */
void kz_settling_warn(const kz_scene *scene, FILE *out);

/* Sets scene->numerics from scene->asked, for the scene's pendulum, or for all values of its sweep. steps_per_period
 * auto means, for the processed splitting: the fewest steps whose measured error, at all speeds of the windows'
 * motions, is below the tolerance and small beside the cells; split6 if no number is enough. For other schemes: the
 * default, or more for cells of a damped basin below 0.01 rad. If no number is enough for these (the basin's check then
 * refuses the scene), or if basin.accuracy chooses, the default stays. */
void kz_numerics_resolve(kz_scene *scene);
