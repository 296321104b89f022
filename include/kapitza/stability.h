/* stability: transition curves of the (damped) Mathieu equation and the effective potential (GSL). C; layer 1, analysis.
 *
 * u'' + beta u' + (k - m cos t) u = 0; k of any sign (negative about the inverted state), curves as m >= 0 over k. BSG =
 * Blackburn et al. 1992, BUT = Butikov 2018; equations as corrected in docs/theory.md. Nothing here is collective. */
#ifndef KAPITZA_STABILITY_H
#define KAPITZA_STABILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/status.h"

/* ---- curves ---- */

/* Damping along a curve: beta itself, or beta = sqrt|k|/Q where quality_factor is finite and > 0. */
typedef struct {
  double beta;
  double quality_factor; /* NaN = not given */
} kz_damping;

double kz_damping_at(const kz_damping *damping, double k);

/* A row of the table of curves. A curve that turns back has two rows, the second one named NAME_upper. */
typedef struct {
  const char *name;  /* exact_1 ... of the result file */
  const char *asked; /* the name by which a scene asks for it: NAME for NAME_upper, else the name itself */
  double (*value)(double k, double beta, double turn);
  double (*turn)(void); /* m where the curve turns back; NULL for one that does not need it */
} kz_curve;
extern const kz_curve kz_curves[];
extern const int kz_curve_count;

/* The names that a scene may ask for, joined by '|'. */
const char *kz_curve_names(void);

/* m of a curve at k [n], NaN where it does not exist. */
void kz_curve_values(const kz_curve *curve, const kz_damping *damping, int64_t n, const double *k, double *m);

/* The curve on which a solution repeats after `order` >= 2 drive periods (Floquet angle 2 pi/order), from k = 1/order^2, m = 0
 * to negative k; order 2: both edges of the first tongue. Exact, and by the determinant BUT (21). beta = 0. */
void kz_subharmonic_values(int32_t order, int64_t n, const double *k, double *m_exact, double *m_formula);

/* ---- thresholds of the damped tongues 1 (k = 1/4) and 2 (k = 1) at a quality factor ---- */
typedef struct {
  double k_lowest, m_lowest; /* the lowest point of the tongue */
  double m_tuned;            /* m at exact tuning, k = 1/4 or 1 */
} kz_threshold;
enum { KZ_BY_FLOQUET, KZ_BY_DETERMINANT, KZ_BY_ASYMPTOTE };
/* way: exact; from BUT (25), (26); leading terms for large Q (BUT section 6, corrected). NaN where there is no tongue. */
void kz_tongue_threshold(int32_t tongue, double quality_factor, int32_t way, kz_threshold *threshold);

/* ---- effective potential, in units of I omega^2, zero at theta = 0 ---- */
typedef struct {
  double exact;     /* of the slow equation BSG (10), closed form */
  double blackburn; /* BSG (11) */
  double simple;    /* BSG (12) */
} kz_energy;
void kz_potential_energy(double k, double beta, double m, double theta, kz_energy *energy);

typedef struct {
  double simple;        /* rad from down: cos = -2 k/m^2, the top of (12) */
  double exact;         /* the top of the exact potential; NaN without a well about theta = pi */
  bool stable_inverted; /* the exact potential has that well */
} kz_rim;
void kz_potential_rim(double k, double beta, double m, kz_rim *rim);

#endif
