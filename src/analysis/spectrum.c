/* Lines of an orbit. A closed orbit, sampled over exactly its period, needs no window: its lines are exact. */
#include <fftw3.h>
#include <math.h>

#include "kapitza/analysis.h"

/* Four-term Blackman-Harris window at sample i of n. */
static double window(int64_t i, int64_t n) {
  static const double weight[4] = {0.35875, -0.48829, 0.14128, -0.01168};
  double x = 2 * M_PI * (double)i / (double)n, sum = 0;
  for (int j = 0; j < 4; j++) sum += weight[j] * cos(j * x);
  return sum;
}

static int64_t samples(const kz_record *record) {
  return record->periods * record->samples_per_period;
}

double kz_spectrum_rotation(const kz_record *record, const double *theta) {
  int64_t n = samples(record);
  double moment = 0, spread = 0;
  for (int64_t i = 0; i < n; i++) {
    double weight = window(i, n), t = (double)i - 0.5 * (double)n;
    moment += weight * t * (theta[i] - theta[n / 2]);
    spread += weight * t * t;
  }
  return moment / spread * (double)record->samples_per_period / (2 * M_PI);
}

/* The weighted deviation from the steady turn, less its mean. Returns the mean; `total` is the sum of the weights. */
static double fill_deviation(const kz_record *record, const double *theta, double *deviation, double *total) {
  int64_t n = samples(record);
  double turn = 2 * M_PI * record->rotation / (double)record->samples_per_period, mean = 0;
  *total = 0;
  for (int64_t i = 0; i < n; i++) {
    double weight = record->closed ? 1 : window(i, n);
    deviation[i] = theta[i] - record->centre - turn * (double)i;
    mean += weight * deviation[i];
    *total += weight;
  }
  mean /= *total;
  for (int64_t i = 0; i < n; i++) deviation[i] = (deviation[i] - mean) * (record->closed ? 1 : window(i, n));
  return mean;
}

static double line_phase(double amplitude, double re, double im) {
  if (amplitude < KZ_LINE_FLOOR) return NAN;
  double phase = atan2(im, re);
  return phase == -M_PI ? M_PI : phase;
}

static void read_lines(const fftw_complex *bin, double total, double a0, int64_t n_lines, double *amplitude, double *phase) {
  amplitude[0] = fabs(a0);
  phase[0] = line_phase(amplitude[0], a0, 0);
  for (int64_t j = 1; j < n_lines; j++) {
    amplitude[j] = 2 * hypot(bin[j][0], bin[j][1]) / total;
    phase[j] = line_phase(amplitude[j], bin[j][0], bin[j][1]);
  }
}

kz_status kz_spectrum_lines(const kz_record *record, const double *theta, int64_t n_lines, double *amplitude, double *phase) {
  int64_t n = samples(record);
  if (n < 2 || n > INT32_MAX || 2 * n_lines > n)
    return kz_fail(KZ_REFUSED, "%lld lines cannot be read from %lld samples", (long long)n_lines, (long long)n);
  double *deviation = fftw_alloc_real((size_t)n);
  fftw_complex *bin = fftw_alloc_complex((size_t)n / 2 + 1);
  fftw_plan plan = deviation && bin ? fftw_plan_dft_r2c_1d((int)n, deviation, bin, FFTW_ESTIMATE) : NULL;
  bool done = plan != NULL;
  if (done) {
    double total, mean = fill_deviation(record, theta, deviation, &total);
    fftw_execute(plan);
    read_lines(bin, total, record->velocity ? mean : remainder(mean, 2 * M_PI), n_lines, amplitude, phase);
    fftw_destroy_plan(plan);
  }
  fftw_free(deviation);
  fftw_free(bin);
  return done ? KZ_OK : kz_fail(KZ_FAILED, "no memory for a spectrum of %lld samples", (long long)n);
}
