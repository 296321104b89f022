/* Lines of an orbit, and from them the dominant line, the period, the symmetry. A closed orbit, sampled over exactly
 * its period, needs no window. */
#include <fftw3.h>

#include "kapitza/analysis.h"

/* Four-term Blackman-Harris window at sample i of n. */
static double window_at(int64_t i, int64_t n) {
  static const double weight[4] = {0.35875, -0.48829, 0.14128, -0.01168};
  double x = 2 * M_PI * (double)i / (double)n, sum = 0;
  for (int j = 0; j < 4; j++) sum += weight[j] * cos(j * x);
  return sum;
}

static int64_t sample_count(const kz_record *record) {
  return record->periods * record->samples_per_period;
}

double kz_spectrum_rotation(const kz_record *record, const double *theta) {
  int64_t n = sample_count(record);
  double moment = 0, spread = 0;
  for (int64_t i = 0; i < n; i++) {
    double weight = window_at(i, n), t = (double)i - 0.5 * (double)n;
    moment += weight * t * (theta[i] - theta[n / 2]);
    spread += weight * t * t;
  }
  return moment / spread * (double)record->samples_per_period / (2 * M_PI);
}

/* Fills in the weighted deviation from steady rotation, less its mean, which it returns; `total`: sum of weights. */
static double fill_deviation(const kz_record *record, const double *theta, double *deviation, double *total) {
  int64_t n = sample_count(record);
  double turn = 2 * M_PI * record->rotation / (double)record->samples_per_period, mean = 0;
  *total = 0;
  for (int64_t i = 0; i < n; i++) {
    double weight = record->closed ? 1 : window_at(i, n);
    deviation[i] = theta[i] - record->centre - turn * (double)i;
    mean += weight * deviation[i];
    *total += weight;
  }
  mean /= *total;
  for (int64_t i = 0; i < n; i++) deviation[i] = (deviation[i] - mean) * (record->closed ? 1 : window_at(i, n));
  return mean;
}

static double line_phase(double amplitude, double re, double im) {
  if (amplitude < KZ_LINE_FLOOR) return NAN;
  double phase = atan2(im, re);
  return phase == -M_PI ? M_PI : phase;
}

static void read_lines(const fftw_complex *bin, double total, double a0, int64_t n_lines, double *amplitude,
                       double *phase) {
  amplitude[0] = fabs(a0);
  phase[0] = line_phase(amplitude[0], a0, 0);
  for (int64_t j = 1; j < n_lines; j++) {
    amplitude[j] = 2 * hypot(bin[j][0], bin[j][1]) / total;
    phase[j] = line_phase(amplitude[j], bin[j][0], bin[j][1]);
  }
}

kz_status kz_spectrum_lines(const kz_record *record, const double *theta, int64_t n_lines, double *amplitude,
                            double *phase) {
  int64_t n = sample_count(record);
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

/* ---- properties of orbits from their lines ---- */

/* Share of the largest line below which lines are ignored, of closed orbits and of open records. */
static const double RELEVANT_CLOSED = 1e-9, RELEVANT_OPEN = 1e-3;
/* Error of the place of a peak of an open record, bins. */
static const double PEAK_TOLERANCE = 0.03;
/* Bins over which the window spreads a line, the least distance of multiples of 1/n. */
static const int64_t WINDOW_BINS = 8;

int64_t kz_spectrum_dominant(int64_t n_lines, const double *amplitude) {
  int64_t dominant = 0;
  for (int64_t j = 1; j < n_lines; j++) {
    if (amplitude[j] >= KZ_LINE_FLOOR && (dominant == 0 || amplitude[j] > amplitude[dominant])) dominant = j;
  }
  return dominant;
}

/* Amplitude below which lines are ignored; INFINITY at rest, which has no lines. */
static double least_line(int64_t n_lines, const double *amplitude, double share) {
  int64_t dominant = kz_spectrum_dominant(n_lines, amplitude);
  return dominant ? fmax(KZ_LINE_FLOOR, share * amplitude[dominant]) : INFINITY;
}

static int64_t common_divisor(int64_t a, int64_t b) {
  while (b != 0) {
    int64_t rest = a % b;
    a = b;
    b = rest;
  }
  return a < 0 ? -a : a;
}

static int64_t closed_period(const kz_record *record, int64_t n_lines, const double *amplitude) {
  double least = least_line(n_lines, amplitude, RELEVANT_CLOSED);
  int64_t winding = llrint(record->rotation * (double)record->periods);
  int64_t divisor = common_divisor(record->periods, winding);
  for (int64_t j = 1; j < n_lines; j++) {
    if (amplitude[j] > least) divisor = common_divisor(divisor, j);
  }
  return record->periods / divisor;
}

static bool is_peak(const double *amplitude, int64_t j) {
  return amplitude[j] > amplitude[j - 1] && amplitude[j] >= amplitude[j + 1];
}

/* Place of the top of a peak in bins, by a parabola through the logarithms. */
static double peak_top(const double *amplitude, int64_t j) {
  double a = log(amplitude[j - 1]), b = log(amplitude[j]), c = log(amplitude[j + 1]);
  return (double)j + 0.5 * (a - c) / (a - 2 * b + c);
}

static bool is_multiple(double x, double unit) {
  return fabs(remainder(x, unit)) <= PEAK_TOLERANCE;
}

static bool peaks_fit(const kz_record *record, int64_t n_lines, const double *amplitude, int64_t n) {
  double least = least_line(n_lines, amplitude, RELEVANT_OPEN), unit = (double)record->periods / (double)n;
  for (int64_t j = 1; j + 1 < n_lines; j++) {
    if (amplitude[j] <= least || !is_peak(amplitude, j)) continue;
    if (!is_multiple(peak_top(amplitude, j), unit)) return false;
  }
  return true;
}

static int64_t open_period(const kz_record *record, int64_t n_lines, const double *amplitude) {
  double rotation_bins = record->rotation * (double)record->periods;
  for (int64_t n = 1; n * WINDOW_BINS <= record->periods; n++) {
    bool rotation_fits = is_multiple(rotation_bins, (double)record->periods / (double)n);
    if (rotation_fits && peaks_fit(record, n_lines, amplitude, n)) return n;
  }
  return 0;
}

int64_t kz_spectrum_period(const kz_record *record, int64_t n_lines, const double *amplitude) {
  return record->closed ? closed_period(record, n_lines, amplitude) : open_period(record, n_lines, amplitude);
}

bool kz_spectrum_symmetric(const kz_record *record, int64_t n_lines, const double *amplitude) {
  if (record->rotation != 0) return false;
  bool at_rest = kz_spectrum_dominant(n_lines, amplitude) == 0;
  double least = at_rest ? KZ_LINE_FLOOR : least_line(n_lines, amplitude, RELEVANT_CLOSED);
  bool centred = fabs(sin(amplitude[0])) <= least;
  if (at_rest || !centred) return at_rest && centred;
  for (int64_t j = 2; j < n_lines; j += 2) {
    if (amplitude[j] > least) return false;
  }
  return true;
}
