/* Roots and lowest points of a function of one variable, by GSL's Brent. */
#ifndef KAPITZA_ANALYSIS_ROOTS_H
#define KAPITZA_ANALYSIS_ROOTS_H

typedef double (*kz_real_fn)(double x, void *context);

/* The root of fn between low and high, to rounding; low or high if fn is 0 there; NaN if fn does not change its sign. */
double kz_root(kz_real_fn fn, void *context, double low, double high);

/* The place of the minimum of fn between low and high. `guess` is an interior point at which fn is below both ends; it is returned if it is
 * not. */
double kz_lowest(kz_real_fn fn, void *context, double low, double guess, double high);

#endif
