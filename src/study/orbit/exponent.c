#include "exponent.h"

#include <math.h>

enum { BLOCKS = 10, LEAST_PERIODS = 1000, MOST_PERIODS = 100000 };

/* An orbit that starts within rounding (1e-16) of an unstable cycle has left it when its neighbours have parted by
 * exp(ESCAPE). */
static const double ESCAPE = 40;
/* An exponent counts as positive if it exceeds so many standard errors. */
static const double CONFIDENCE = 5;

/* Carries a unit deviation through one period; returns the logarithm of its growth. */
static double growth(const kz_model *model, kz_state *x, double *deviation) {
  double matrix[4];
  int64_t turns = 0;
  kz_advance_tangent(model->flow, 1, 1, &x->theta, &x->velocity, &turns, matrix);
  const double a = matrix[0] * deviation[0] + matrix[1] * deviation[1];
  const double b = matrix[2] * deviation[0] + matrix[3] * deviation[1];
  const double length = hypot(a, b);
  deviation[0] = a / length;
  deviation[1] = b / length;
  return log(length);
}

void kz_exponent_along(const kz_model *model, int64_t periods, kz_state start, double *mean, double *error) {
  double deviation[2] = {1, 0}, block[BLOCKS] = {0}, total = 0, square = 0;
  const int64_t length = periods / BLOCKS; /* what does not fill the blocks comes first and is left out */
  for (int64_t i = 0; i < periods - BLOCKS * length; i++) growth(model, &start, deviation);
  for (int64_t i = 0; i < BLOCKS * length; i++) block[i / length] += growth(model, &start, deviation) / (double)length;
  for (int i = 0; i < BLOCKS; i++) total += block[i] / BLOCKS;
  for (int i = 0; i < BLOCKS; i++) square += (block[i] - total) * (block[i] - total);
  *mean = length > 0 ? total : NAN;
  *error = length > 0 ? sqrt(square / (BLOCKS * (BLOCKS - 1))) : NAN;
}

bool kz_exponent_positive(double mean, double error) {
  return mean > 0 && mean > CONFIDENCE * error;
}

bool kz_exponent_stays_positive(const kz_model *model, kz_state start, double mean) {
  double later, error, periods = fmax(LEAST_PERIODS, ceil(2 * ESCAPE / mean));
  if (!(periods <= MOST_PERIODS)) return false;
  kz_exponent_along(model, (int64_t)periods, start, &later, &error);
  return kz_exponent_positive(later, error) && later * periods > ESCAPE;
}
