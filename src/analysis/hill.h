/* Hill's determinant: the harmonics exp(i w t) of a solution, w = w0 + j, obey D_w a_w = (m/2) (a_(w-1) + a_(w+1)) with
 * D_w = k - w^2 + i beta w. Elimination from the far end leaves pivots, R_w = D_w - x/R_(w+1), x = m^2/4. */
#ifndef KAPITZA_ANALYSIS_HILL_H
#define KAPITZA_ANALYSIS_HILL_H

#include <complex.h>
#include <stdbool.h>

/* The pivot R_w of all harmonics w, w + 1, ... (converged to rounding). */
double complex kz_hill_pivot(double k, double beta, double m, double w);

/* Zero where a periodic solution exists, scaled to stay finite near the axis; beta may be 0.
 * half: harmonics +-1/2, +-3/2, ... (multiplier -1); whole: 0, +-1, ... (multiplier +1). */
double kz_hill_half(double k, double beta, double m);
double kz_hill_whole(double k, double beta, double m);

/* The m of the tongue from the determinants cut to +-1/2, +-3/2 (BUT 25), to 0, +-1, +-2 (BUT 26), to nu, nu+-1, nu+-2
 * (BUT 21); NaN where there is none. larger: beyond the turn of the first. */
double kz_hill_cut_half(double k, double beta, bool larger);
double kz_hill_cut_whole(double k, double beta);
double kz_hill_cut_angle(double k, double nu);

#endif
