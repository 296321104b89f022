/* Roots and lowest points of a function of one variable, by GSL's Brent. */
#ifndef KAPITZA_ANALYSIS_ROOTS_H
#define KAPITZA_ANALYSIS_ROOTS_H

typedef double (*kz_real_fn)(double x, void *context);

/* The root of fn between low and high to rounding; low or high themselves where fn is 0 there; NaN where fn does not change
 * its sign. */
double kz_root(kz_real_fn fn, void *context, double low, double high);

/* Where fn is lowest between low and high, given one interior point below both ends; `guess` where there is none. */
double kz_lowest(kz_real_fn fn, void *context, double low, double guess, double high);

#endif
