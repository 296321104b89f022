/* kernel: batches of trajectories of the shaken pendulum through whole drive periods (Fortran; layer 0).
 The equation: model.h.
 *
 * theta in rad from the DOWN position, t in drive radians, velocity in rad per drive radian. A period is 2 pi; every period
 * starts at t = 0 (pivot at its top). Inside, angles are half-turns (theta/pi): wrapping is exact. */
#ifndef KAPITZA_KERNEL_H
#define KAPITZA_KERNEL_H

#include <stdint.h>

#include "kapitza/model.h"

typedef struct {
  int32_t scheme;           /* row of the table of schemes */
  int32_t steps_per_period; /* whole compositions a period, >= 1 */
  /* Of the processed splitting, as kz_numerics_choose finds them: */
  int32_t drift_terms; /* powers of the velocity in a drift, 1 to 4; 0 = all */
  int32_t kick_terms;  /* coefficients of a kick, 4 to 11; 0 = as many as doubles can use */
  double fastest;      /* rad per drive radian: faster states are advanced by split6; 0 = 3 */
} kz_numerics;

/* The table of schemes. Rows 0 .. kz_scheme_count() - 1. */
typedef struct {
  char name[16];         /* rk4, split6, processed */
  int32_t order;         /* order of convergence */
  int32_t kicks;         /* sines per step */
  int32_t default_steps; /* steps per period where the scene gives none */
} kz_scheme;
int32_t kz_scheme_count(void);
void kz_scheme_row(int32_t row, kz_scheme *scheme);
/* The row of that name; -1 where there is none. */
int32_t kz_scheme_find(const char *name);

/* The numerics of published values, whatever the scene's: split6 in double precision, 96 steps, more where the torque is
 * large. */
void kz_numerics_fine(const kz_pendulum *pendulum, kz_numerics *numerics);

/* The cheapest processed splitting whose error of one period, measured against quad-precision Taylor series at speeds up to
 * `fastest` (rad per drive radian), is at most `tolerance` (rad, angle and velocity together). steps_per_period: 0 = to be
 * chosen, else kept. Fills *numerics and *error, the measured one. KZ_REFUSED, without a message, where no number of steps
 * up to KZ_MOST_PROCESSED_STEPS reaches it: fast starts, strong drives. */
enum { KZ_MOST_PROCESSED_STEPS = 160 };
kz_status kz_numerics_choose(const kz_pendulum *pendulum, double tolerance, double fastest, kz_numerics *numerics,
                             double *error);

/* The search itself, for any integrator whose error can be measured: `error` tells the error of a period of so many steps (rad; DBL_MAX where it
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

/* Advances n states through `periods` whole periods. theta [n] comes back wrapped to [-pi, pi], turns [n] gains the net
 * number of turns (counterclockwise +). Any n. */
void kz_advance(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns);

/* The same with the tangent map: matrix [n][4] = row-major d(theta, velocity)/d(theta0, velocity0) over the periods. */
void kz_advance_tangent(const kz_flow *flow, int64_t n, int64_t periods, double *theta, double *velocity, int64_t *turns,
                        double *matrix);

/* One motion sampled in continuous time: sample s = 0 .. periods * samples_per_period at t = 2 pi s / samples_per_period.
 * theta_out is unwrapped. The flow's steps_per_period must be a multiple of samples_per_period. */
void kz_sample(const kz_flow *flow, int64_t periods, int64_t samples_per_period, double theta, double velocity,
               double *theta_out, double *velocity_out);

/* Models of an orbit: the pendulum itself, and two simpler ones. */
enum { KZ_PENDULUM = 0, KZ_MATHIEU = 1, KZ_EFFECTIVE = 2 };

/* One motion of a simpler model, sampled like kz_sample, with fine steps of its own (split6, at least 96 a period).
 * KZ_MATHIEU: u'' + beta u' + (k - m cos t) u = 0, with (-k, beta, -m) about the inverted position, u = theta - pi.
 * KZ_EFFECTIVE: theta'' + beta theta' + dE/dtheta = 0 with the potential of BSG Eq. (10). */
void kz_sample_model(int32_t model, const kz_pendulum *pendulum, int64_t periods, int64_t samples_per_period, double theta,
                     double velocity, double *theta_out, double *velocity_out);

/* The kernel's own sine: sin(pi u) of half-turns u [n] (for tests). */
void kz_sine(int64_t n, const double *half_turns, double *sine);

/* ---- linear ---- */

/* The pendulum near an equilibrium, a lane per parameter point.
 *
 * u'' + beta u' + (k - m cos t) u = 0   (BUT Eq. 23; beta = 0: Mathieu's equation with a = 4k, q = 2m)
 * t in drive radians; about the inverted state k is negative. With u = exp(-beta t/2) w the damping leaves the equation,
 * w'' + (k - beta^2/4 - m cos t) w = 0, which is even in t: half a period is enough.
 *
 * Half a period: w(pi) = c, s and w'(pi) = c', s' of the two solutions with (w, w') = (1, 0), (0, 1) at t = 0. Over a whole
 * period trace/2 = 2 c s' - 1 = 2 s c' + 1, so every transition curve is a zero of one of the four numbers. */

/* One point, of Hill's equation without damping: matrix = c, s, c', s' in units of 2^exponent. */
typedef struct {
  double c, s, c_dot, s_dot;
  int64_t exponent; /* 0 unless a number exceeded 2^400 */
} kz_half_period;

/* Solutions at t = pi for n points k [n], beta [n], m [n]. Relative error about 1e-15 (1 + sqrt(|k| + |m|)). */
void kz_linear_half_period(int64_t n, const double *k, const double *beta, const double *m, kz_half_period *half);

/* Floquet's answer for n points.
 * log_multiplier [n]: natural log of the largest |multiplier| over one period.
 * angle [n]: argument of that multiplier / 2 pi, in [0, 1/2].
 * stable [n]: 1 where |trace| < 2 (beta = 0), |trace| < 1 + det (beta > 0), else 0. */
void kz_linear_floquet(int64_t n, const double *k, const double *beta, const double *m, double *log_multiplier, double *angle,
                       uint8_t *stable);

/* ---- reference ---- */

/* Whole drive periods in quad precision. States in real128, moved by Taylor series of order 56
 * whose steps follow the motion; independent of the schemes above. Labels are compared with it: its error is some 1e-32 a
 * period, up to 1e-29 of a strong drive; that of double precision 1e-16. */

/* Steps a period that cost least; any other number gives the same motion to some 1e-32 a period. */
enum { KZ_REFERENCE_STEPS = 18 };

/* A state in quad precision. Opaque: kz_reference_start fills it, kz_reference_read shows it. Owned by the caller. */
typedef struct {
  _Alignas(16) unsigned char quads[32];
  int64_t turns;
} kz_reference_state;

/* States [n] at t = 0 from doubles: theta [n] in rad, velocity [n] in rad per drive radian; low [n][2]: what is to be added to them,
 * below their last places; NULL = nothing. The sums are taken as exact. */
void kz_reference_start(int64_t n, const double *theta, const double *velocity, const double *low, kz_reference_state *states);

/* Advances states [n] through `periods` whole periods with `steps` >= 1 a period, halved for a state whose series does not
 * converge on them. A motion that no halving carries (some 1e7 times faster than the drive) becomes NaN. A state's result
 * depends neither on its neighbours nor on how periods are shared out to calls; eight states or more go together at best
 * speed, and tables are made per call. */
void kz_reference_advance(const kz_pendulum *pendulum, int32_t steps, int64_t n, int64_t periods, kz_reference_state *states);

/* The states rounded to doubles: theta [n] wrapped to [-pi, pi], turns [n] = net turns since kz_reference_start. */
void kz_reference_read(int64_t n, const kz_reference_state *states, double *theta, double *velocity, int64_t *turns);

/* What a period may miss with KZ_REFERENCE_STEPS, of hypot(pi, velocity) for speeds up to `fastest`: measured between two numbers of steps, with
 * a margin. */
double kz_reference_error(const kz_pendulum *pendulum, double fastest);

/* ---- pairs ---- */

/* Whole drive periods in pairs of doubles, high + low: some 32 digits, many states at once, for a twentieth of what the
 * reference costs. A handle holds tables of the processed splitting with so many steps that the error of a period (rad, angle and
 * velocity together), measured against the reference, is at most `tolerance` for speeds up to `fastest` (rad per drive radian);
 * *error = that measured error. States that are faster, or that no table serves, are moved by the reference's series. Opaque;
 * Free with kz_pairs_free. */
typedef struct kz_pairs kz_pairs;
kz_pairs *kz_pairs_create(const kz_pendulum *pendulum, double tolerance, double fastest, double *error);
void kz_pairs_free(kz_pairs *pairs);

/* Advances n states through `periods` whole periods. half_turns [n][2]: theta/pi, high and low, comes back wrapped to [-1, 1];
 * velocity [n][2] in rad per drive radian; turns [n] gains the net number of turns. A state's result does not depend on its
 * neighbours; the mirror image goes to the mirror image, to the bit. */
void kz_pairs_advance(const kz_pairs *pairs, int64_t n, int64_t periods, double *half_turns, double *velocity, int64_t *turns);

/* ---- any precision ---- */

/* Whole drive periods in as many digits as asked for, by Taylor series, and beside the orbit its neighbourhood: the images of the starts
 * centre + (x, y) are polynomials of degree 3 in x and y. Numbers are FLINT's (Arb); a build without it has quads. */

/* The most bits behind the point: KZ_MOST_BITS, or 113 without FLINT. */
enum { KZ_MOST_BITS = 40000, KZ_FEWEST_BITS = 116 };
int64_t kz_arbitrary_bits(void);

/* One coordinate of a start, rad or rad per drive radian: high + low exactly, or a decimal text of any digits (maybe with " deg" behind it),
 * and so large a share of a width more. */
typedef struct {
  double high, low;
  const char *centre; /* NULL: high + low */
  const char *width;  /* decimal text; NULL: 0 */
  double share;
} kz_coordinate;

/* The coordinate as decimal text, at least so many digits behind the point right: text [size]. KZ_FAILED where it does not fit. */
kz_status kz_coordinate_text(const kz_coordinate *coordinate, int64_t digits, char *text, size_t size);
/* a - b, right to 2^-bits or to a quad. */
__float128 kz_coordinate_difference(const kz_coordinate *a, const kz_coordinate *b, int64_t bits);

/* The neighbourhood of an orbit: coefficients of x, y; xx, xy, yy; xxx, xxy, xyy, yyy for the angle (0) and the velocity (1). Those of the
 * first degree are right to 33 digits, the others, and the first degree alone, to 17. */
enum { KZ_BENT = 7 };
typedef struct {
  __float128 linear[2][2];
  long double bent[2][KZ_BENT];
} kz_jet;

/* A state in many digits. Opaque. `bits` behind the point are kept at most; the start is rounded to them. */
typedef struct kz_arbitrary kz_arbitrary;
kz_arbitrary *kz_arbitrary_create(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits);
void kz_arbitrary_free(kz_arbitrary *orbit);

/* Advances through one drive period with so many bits behind the point, from KZ_FEWEST_BITS on; *jet becomes the neighbourhood at
 * its end up to `degree` 1 or 3; 0: it may be NULL. The error of the state is some 2^-bits, and those that the motion makes of earlier ones. KZ_FAILED where the
 * motion is too fast for 2^14 steps a period. */
kz_status kz_arbitrary_advance(kz_arbitrary *orbit, int64_t bits, int degree, kz_jet *jet);

/* The state as pairs of doubles, high + low: rad in [-pi, pi], rad per drive radian; whole turns are left out. */
void kz_arbitrary_read(const kz_arbitrary *orbit, double theta[2], double velocity[2]);

/* The same in quad precision. */
void kz_arbitrary_read_quads(const kz_arbitrary *orbit, __float128 state[2]);

/* The state as text [kz_arbitrary_size], exactly. A checkpoint keeps it. KZ_FAILED where the text is not one. */
size_t kz_arbitrary_size(const kz_arbitrary *orbit);
void kz_arbitrary_write(const kz_arbitrary *orbit, char *text);
kz_status kz_arbitrary_restore(kz_arbitrary *orbit, const char *text);

/* ---- enclosures ---- */

/* Sets of states that are proved to hold the true motion: no error of a scheme, no rounding is left out (docs/explanation/proof.md). Taylor
 * polynomials of order 22 in doubles, of order 40 in pairs of doubles and in quad precision. Parameters are the doubles given. */
enum { KZ_ENCLOSE_DOUBLES, KZ_ENCLOSE_PAIRS, KZ_ENCLOSE_QUADS, KZ_ENCLOSURES };

/* All states centre + matrix z with |z[i]| <= reach[i]. A set that has been lost has reach INFINITY. */
typedef struct {
  double theta[3], velocity[3]; /* of the centre, sums of three: rad, rad per drive radian */
  double matrix[2][2];          /* rows: theta, velocity */
  double reach[2];
  double jacobian_error[2][2];
} kz_enclosure;

/* Whether the matrix becomes a rotation after each period, by which a set that is followed for long stays small; or remains the
 * tangent map times the matrix of the start. Then z is a function of z0, where the set began, with |z[i] - z0[i]| <= the growth of
 * reach[i] and |dz[i]/dz0[j] - (i == j)| <= jacobian_error[i][j], which begins with 0. */
typedef enum { KZ_NEW_FRAME, KZ_KEEP_FRAME } kz_enclosure_frame;

/* Tables for sets whose centres are never faster than `fastest` (rad per drive radian) where a step begins; those that are get lost.
 * KZ_REFUSED, without a message, where that takes more than 4096 steps a period, or the drive is not k - m cos t alone. */
typedef struct kz_enclosure_tables kz_enclosure_tables;
kz_status kz_enclosure_tables_create(const kz_pendulum *pendulum, int32_t precision, double fastest,
                                     kz_enclosure_tables **tables);
void kz_enclosure_tables_free(kz_enclosure_tables *tables);

/* Advances n sets [n] through one drive period, whole turns left out. A set's result does not depend on its neighbours; some hundred
 * go together at best speed. */
void kz_enclosures_advance(const kz_enclosure_tables *tables, kz_enclosure_frame frame, int64_t n, kz_enclosure *set);

#endif
