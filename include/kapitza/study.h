/* study: what a scene can ask for, one folder per study (C; layer 3). The scene arrives as plain structs; the results go to
 * the store and, for people, to a summary. */
#ifndef KAPITZA_STUDY_H
#define KAPITZA_STUDY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "kapitza/analysis.h"
#include "kapitza/kernel.h"
#include "kapitza/parallel.h"
#include "kapitza/store.h"

/* A number of any digits: its text (radians, or degrees with " deg" behind), and the sum of two doubles nearest to it; "" = not given. */
enum { KZ_DECIMAL_LENGTH = 1024 };
typedef struct {
  char text[KZ_DECIMAL_LENGTH];
  double high, low;
} kz_decimal;

/* An axis of cells or of values: n cells between min and max (basin), or n values with both ends (charts, sweeps). A window may be given
 * by its centre and width, finer than doubles are; min and max are then the nearest doubles. */
typedef struct {
  double min, max;
  int64_t count;
  kz_decimal centre, width;
} kz_axis;

/* Whether the cells of an axis are too narrow for doubles to tell apart: only method exact labels them. */
bool kz_axis_is_deep(const kz_axis *axis);
/* The number of a decimal text, maybe with " deg" behind it; 0 where it is none. */
__float128 kz_decimal_quad(const char *text);
/* The same number in all digits; its text is the decimal's. */
kz_coordinate kz_decimal_coordinate(const kz_decimal *decimal);

/* The edges of a window as written; NaN = not given. */
typedef struct {
  double min, max;
} kz_edges;

enum { KZ_METHOD_ICM = 0, KZ_METHOD_DIRECT = 1, KZ_METHOD_EXACT = 2 };
enum { KZ_UNDECIDED_FLAG = 0, KZ_UNDECIDED_DECIDE = 1 }; /* cells that quad precision leaves open */
enum { KZ_LINEAR = 0, KZ_QUINTIC = 1 };

/* A list of a scene. */
enum { KZ_LIST_MAX = 256 };
typedef struct {
  int64_t count;
  double values[KZ_LIST_MAX];
} kz_reals;
typedef struct {
  int64_t count;
  int64_t values[KZ_LIST_MAX];
} kz_integers;

enum { KZ_BOUNDARY_DECADES = 10, KZ_BOUNDARY_MOST_DECADES = 23 };
enum { KZ_MOST_SHOCK_SIZES = 16 };
/* Smallest shocks that leave a basin. The size of one is hypot(dtheta, dv / scale). */
typedef struct {
  double scale; /* rad per drive radian that count as much as 1 rad */
  kz_reals sizes;
} kz_shocks_plan;

typedef struct {
  kz_axis theta;    /* rad; the whole circle is [-pi, pi) */
  kz_axis velocity; /* rad per drive radian */
  kz_edges theta_edges, velocity_edges;
  int32_t method, undecided;
  int64_t table_theta, table_velocity; /* nodes of the map table */
  bool table_is_idle;                  /* the scene gives a map table that its method does not use */
  int32_t interpolation;
  int64_t max_periods;
  int64_t starts;
  int64_t max_period;
  int64_t seed;
  bool proof;      /* prove trapping regions of the true flow */
  bool unmirrored; /* the pendulum has no mirror symmetry */
  double accuracy; /* NaN, or the share of right labels for which the program chooses method, table and numerics */
  bool has_boundary;
  struct {
    int64_t pairs;   /* starts, each with a partner at every distance */
    int64_t decades; /* of distances, from 1e-2 rad down; more than KZ_BOUNDARY_DECADES with method exact alone */
  } boundary;
  bool has_shocks;
  kz_shocks_plan shocks;
  int64_t phases; /* of the drive at which the cells are released besides; not above 0: none */
} kz_basin_plan;

/* Study `attractors`: the counts of the axes are not used. */
typedef struct {
  kz_axis theta, velocity;
  int64_t starts, max_period, seed;
} kz_attractors_plan;

/* Study `saddles`: all cycles up to a period with a point in the window; the counts of the axes are not used. */
enum { KZ_SADDLES_MAX_PERIOD = 32, KZ_SADDLES_MOST = 200000 /* cycles */ };
typedef struct {
  kz_axis theta, velocity;
  int64_t max_period;
} kz_saddles_plan;

/* Study `manifolds`: of the saddles of the study before. */
enum { KZ_MANIFOLDS_BOTH, KZ_MANIFOLDS_STABLE, KZ_MANIFOLDS_UNSTABLE };
typedef struct {
  kz_integers saddles; /* ids; none = all */
  int32_t kind;
  double length, spacing, max_speed;
} kz_manifolds_plan;

/* Study `edge`: of the basins of two starts. */
typedef struct {
  double first[2], second[2]; /* rad, rad per drive radian */
  int64_t periods;            /* drive periods that the edge is followed at most */
  int64_t max_period;         /* longest cycle that is told */
} kz_edge_plan;
enum { KZ_EDGE_MOST_PERIOD = 64 };

/* Study `orbit`. Unset: NaN (start), INT64_MIN (attractor, periods, period). */
typedef struct {
  double theta, velocity; /* start */
  int64_t attractor;      /* id in the catalogue of the same scene, instead of a start */
  int32_t model;          /* KZ_PENDULUM, KZ_MATHIEU, KZ_EFFECTIVE */
  int32_t about;          /* of the linear model: 0 down, 1 inverted */
  int64_t transient;      /* drive periods before the record */
  int64_t periods;        /* of the record */
  int64_t samples_per_period;
  bool closed;
  int64_t period; /* of a closed orbit; unset = found */
} kz_orbit_plan;

/* Study `stability`; damping and quality factor NaN = not given, curves: places among kz_curve_names(). */
typedef struct {
  kz_axis k, m; /* values with both ends */
  double damping, quality_factor;
  kz_integers curves, subharmonics;
} kz_stability_plan;

/* Study `potential`. */
typedef struct {
  kz_reals drive_amplitudes;
  int64_t theta_count;
} kz_potential_plan;

/* Study `tradeoff`: on the window of the basin. */
typedef struct {
  int64_t samples;      /* cells compared with quad precision */
  kz_integers settings; /* indices in the table of settings; none = all */
} kz_tradeoff_plan;

/* The labels of the settings that a trade-off compares, joined by '|'. */
const char *kz_tradeoff_words(void);

/* Study `sweep`. */
typedef struct {
  int32_t parameter;       /* row of kz_sweep_parameters */
  kz_axis values;          /* both ends included */
  kz_integers measure;     /* places among kz_sweep_measure_words() */
  kz_axis theta, velocity; /* window of starts; the counts of the axes are not used */
  int64_t starts, max_period, seed;
  double start_theta, start_velocity; /* of the bifurcation diagram */
  int64_t transient, samples;         /* drive periods at each value before the record, and of it */
  double shock_scale;                 /* of resilience, as kz_shocks_plan has it */
} kz_sweep_plan;

/* Study `chart`: ends of the same starts over a plane of two keys of the pendulum mapping. */
enum { KZ_CHART_MOST_PERIOD = 64 };
typedef struct {
  int32_t parameter; /* row of kz_sweep_parameters */
  kz_axis values;    /* both ends included */
} kz_chart_axis;
typedef struct {
  kz_chart_axis x, y;
  kz_reals theta, velocity;        /* starts: rad, rad per drive radian; one velocity serves all angles */
  int64_t max_period, max_periods; /* max_periods unset: INT64_MIN */
} kz_chart_plan;

/* What a ramp changes, and how. */
enum { KZ_RAMP_DAMPING = 0, KZ_RAMP_DRIVE = 1 };
enum { KZ_RAMP_LINEAR = 0, KZ_RAMP_SMOOTH = 1 };

/* The pendulum mapping as written, in one of three forms; NaN = key not given. */
typedef struct {
  double quality_factor, drive_frequency, drive_amplitude;                           /* a: Q, Omega, epsilon */
  double k, damping, m;                                                              /* b: k, beta, m */
  double mass, radius, inertia, friction, gravity, pivot_amplitude, pivot_frequency; /* c: SI, BSG Eq. (1) */
  double length;                                  /* c: m, of a point mass, instead of radius and inertia */
  double frequency;                               /* c: Hz, instead of pivot_frequency */
  double amplitude;                               /* c: m, instead of pivot_amplitude */
  double decay_time;                              /* c: s, 2 I/b, instead of friction or quality_factor */
  double tilt, ellipse, torque, torque_amplitude; /* rad; short over long axis; in units of I omega^2; of a torque cos t */
  double start_phase;                             /* of the scene's basin: rad, of the drive when the pendulum is released */
  double ramp_from, ramp_periods;                 /* in the units of its key; drive periods */
  int32_t ramp_key, ramp_shape;                   /* KZ_RAMP_DAMPING, ..; KZ_RAMP_LINEAR, .. */
  int32_t waveform;                               /* KZ_SINE, ... */
  kz_reals samples;                               /* of KZ_SAMPLES: at equal times of a period, in units of m */
  kz_harmonics harmonics;                         /* further ones */
} kz_pendulum_keys;

/* The three forms all end in `pendulum`; the others are NaN where not defined (Q without damping, Omega at k <= 0). */
typedef struct {
  kz_pendulum_keys written;
  kz_pendulum pendulum;
  bool has_ramp;
  double quality_factor, drive_frequency, drive_amplitude;
  double pivot_frequency; /* rad s-1; NaN without SI */
  kz_release release;     /* how motions of a basin begin */
} kz_parameters;

/* m s-2; CGPM 1901. */
#define KZ_STANDARD_GRAVITY 9.80665

/* Fills everything but `written` from `written`. KZ_REFUSED where k, beta or m is not finite; then nothing is usable. */
kz_status kz_parameters_resolve(kz_parameters *parameters);

/* The stiffest pendulum and the fastest start whose motions are followed: kz_stiffness; rad per drive radian. Beyond them one drive period
 * takes more than 300,000 steps, or 10,000 turns. */
#define KZ_MOST_STIFFNESS 1e7
#define KZ_MOST_SPEED 1e4

/* The drive that the keys describe beyond k, beta and m, which `pendulum` has: the rest of it. And how motions begin. */
void kz_drive_resolve(const kz_parameters *parameters, kz_pendulum *pendulum);
const char *kz_drive_contradiction(const kz_pendulum_keys *written, const kz_pendulum *pendulum); /* NULL = none */
void kz_drive_print(const kz_parameters *parameters, FILE *out); /* what harmonics stand for, and how well */
void kz_release_resolve(const kz_parameters *parameters, kz_release *release);

/* The numerics mapping as written. */
typedef struct {
  int32_t scheme;           /* row of the kernel's table */
  int32_t steps_per_period; /* KZ_AUTO, or as given */
  double tolerance;         /* rad: the error of a drive period that KZ_AUTO allows the processed splitting */
} kz_numerics_keys;
enum { KZ_AUTO = 0 };

typedef struct {
  char *title; /* may be "" */
  kz_parameters parameters;
  kz_numerics_keys asked;
  kz_numerics numerics; /* what that comes to here (kz_numerics_resolve) */
  bool has_basin;
  kz_basin_plan basin;
  bool has_attractors;
  kz_attractors_plan attractors;
  bool has_saddles;
  kz_saddles_plan saddles;
  bool has_edge;
  kz_edge_plan edge;
  bool has_manifolds;
  kz_manifolds_plan manifolds;
  bool has_orbit;
  kz_orbit_plan orbit;
  bool has_stability;
  kz_stability_plan stability;
  bool has_potential;
  kz_potential_plan potential;
  bool has_tradeoff;
  kz_tradeoff_plan tradeoff;
  bool has_sweep;
  kz_sweep_plan sweep;
  bool has_chart;
  kz_chart_plan chart;
} kz_scene;

/* Steps a period of the study `orbit`: those of the scene, or more where a fast motion needs them; a multiple of the samples. */
enum { KZ_MOST_ORBIT_STEPS = 200000 };
double kz_orbit_steps(const kz_scene *scene);
/* The numerics of the study `orbit`: with that many steps of the scene's scheme, or of split6 where that is the processed one. */
kz_numerics kz_orbit_numerics(const kz_scene *scene);

/* One line: whether down and inverted are stable at rest (linearly), and between which amplitudes of the pivot, in the user's words. Nothing
 * without a pendulum. */
void kz_rest_print(const kz_parameters *parameters, FILE *out);

/* M r^2 of a pendulum written in SI units, kg m2; whether its inertia is at least that, to rounding. */
double kz_point_inertia(const kz_pendulum_keys *written);
bool kz_inertia_is_possible(const kz_pendulum_keys *written);

/* The keys of the pendulum mapping that a sweep can walk along. */
typedef struct {
  const char *name, *unit;
  size_t offset; /* in kz_pendulum_keys */
} kz_sweep_parameter;
enum { KZ_SWEEP_PARAMETERS = 23 };
extern const kz_sweep_parameter kz_sweep_parameters[KZ_SWEEP_PARAMETERS];
/* Their names, and what a sweep can measure, joined by '|'. */
const char *kz_sweep_words(void);
const char *kz_sweep_measure_words(void);

/* Value i of n >= 2 values, or of one, with both ends exact. */
double kz_axis_value(const kz_axis *values, int64_t i);
double kz_sweep_value(const kz_sweep_plan *plan, int64_t i);

/* The scene's pendulum with n of its keys (rows of kz_sweep_parameters) at other values; false where that is none (not finite,
 * negative damping, less inertia than a point). */
bool kz_pendulum_at(const kz_scene *scene, int n, const int32_t *parameter, const double *value, kz_pendulum *pendulum);

/* The same with the swept key at `value`. */
bool kz_sweep_pendulum(const kz_scene *scene, double value, kz_pendulum *pendulum);
/* How motions begin then. */
kz_release kz_sweep_release_at(const kz_scene *scene, double value);
/* Whether a key changes the beginning of motions alone. */
bool kz_sweep_is_of_release(int32_t parameter);

/* What a study would cost. */
typedef struct {
  int64_t cells;
  double disk_bytes;   /* result file and checkpoint */
  double memory_bytes; /* of every rank */
  double rank0_bytes;  /* of rank 0 besides */
  double shared_bytes; /* of all ranks together besides */
} kz_cost;

/* One row per study. `summary` is a stream for people on rank 0, NULL elsewhere; so is `store`. All ranks call run. `check`
 * (NULL = nothing to check) refuses a scene that the study cannot model, as where the steps are too coarse for its motions. The
 * message begins with the keys that a user could change ("numerics.steps_per_period|basin.velocity: ..."). `measure`
 * tells the processor time that run would take, seconds on one core, from samples of its work that it does and times; not collective. */
typedef struct {
  const char *name;
  bool (*wanted)(const kz_scene *scene);
  kz_cost (*cost)(const kz_scene *scene);
  kz_status (*run)(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary);
  kz_status (*check)(const kz_scene *scene);
  kz_status (*measure)(const kz_scene *scene, double *seconds);
} kz_study;
extern const kz_study kz_studies[];
extern const int kz_study_count;

/* KZ_REFUSED where a study cannot serve the drive. */
kz_status kz_drive_check(const kz_scene *scene);
/* KZ_REFUSED where a study of the scene does not pass its check: the first one's message. */
kz_status kz_studies_check(const kz_scene *scene);

/* Drive periods after which nearly all motions are trapped, at least 2000. Where that would be more than a million, 2000 too. */
int64_t kz_settling_periods(double beta);

/* The same for the weakest damping of a scene: that of its pendulum and of its sweep. */
int64_t kz_settling_scene(const kz_scene *scene);

/* A line for each study whose max_periods leaves most motions unsettled. It begins with the key to change. */
void kz_settling_warn(const kz_scene *scene, FILE *out);

/* The numerics that a scene asks for, for its pendulum, or for all values of its sweep: scene->numerics from scene->asked.
 * steps_per_period: auto of the processed splitting: the fewest steps whose measured error, at the speeds that the windows' motions
 * reach, is at most the tolerance and what small cells need; split6 with enough steps where there are none. auto of another scheme: its own number, or
 * as many more as the small cells of a damped basin need (smaller than 0.01 rad); left as it is where no number would do
 * (the basin's check says so then), and where basin.accuracy chooses. */
void kz_numerics_resolve(kz_scene *scene);

#endif
