/* Spectra of orbits (FFTW), their turning points and names; roots and characteristic values (GSL).
 *
 * Angles in rad from the DOWN position, times in drive radians; a drive period is 2 pi. Nothing here is collective. */
#pragma once

#include "kapitza/model.h"

/* ---- spectra of orbits ---- */

/* Position about which an orbit moves, with the values of the file. */
enum { KZ_ABOUT_DOWN = 0, KZ_ABOUT_INVERTED = 1, KZ_ROTATING = 2, KZ_ABOUT_NEITHER = 3 };

/* A motion sampled at equal times, sample i at t = 2 pi i / samples_per_period. */
typedef struct {
  int64_t periods;            /* Drive periods of the record; n of a closed orbit */
  int64_t samples_per_period; /* Samples, periods * samples_per_period in all, without the end */
  double rotation;            /* Turns per drive period, counterclockwise +: winding/n of a closed orbit */
  double centre;              /* Angle from which lines are counted, 0 or pi, rad */
  bool closed;                /* True: the orbit closes after `periods`; false: an open record, which is windowed */
  bool velocity;              /* True: the samples are velocities, whose mean is not wrapped */
} kz_record;

/* Amplitude below which a line counts as 0, with phase NaN. */
#define KZ_LINE_FLOOR 1e-12

/* Returns the mean rotation of an open record, turns per drive period, by a fit weighted by the window below. */
double kz_spectrum_rotation(const kz_record *record, const double *theta);

/* Computes the lines of a record: theta - centre - rotation t = a0 + sum_j A_j cos(j t/periods + phase_j). theta
 * [periods * samples_per_period] unwrapped; size, phase [n_lines], line j at j/periods drive frequencies; line 0 is
 * abs(a0) with phase 0 or pi; a0 of an angle is in [-pi, pi]. A closed record gives the Fourier coefficients to
 * rounding. An open one is multiplied by the four-term Blackman-Harris window (Harris, Proc. IEEE 66 (1978) 51): side
 * lobes are below -92 dB, a line is eight bins wide and up to 0.83 dB low between bins, and its phase is right only at
 * the centre of a bin. KZ_REFUSED if 2 n_lines exceeds the number of samples; KZ_FAILED if FFTW has no memory. */
kz_status kz_spectrum_lines(const kz_record *record, const double *theta, int64_t n_lines, double *size, double *phase);

/* Returns the number j >= 1 of the largest line; 0 if all are below KZ_LINE_FLOOR. */
int64_t kz_spectrum_dominant(int64_t n_lines, const double *amplitude);

/* Returns the period n of the lines: the smallest n for which every relevant line is at a multiple of 1/n and n times
 * the rotation is a whole number. Closed record: n divides `periods`; lines above 1e-9 of the largest are relevant.
 * Open record: peaks above 1e-3 of the largest are relevant, and n <= periods/8; returns 0 if no n fits (aperiodic, not
 * settled, or the record is too short). */
int64_t kz_spectrum_period(const kz_record *record, int64_t n_lines, const double *amplitude);

/* Returns true if a closed orbit is its own mirror image n/2 periods later: it does not rotate, and is at rest or has
 * only odd lines. amplitude [n_lines] is of a record of n = periods. */
bool kz_spectrum_symmetric(const kz_record *record, int64_t n_lines, const double *amplitude);

/* ---- roots ---- */

typedef double (*kz_real_fn)(double x, void *context);
/* Returns the root of fn between low and high by Brent's method, to rounding; low or high if fn is 0 there; NaN if fn
 * does not change its sign, or is not finite at an end. */
double kz_root(kz_real_fn fn, void *context, double low, double high);

/* ---- shares ---- */

/* Returns the value below which a standard normal variable lies with this probability, between 0 and 1. */
double kz_normal_quantile(double probability);
/* Returns the upper bound, with probability `confidence`, of a share that occurred `hits` times in n independent draws
 * (C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404). */
double kz_share_upper(int64_t hits, int64_t n, double confidence);

/* ---- turning points ---- */

typedef struct {
  double time;  /* Time from the first sample, drive radians */
  double angle; /* Angle at this time, rad */
} kz_turning_point;

/* Finds the turning points, changes of sign of the velocity after the first sample, and returns their number. theta,
 * velocity [n] at the times i * step (drive radians); found [n]. Each is located on the Hermite polynomial through four
 * samples (degree 7, error of order step^8). */
int64_t kz_turning_points(int64_t n, double step, const double *theta, const double *velocity, kz_turning_point *found);

/* ---- names ---- */

enum { KZ_NAME_LENGTH = 48 };

/* Writes the name of an attractor by its period (0 = never closes), winding and centre to text [KZ_NAME_LENGTH], by the
 * table of docs/explanation/orbits.md. */
void kz_orbit_name(int64_t period, int64_t winding, int centre, char *text);

/* ---- fits ---- */

typedef struct {
  double intercept, slope, slope_stderr;
} kz_line;

/* Returns the line of least squares through n points; all values are NaN for n < 3. */
kz_line kz_fit_line(int64_t n, const double *x, const double *y);

/* ---- lifetimes ---- */

/* Mean of exponential times with its 95 % interval (chi-squared; B. Epstein, M. Sobel, J. Am. Stat. Assoc. 48 (1953)
 * 486). If no motion has ended, the mean is NaN and high is infinite. */
typedef struct {
  int64_t ended, open;
  double from; /* Time from which ends count, drive periods */
  double mean, low, high;
} kz_lifetime;
/* Returns the lifetime from the tail of time [n], drive periods, which is reordered; KZ_NOT_ENDED by the time
 * `longest`. */
#define KZ_NOT_ENDED UINT32_MAX
kz_lifetime kz_lifetime_tail(int64_t n, uint32_t *time, double longest);

/* ---- stability ---- */

/* Transition curves of the (damped) Mathieu equation and the effective potential (GSL).
 *
 * u'' + beta u' + (k - m cos t) u = 0; k of any sign (negative about the inverted state), curves as m >= 0 over k. BSG
 * = Blackburn et al. 1992, BUT = Butikov 2018; equations as corrected in docs/explanation/theory.md. Nothing here is
 * collective. */

/* ---- curves ---- */

/* Damping along a curve: beta, or beta = sqrt|k|/Q if quality_factor is finite and > 0. */
typedef struct {
  double beta;
  double quality_factor; /* Quality factor; NaN = not given */
} kz_damping;

double kz_damping_at(const kz_damping *damping, double k);

/* A row of the table of curves. A curve that turns back has two rows, the second one named NAME_upper. */
typedef struct {
  const char *name;  /* Name in the result file: exact_1 ... */
  const char *asked; /* Name in a scene: NAME for NAME_upper, else the name itself */
  double (*value)(double k, double beta, double turn);
  int turning; /* Exact curve, 3 or 5, at whose turn m is `turn`; 0 = not needed */
  double (*edge)(const kz_pendulum *form, int reading_number, double m); /* k / m of curve `number`, for `value` */
  int number;
} kz_curve;
extern const kz_curve kz_curves[];
extern const int kz_curve_count;

/* Returns the names that a scene may ask for, joined by '|'. */
const char *kz_curve_names(void);

/* Computes m [n] of a curve at k [n]; NaN where the curve does not exist. */
void kz_curve_values(const kz_curve *curve, const kz_damping *damping, int64_t n, const double *k, double *m);

/* Transition curves of Hill's equation u'' + (k - m f(t)) u = 0 as k over m, which is single-valued: 1 = the lowest k
 * with a solution of period 2 pi; 2, 3 = the two lowest with one of period 4 pi; 4, 5 = the next two of period 2 pi,
 * the lower one first. f is the drive of `form`, a pendulum with k = 0 and m = 1; kz_meissner_edge takes the square
 * wave f = sign(cos t), and leaves form out. Errors: some 1e-15 of 1 + |m|. */
enum { KZ_HILL_MOST_M = 1000 }; /* Largest m; beyond it kz_hill_edge returns NaN */
double kz_hill_edge(const kz_pendulum *form, int reading_number, double m);
double kz_meissner_edge(const kz_pendulum *form, int number_nodes, double m);

/* Computes the curve on which an undamped solution repeats after `order` >= 2 drive periods (Floquet angle 2 pi/order):
 * m_exact [n], and m_formula [n] by the determinant BUT (21), at k [n]. It goes from k = 1/order^2, m = 0 to negative
 * k; order 2 gives both edges of the first tongue. */
void kz_subharmonic_values(int32_t order_cells, int64_t n, const double *k, double *m_exact, double *m_formula);

/* ---- thresholds of the damped tongues 1 (k = 1/4) and 2 (k = 1) at a quality factor ---- */
typedef struct {
  double k_lowest, m_lowest; /* Lowest point of the tongue */
  double m_tuned;            /* m at exact tuning, k = 1/4 or 1 */
} kz_threshold;
enum { KZ_BY_FLOQUET, KZ_BY_DETERMINANT, KZ_BY_ASYMPTOTE };
/* Computes the threshold of tongue 1 or 2. method: KZ_BY_FLOQUET = exact; KZ_BY_DETERMINANT = BUT (25), (26);
 * KZ_BY_ASYMPTOTE = leading terms for large Q (BUT section 6, corrected). NaN if there is no tongue. */
void kz_tongue_threshold(int32_t tongue, double quality_factor, int32_t method, kz_threshold *threshold);

/* ---- effective potential, in units of I omega^2, zero at theta = 0 ---- */
typedef struct {
  double exact;     /* Energy of the slow equation BSG (10), closed form */
  double blackburn; /* BSG (11) */
  double simple;    /* BSG (12) */
} kz_energy;
void kz_potential_energy(double k, double beta, double m, double theta, kz_energy *energy);

typedef struct {
  double simple;        /* Top of (12), cos = -2 k/m^2, rad from down */
  double exact;         /* Top of the exact potential; NaN without a well about theta = pi */
  bool stable_inverted; /* True: the exact potential has that well */
} kz_rim;
void kz_potential_rim(double k, double beta, double m, kz_rim *rim);
