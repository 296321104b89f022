/* Properties of an orbit from its lines: the dominant line, the period, the symmetry. */
#include <math.h>

#include "kapitza/analysis.h"

/* Lines below this share of the largest one are ignored: of closed orbits, of open records. */
static const double MATTERS_CLOSED = 1e-9, MATTERS_OPEN = 1e-3;
/* A peak of an open record is trusted to this many bins. */
static const double PEAK_TOLERANCE = 0.03;
/* The window spreads a line over eight bins: multiples of 1/n must lie at least so far apart. */
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
  double least = least_line(n_lines, amplitude, MATTERS_CLOSED);
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

/* Where the top of a peak lies, in bins: a parabola through the logarithms. */
static double peak_top(const double *amplitude, int64_t j) {
  double a = log(amplitude[j - 1]), b = log(amplitude[j]), c = log(amplitude[j + 1]);
  return (double)j + 0.5 * (a - c) / (a - 2 * b + c);
}

static bool is_multiple(double x, double unit) {
  return fabs(remainder(x, unit)) <= PEAK_TOLERANCE;
}

static bool peaks_fit(const kz_record *record, int64_t n_lines, const double *amplitude, int64_t n) {
  double least = least_line(n_lines, amplitude, MATTERS_OPEN), unit = (double)record->periods / (double)n;
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
  double least = at_rest ? KZ_LINE_FLOOR : least_line(n_lines, amplitude, MATTERS_CLOSED);
  bool centred = fabs(sin(amplitude[0])) <= least;
  if (at_rest || !centred || record->periods % 2 != 0) return at_rest && centred;
  for (int64_t j = 2; j < n_lines; j += 2) {
    if (amplitude[j] > least) return false;
  }
  return true;
}
