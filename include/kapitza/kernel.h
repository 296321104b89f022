/* kernel: batches of trajectories of the shaken pendulum through whole drive periods (Fortran; layer 0).
 The equation: model.h.
 *
 * theta in rad from the DOWN position, t in drive radians, velocity in rad per drive radian. A period is 2 pi; every period
 * starts at t = 0 (pivot at its top). Inside, angles are half-turns (theta/pi): wrapping is exact. */
#pragma once

#include <stdint.h>

#include "kapitza/model.h"

/* Series of the processed splitting, kept because they take long to make: they serve the same pendulum again, a pendulum beside it, and any number of
 * steps. Beside them the errors of a period that were measured last are kept (kz_step_errors). The caller owns the object and frees it after
 * everything that was made with it; threads may share it. */
typedef struct kz_kept_series kz_kept_series;
kz_kept_series *kz_kept_series_create(void);
void kz_kept_series_free(kz_kept_series *series);

typedef struct {
  int32_t scheme;           /* row of the table of schemes */
  int32_t steps_per_period; /* whole compositions a period, >= 1 */
  /* For the processed splitting; kz_numerics_choose sets these: */
  int32_t drift_terms;    /* number of powers of the velocity in a drift, 1 to 4; 0 = all */
  int32_t kick_terms;     /* number of coefficients of a kick, 4 to 11; 0 = all that matter in doubles */
  double fastest;         /* rad per drive radian: split6 advances faster states; 0 = 3 */
  kz_kept_series *series; /* where series are kept; NULL = each is made anew */
} kz_numerics;

/* The table of schemes. Rows 0 .. kz_scheme_count() - 1. */
typedef struct {
  char name[16];         /* rk4, split6, processed */
  int32_t order;         /* order of convergence */
  int32_t kicks;         /* sines per step */
  int32_t default_steps; /* steps per period if the scene gives none */
} kz_scheme;
int32_t kz_scheme_count(void);
void kz_scheme_row(int32_t row, kz_scheme *scheme);
static inline kz_scheme kz_scheme_at(int32_t row) {
  kz_scheme scheme;
  kz_scheme_row(row, &scheme);
  return scheme;
}
/* The row of that name; -1 if there is none. */
int32_t kz_scheme_find(const char *name);

/* The numerics of all published numbers, independent of the scene's: split6 in double precision with 96 steps, or more for a large
 * torque. */
void kz_numerics_fine(const kz_pendulum *pendulum, kz_numerics *numerics);

/* The cheapest processed splitting whose error of one period, measured against quad-precision Taylor series at speeds up to
 * `fastest` (rad per drive radian), is at most `tolerance` (rad, angle and velocity together). In: numerics->series,
 * and numerics->steps_per_period, 0 = choose it.
 * Out: *numerics, and the measured *error. KZ_REFUSED, without a message, if no number of steps up to KZ_MOST_PROCESSED_STEPS reaches the
 * tolerance, as for fast starts and strong drives. */
enum { KZ_MOST_PROCESSED_STEPS = 160 };
kz_status kz_numerics_choose(const kz_pendulum *pendulum, double tolerance, double fastest, kz_numerics *numerics,
                             double *error);

/* The search itself, for any integrator whose error can be measured: `error` gives the error of a period of so many steps (rad; DBL_MAX where it
 * diverges). Tries `fewest` steps, then what the order expects from the last error, until an error is at most `tolerance` (rad) or falls more
 * slowly than as 1/steps. Returns the last error; *steps: its number, 0 where fewest exceeds most. */
typedef double kz_step_error(int32_t steps, void *context);
double kz_steps_search(kz_step_error *error, void *context, int32_t order, double tolerance, int32_t fewest, int32_t most,
                       int32_t *steps);
/* n (error / tolerance)^(1/order): how many steps make an error of n steps as small as the tolerance. */
double kz_expected_steps(int32_t n, double error, double tolerance, int32_t order);

/* A flow: pendulum and numerics turned into the map of one drive period. Opaque; free with kz_flow_free. */
typedef struct kz_flow kz_flow;
kz_flow *kz_flow_create(const kz_pendulum *pendulum, const kz_numerics *numerics);
void kz_flow_free(kz_flow *flow);
/* Of a local variable (KZ_FREED_BY). */
static inline void kz_flow_freed(kz_flow **flow) {
  kz_flow_free(*flow);
}

/* Advances n states through `periods` whole periods; any n. In and out: theta [n] (rad; out: wrapped to [-pi, pi]), velocity [n] (rad per
 * drive radian). The net number of turns, counterclockwise +, is added to turns [n]. */
void kz_advance(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns);

/* The same with the tangent map: matrix [n][4] = row-major d(theta, velocity)/d(theta0, velocity0) over the periods. */
void kz_advance_tangent(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns,
                        double *matrix);

/* One motion sampled in continuous time: sample s = 0 .. periods * samples_per_period at t = 2 pi s / samples_per_period.
 * theta_out is unwrapped. The flow's steps_per_period must be a multiple of samples_per_period. */
void kz_sample(const kz_flow *flow, int64_t periods, int64_t samples_per_period, double theta, double velocity,
               double *theta_out, double *velocity_out);

/* Models of an orbit: the pendulum, and two simpler ones. */
enum { KZ_PENDULUM = 0, KZ_MATHIEU = 1, KZ_EFFECTIVE = 2 };

/* One motion of a simpler model, sampled like kz_sample, with fine steps of its own (split6, at least 96 a period).
 * KZ_MATHIEU: u'' + beta u' + (k - m cos t) u = 0, with (-k, beta, -m) about the inverted position, u = theta - pi.
 * KZ_EFFECTIVE: theta'' + beta theta' + dE/dtheta = 0 with the potential of BSG Eq. (10). */
void kz_sample_model(int32_t model, const kz_pendulum *pendulum, int64_t periods, int64_t samples_per_period, double theta,
                     double velocity, double *theta_out, double *velocity_out);

/* ---- linear ---- */

/* The pendulum near an equilibrium, a lane per parameter point.
 *
 * u'' + beta u' + (k - m f(t)) u = 0, Hill's equation; f is the drive of a pendulum `form` with k = 0 and m = 1. NULL means the cosine (BUT Eq. 23;
 * beta = 0: Mathieu's equation with a = 4k, q = 2m). t in drive radians; about the inverted state k and m change their signs. The substitution
 * u = exp(-beta t/2) w removes the damping: w'' + (k - beta^2/4 - m f) w = 0. If f is even in t, half a period determines the whole one;
 * else the second half is followed too, backwards. */

/* Floquet's answer for n points.
 * log_multiplier [n]: natural log of the largest |multiplier| over one period.
 * angle [n]: argument of that multiplier / 2 pi, in [0, 1/2].
 * stable [n]: 1 where |trace| < 2 (beta = 0), |trace| < 1 + det (beta > 0), else 0. */
void kz_linear_floquet(const kz_pendulum *form, int64_t n, const double *k, const double *beta, const double *m,
                       double *log_multiplier, double *angle, uint8_t *stable);

/* ---- reference ---- */

/* The number of steps a period that costs least for Taylor series in quad precision, where the drive is a sine; with further harmonics more are
 * taken. Any other number gives the same motion, to some 1e-33 a period. */
enum { KZ_REFERENCE_STEPS = 18 };

/* One coordinate of a start, rad or rad per drive radian: exactly high + low, or the decimal number `centre` plus share * width. */
typedef struct {
  double high, low;
  const char *centre; /* decimal text of any digits, " deg" may follow; NULL = high + low is the coordinate */
  const char *width;  /* decimal text; NULL = 0 */
  double share;       /* of the width */
} kz_coordinate;
