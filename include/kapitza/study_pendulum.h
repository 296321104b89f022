/* study: the mapping `pendulum` of a scene as written, and the pendulum and its drive that follow from it. */
#pragma once

#include "kapitza/model.h"
#include "kapitza/store.h"

/* A list in a scene. */
#define KZ_LIST_MAX 256
typedef struct {
  int64_t count;
  double values[KZ_LIST_MAX];
} kz_reals;
typedef struct {
  int64_t count;
  int64_t values[KZ_LIST_MAX];
} kz_integers;

/* The mapping `pendulum` as written, in one of four forms a, b, c, d; NaN = key not given. */
typedef struct {
  double quality_factor, drive_frequency, drive_amplitude;                           /* a: Q, Omega, epsilon */
  double k, damping, m;                                                              /* b: k, beta, m */
  double mass, radius, inertia, friction, gravity, pivot_amplitude, pivot_frequency; /* c: SI, BSG Eq. (1) */
  double length;                                  /* c: m, of a point mass, instead of radius and inertia */
  double frequency;                               /* c: Hz, instead of pivot_frequency */
  double amplitude;                               /* c: m, instead of pivot_amplitude */
  double decay_time;                              /* c: s, 2 I/b, instead of friction or quality_factor */
  double constant_torque, oscillating_torque;     /* c: N m */
  double beta_c, omega, i_dc, i_ac;               /* d: of a Josephson junction */
  double tilt, ellipse, torque, torque_amplitude; /* rad; ratio of the axes; both in units of I omega^2 */
  double constant_torque_ratio, torque_ratio;     /* Torques in units of M g r */
  int32_t waveform;                               /* KZ_SINE, ... */
  kz_reals samples;                               /* KZ_SAMPLES: drive at equal times of a period, units of m */
  kz_harmonics harmonics;                         /* Harmonics that the scene adds */
  kz_reals vertical, horizontal; /* cosine and sine of harmonics 1, 2, .. of kz_pendulum, if these are written */
} kz_pendulum_keys;

/* A number that makes another drive than k - m cos t, without mirror symmetry; a row without path ends the list. */
typedef struct {
  const char *path; /* "pendulum.tilt" */
  size_t offset;    /* in kz_pendulum_keys */
} kz_drive_key;
extern const kz_drive_key kz_drive_keys[];
/* The first of them that is written, NULL = none; the key that makes the drive, as the beginning of a message. */
const char *kz_drive_unmirrored_by(const kz_pendulum_keys *written);
const char *kz_drive_made_by(const kz_pendulum_keys *written);

/* The parameters of a pendulum in all three forms. Numbers that are not defined are NaN (Q undamped, Omega at k <=
 * 0). */
typedef struct {
  kz_pendulum_keys written;
  kz_pendulum pendulum;
  double quality_factor, drive_frequency, drive_amplitude;
  double pivot_frequency; /* rad s-1; NaN without SI */
} kz_parameters;

/* m s-2; CGPM 1901. */
#define KZ_STANDARD_GRAVITY 9.80665

/* Computes all fields from `written`. KZ_REFUSED if k, beta or m is not finite; the fields are then not usable. */
kz_status kz_parameters_resolve(kz_parameters *parameters);

/* The largest kz_stiffness of a pendulum, and the largest speed of a start (rad per drive radian), that the program
 * follows. Beyond them a drive period takes more than 300,000 steps, or 10,000 turns. */
#define KZ_MOST_STIFFNESS 1e7
#define KZ_MOST_SPEED 1e4

/* kz_drive_resolve adds the drive that the keys describe to `pendulum`, which has k, beta and m. */
void kz_drive_resolve(const kz_parameters *parameters, kz_pendulum *pendulum);
/* The drive for k = 0 and m = 1, for the linear equation at rest; the cosine of a scene without a pendulum.
 * Coefficients beside m = 0 are left as they are. */
void kz_drive_form(const kz_parameters *parameters, kz_pendulum *form);
const char *kz_drive_contradiction(const kz_pendulum_keys *written); /* Contradiction between the keys; NULL = none */
void kz_drive_print(const kz_parameters *parameters, FILE *out);     /* Prints a summary line: harmonics used, error */
void kz_symmetries_print(const kz_pendulum *pendulum, FILE *out);    /* a line: the images that every motion has */
/* Writes the group `pendulum`: every number that is integrated. Rank 0. */
extern const kz_variable kz_pendulum_variables[];
kz_status kz_pendulum_write(const kz_parameters *parameters, kz_store *store);
/* Place of the pivot at a phase of the drive (rad): {aside, height} in units of I/(M r). */
void kz_pivot_at(const kz_parameters *parameters, double phase, double place[2]);
