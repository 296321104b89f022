/* The damped continuation of the transition curves, exactly. */
#ifndef KAPITZA_ANALYSIS_TONGUES_H
#define KAPITZA_ANALYSIS_TONGUES_H

#include <stdbool.h>

/* Where the inverted well begins (k < 0): the damped continuation of curve 1. */
double kz_tongue_lower(double k, double beta);

/* The lowest m, or with upper_edge the highest, of tongue 1 (from k = 1/4, multiplier -1) or 2 (from k = 1, multiplier +1) at k;
 * NaN where there is none. turn: where curve 3 or 5 turns back. */
double kz_tongue_edge(int tongue, double k, double beta, double turn, bool upper_edge);

#endif
