/* Functions of transition curves: Hill's determinant, Mathieu's characteristic values, damped tongues, minima. */
#pragma once

#include <complex.h>

#include "kapitza/analysis.h"

/* ---- lowest points of a function of one variable, by Brent ---- */

/* Returns the place of the minimum of fn between low and high. At `guess` fn is below both ends; else it is
 * returned. */
double kz_lowest(kz_real_fn fn, void *context, double low, double guess, double high);

/* Hill's determinant. The harmonics exp(i w t) of a solution, w = w0 + j, obey D_w a_w = (m/2) (a_(w-1) + a_(w+1)) with
 * D_w = k - w^2 + i beta w. Elimination from the far end leaves pivots, R_w = D_w - x/R_(w+1), x = m^2/4. */

/* The pivot R_w of all harmonics w, w + 1, ... (converged to rounding). */
double complex kz_hill_pivot(double k, double beta, double m, double w);

/* Functions that vanish where a periodic solution exists, scaled to stay finite near the axis; beta may be 0. half:
 * harmonics +-1/2, +-3/2, ... (multiplier -1); whole: 0, +-1, ... (multiplier +1). */
double kz_hill_half(double k, double beta, double m);
double kz_hill_whole(double k, double beta, double m);

/* Return m of the tongue from the determinants cut to +-1/2, +-3/2 (BUT 25), to 0, +-1, +-2 (BUT 26), to nu, nu+-1,
 * nu+-2 (BUT 21); NaN where there is none. larger: beyond the turn of the first. */
double kz_hill_cut_half(double k, double beta, bool larger);
double kz_hill_cut_whole(double k, double beta);
double kz_hill_cut_angle(double k, double nu);

/* Characteristic values of Mathieu's equation and the exact transition curves as roots. Curve 1 .. 5 = a_0, b_1, a_1,
 * b_2, a_2 of y'' + (a - 2 q cos 2z) y = 0 with a = 4k, q = 2m (BUT sections 2-3). */

/* Returns m at which curve 3 or 5 turns back, at its largest k. */
double kz_mathieu_turn(int curve);

/* Returns m of a curve at k, between the axis and its turn or (upper) beyond the turn; turn = 0 for curves without one.
 * NaN if the curve does not exist at k. */
double kz_mathieu_m(int curve, double k, double turn, int upper);

/* ---- the damped continuation of the transition curves, exactly ---- */

/* Returns m at which the inverted well begins (k < 0), on the damped continuation of curve 1. */
double kz_tongue_lower(double k, double beta);

/* Returns the lowest m, or with upper_edge the highest, of tongue 1 (from k = 1/4, multiplier -1) or 2 (from k = 1,
 * multiplier +1) at k; NaN without a tongue. turn: m at which curve 3 or 5 turns back. */
double kz_tongue_edge(int tongue, double k, double beta, double turn, bool upper_edge);
