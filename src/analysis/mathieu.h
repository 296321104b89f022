/* Characteristic values of Mathieu's equation and the exact transition curves as roots. Curve 1 .. 5 = a_0, b_1, a_1, b_2, a_2
 * of y'' + (a - 2 q cos 2z) y = 0 with a = 4k, q = 2m (BUT sections 2-3). */
#ifndef KAPITZA_ANALYSIS_MATHIEU_H
#define KAPITZA_ANALYSIS_MATHIEU_H

/* k of a curve at m >= 0: from GSL up to q = 5000, beyond from the tridiagonal eigenproblem. GSL 2.7 loses digits
 * without a message: its relative error is 1e-12 at q = 3e4, 1e-8 at 1e5, and 1 at 1e6. */
double kz_mathieu_k(int curve, double m);
double kz_mathieu_k_gsl(int curve, double m);
double kz_mathieu_k_tridiagonal(int curve, double m);

/* m at which curve 3 or 5 turns back, at its largest k. */
double kz_mathieu_turn(int curve);

/* m of a curve at k, between the axis and its turn or (upper) beyond the turn; turn = 0 for curves that have none. NaN if
 * the curve does not exist at k. */
double kz_mathieu_m(int curve, double k, double turn, int upper);

#endif
