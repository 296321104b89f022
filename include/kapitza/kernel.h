/* Batches of trajectories of the shaken pendulum (model.h) through whole drive periods (Fortran, above model).
 *
 * theta in rad from the DOWN position, t in drive radians, velocity in rad per drive radian. A period is 2 pi; every
 * period starts at t = 0 (pivot at its top). Integrators use half-turns (theta/pi), so that wrapping is exact. */
#pragma once

#include "kapitza/model.h"

/* A cache of series of the processed splitting, which serve the same pendulum again, a pendulum beside it, and any
 * number of steps, and of the errors of a period that were measured last (kz_step_errors). The caller owns it and frees
 * it after everything that was made with it; threads may share it. */
typedef struct kz_kept_series kz_kept_series;
kz_kept_series *kz_kept_series_create(void);
void kz_kept_series_free(kz_kept_series *series);

typedef struct {
  int32_t scheme;           /* Row of the table of schemes */
  int32_t steps_per_period; /* Steps of the scheme per drive period, >= 1 */
  /* Fields for the processed splitting, which kz_numerics_choose sets: */
  int32_t drift_terms;    /* Powers of the velocity in a drift, 1 to 4; 0 = all */
  int32_t kick_terms;     /* Coefficients of a kick, 4 to 11; 0 = all that matter in doubles */
  double fastest;         /* Speed above which split6 advances a state, rad per drive radian; 0 = 3 */
  kz_kept_series *series; /* Cache of series; NULL = none */
} kz_numerics;

/* A row of the table of integration schemes, which has rows 0 .. kz_scheme_count() - 1. */
typedef struct {
  char name[16];         /* rk4, split6, processed */
  int32_t order;         /* Order of convergence */
  int32_t kicks;         /* Sines per step */
  int32_t default_steps; /* Steps per period if the scene gives none */
} kz_scheme;
int32_t kz_scheme_count(void);
void kz_scheme_row(int32_t row, kz_scheme *scheme);
static inline kz_scheme kz_scheme_at(int32_t row) {
  kz_scheme scheme;
  kz_scheme_row(row, &scheme);
  return scheme;
}
/* Returns the row of the scheme called `name`; -1 if there is none. */
int32_t kz_scheme_find(const char *name);

/* Sets the numerics of all published numbers: split6 in doubles with 96 steps per period, more for a large force. */
void kz_numerics_fine(const kz_pendulum *pendulum, kz_numerics *numerics);

/* Chooses the cheapest processed splitting whose error of one period, measured against quad-precision Taylor series at
 * speeds up to `fastest` (rad per drive radian), is at most `tolerance` (rad, angle and velocity together). In:
 * numerics->series, and numerics->steps_per_period, 0 = choose it. Out: *numerics, and the measured *error. Returns
 * KZ_REFUSED, without a message, if no number of steps up to KZ_MOST_PROCESSED_STEPS reaches the tolerance. */
enum { KZ_MOST_PROCESSED_STEPS = 160 };
kz_status kz_numerics_choose(const kz_pendulum *pendulum, double tolerance, double fastest, kz_numerics *numerics,
                             double *error);

/* Returns the error of a drive period of `steps` steps, rad; DBL_MAX if it diverges. */
typedef double kz_step_error(int32_t steps, void *context);
/* Searches the number of steps of an integrator: tries `min`, then what the order predicts from the last error, until
 * an error is within `tolerance` (rad) or falls more slowly than 1/steps. Returns the last error and *steps, 0 if
 * none. */
double kz_steps_search(kz_step_error *error, void *context, int32_t accuracy_order, double tolerance, int32_t min,
                       int32_t max, int32_t *steps);
/* Returns n (error / tolerance)^(1/order), the steps expected to reach the tolerance if n steps have `error`. */
double kz_expected_steps(int32_t n, double error, double tolerance, int32_t accuracy_order);

/* The map of one drive period of a pendulum with given numerics. Opaque; free with kz_flow_free. */
typedef struct kz_flow kz_flow;
kz_flow *kz_flow_create(const kz_pendulum *pendulum, const kz_numerics *numerics);
void kz_flow_free(kz_flow *flow);
/* Frees the flow of a local variable (KZ_AUTOFREE_BY). */
static inline void kz_flow_freed(kz_flow **flow) {
  kz_flow_free(*flow);
}

/* Advances n states through `periods` whole periods; any n. In and out: theta [n] (rad; out: wrapped to [-pi, pi]),
 * velocity [n] (rad per drive radian). The net number of turns, counterclockwise +, is added to turns [n]. */
void kz_advance(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns);

/* kz_advance with the tangent map, matrix [n][4] = row-major d(theta, velocity)/d(theta0, velocity0). */
void kz_advance_tangent(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *speed, int64_t *turns,
                        double *matrix);

/* Samples one motion at t = 2 pi s / samples_per_period, s = 0 .. periods * samples_per_period. theta_out is unwrapped.
 * The flow's steps_per_period must be a multiple of samples_per_period. */
void kz_sample(const kz_flow *flow, int64_t periods, int64_t samples_per_period, double theta, double velocity,
               double *theta_out, double *velocity_out);

/* Models of an orbit: the pendulum, its linearisation, and the slow equation. */
enum { KZ_PENDULUM = 0, KZ_MATHIEU = 1, KZ_EFFECTIVE = 2 };

/* Samples one motion of a simpler model like kz_sample, with fine steps of its own (split6, at least 96 a period).
 * KZ_MATHIEU: u'' + beta u' + (k - m cos t) u = 0, with (-k, beta, -m) about the inverted position, u = theta - pi.
 * KZ_EFFECTIVE: theta'' + beta theta' + dE/dtheta = 0 with the potential of BSG Eq. (10). */
void kz_sample_model(int32_t model, const kz_pendulum *pendulum, int64_t periods, int64_t samples_per_period,
                     const double orbit_start[2], double *theta, double *velocity);

/* ---- linear ---- */

/* The pendulum near an equilibrium, one lane per parameter point.
 *
 * u'' + beta u' + (k - m f(t)) u = 0, Hill's equation; f is the drive of a pendulum `form` with k = 0 and m = 1. NULL
 * means the cosine (BUT Eq. 23; beta = 0: Mathieu's equation with a = 4k, q = 2m). t in drive radians; about the
 * inverted state k and m change their signs. The substitution u = exp(-beta t/2) w removes the damping: w'' + (k -
 * beta^2/4 - m f) w = 0. If f is even in t, half a period determines the whole one. */

/* Computes Floquet multipliers of n points.
 * log_multiplier [n]: natural log of the largest |multiplier| over one period.
 * angle [n]: argument of that multiplier / 2 pi, in [0, 1/2].
 * stable [n]: 1 where |trace| < 2 (beta = 0), |trace| < 1 + det (beta > 0), else 0. */
void kz_linear_floquet(const kz_pendulum *form, int64_t n, const double *k, const double *beta, const double *m,
                       double *log_multiplier, double *angle, uint8_t *stable);

/* ---- reference ---- */

/* Steps per period at which quad-precision Taylor series cost least if the drive is a sine; further harmonics take
 * more. Other numbers change a period by some 1e-33. */
enum { KZ_REFERENCE_STEPS = 18 };

/* One coordinate of a start, rad or rad per drive radian: exactly high + low, or decimal `centre` + share * width. */
typedef struct {
  double high, low;
  const char *centre; /* Decimal text of any digits, " deg" may follow; NULL = high + low is the coordinate */
  const char *width;  /* Decimal text; NULL = 0 */
  double share;       /* Share of the width */
} kz_coordinate;
