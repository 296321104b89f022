/* kernel: tiles of trajectories of the shaken pendulum through whole drive periods (Fortran; layer 0).
 *
 * theta'' + beta theta' + (k - m cos t) sin theta = 0   (BSG Eq. 2, BUT Eq. 9 in drive time)
 * theta in rad from the DOWN position, t in drive radians, velocity in rad per drive radian. A period is 2 pi; every period
 * starts at t = 0 (pivot at its top). Inside, angles are half-turns (theta/pi): wrapping is exact. */
#ifndef KAPITZA_KERNEL_H
#define KAPITZA_KERNEL_H

#include <stdint.h>

#include "kapitza/status.h"

typedef struct {
  double k;    /* 1/Omega^2; 0 = no gravity, < 0 = gravity upward */
  double beta; /* damping, >= 0 */
  double m;    /* drive, any sign */
} kz_pendulum;

/* Kinds: one text for all three. */
enum { KZ_SINGLE = 0, KZ_DOUBLE = 1, KZ_QUAD = 2 };

typedef struct {
  int32_t scheme;           /* row of the table of schemes */
  int32_t steps_per_period; /* whole compositions a period, >= 1 */
  int32_t precision;        /* KZ_SINGLE, KZ_DOUBLE, KZ_QUAD */
  /* Of the processed splitting, as kz_numerics_choose finds them: */
  int32_t drift_terms; /* powers of the velocity in a drift, 1 to 4 (6 in quad); 0 = all */
  int32_t kick_terms;  /* coefficients of a kick, 4 to 11 (22 in quad); 0 = as many as the kind can use */
  double fastest;      /* rad per drive radian: faster states are advanced by split6; 0 = 3 */
} kz_numerics;

/* The table of schemes. Rows 0 .. kz_scheme_count() - 1. */
typedef struct {
  char name[16];         /* rk4, split4, split6, split6-11 */
  int32_t order;         /* order of convergence */
  int32_t kicks;         /* sines per step */
  int32_t default_steps; /* steps per period where the scene gives none */
} kz_scheme;
enum { KZ_SPLIT6 = 2, KZ_PROCESSED = 4 }; /* the row that published values rest on; the fastest */
int32_t kz_scheme_count(void);
void kz_scheme_row(int32_t row, kz_scheme *scheme);

/* The cheapest processed splitting whose error of one period, measured against quad-precision Taylor series at speeds up to
 * `fastest` (rad per drive radian), is at most `tolerance` (rad, angle and velocity together). steps_per_period: 0 = to be
 * chosen, else kept. Fills *numerics (precision as it comes) and *error, the measured one. KZ_REFUSED, without a message, where
 * no number of steps up to KZ_MOST_PROCESSED_STEPS reaches it: fast starts, strong drives. */
enum { KZ_MOST_PROCESSED_STEPS = 160 };
kz_status kz_numerics_choose(const kz_pendulum *pendulum, double tolerance, double fastest, kz_numerics *numerics,
                             double *error);

/* A plan: pendulum and numerics turned into tables. Opaque; free with kz_plan_free. NULL where memory ran out. */
typedef struct kz_plan kz_plan;
kz_plan *kz_plan_create(const kz_pendulum *pendulum, const kz_numerics *numerics);
void kz_plan_free(kz_plan *plan);

/* Advances n states through `periods` whole periods. theta [n] comes back wrapped to [-pi, pi], turns [n] gains the net
 * number of turns (counterclockwise +). Any n; the interface is in doubles for every kind. */
void kz_advance(const kz_plan *plan, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns);

/* The same with the tangent map: matrix [n][4] = row-major d(theta, velocity)/d(theta0, velocity0) over the periods. */
void kz_advance_tangent(const kz_plan *plan, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns,
                        double *matrix);

/* One motion sampled in continuous time: sample s = 0 .. periods * samples_per_period at t = 2 pi s / samples_per_period.
 * theta_out is unwrapped. The plan's steps_per_period must be a multiple of samples_per_period. */
void kz_sample(const kz_plan *plan, int64_t periods, int64_t samples_per_period, double theta, double velocity,
               double *theta_out, double *velocity_out);

/* Models of an orbit: the pendulum itself, and two simpler ones. */
enum { KZ_PENDULUM = 0, KZ_MATHIEU = 1, KZ_EFFECTIVE = 2 };

/* One motion of a simpler model, sampled like kz_sample, with fine steps of its own (split6, at least 96 a period).
 * KZ_MATHIEU: u'' + beta u' + (k - m cos t) u = 0, with (-k, beta, -m) about the inverted position, u = theta - pi.
 * KZ_EFFECTIVE: theta'' + beta theta' + dE/dtheta = 0 with the potential of BSG Eq. (10). */
void kz_sample_model(int32_t model, const kz_pendulum *pendulum, int64_t periods, int64_t samples_per_period, double theta,
                     double velocity, double *theta_out, double *velocity_out);

/* The kernel's own sine: sin(pi u) of half-turns u [n], in the given kind (for tests). */
void kz_sine(int32_t precision, int64_t n, const double *half_turns, double *sine);

#endif
