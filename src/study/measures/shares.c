/* Measures of starts: shares with their intervals, and settling times. */
#include "measures.h"
#include "numerics/share.h"

/* The share of the starts that end on each attractor after at most `most` periods. */
static void shares_measure(const kz_measured *measured, const kz_ended *ended, uint32_t most, double *value) {
  const int64_t n = measured->catalogue.count;
  for (int64_t id = 0; id < n; id++) {
    int64_t hits = 0;
    for (int64_t i = 0; i < ended->n; i++) hits += ended->id[i] == id && ended->time[i] <= most;
    const kz_share share = kz_share_of(hits, ended->n);
    value[id] = share.share;
    value[n + id] = share.low;
    value[2 * n + id] = share.high;
  }
}

void kz_measure_share(const kz_measured *measured, double *value) {
  shares_measure(measured, &measured->starts, UINT32_MAX, value);
}

void kz_measure_weighted_share(const kz_measured *measured, double *value) {
  shares_measure(measured, &measured->weighted, UINT32_MAX, value);
}

void kz_measure_share_within(const kz_measured *measured, double *value) {
  shares_measure(measured, &measured->starts, (uint32_t)measured->plan->options.within, value);
}

static int shares_before(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The mean of the two middle times, or the middle one. */
void kz_measure_settling_median(const kz_measured *measured, double *value) {
  const kz_ended *ended = &measured->starts;
  KZ_AUTOFREE double *time = kz_malloc((size_t)ended->n * sizeof *time + 1);
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    int64_t hits = 0;
    for (int64_t i = 0; i < ended->n; i++)
      if (ended->id[i] == id) time[hits++] = ended->time[i];
    qsort(time, (size_t)hits, sizeof *time, shares_before);
    value[id] = hits > 0 ? (time[(hits - 1) / 2] + time[hits / 2]) / 2 : NAN;
  }
}

void kz_measure_settling_largest(const kz_measured *measured, double *value) {
  const kz_ended *ended = &measured->starts;
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    value[id] = NAN;
    for (int64_t i = 0; i < ended->n; i++)
      if (ended->id[i] == id) value[id] = fmax(value[id], ended->time[i]); /* fmax of a number and NaN is the number */
  }
}

/* The distance of a start from the nearest strobe point of an attractor; NaN if it has none. */
static double distance_of(const kz_measured *measured, const double start[2], const kz_entry *entry) {
  double least = NAN;
  for (int32_t phase = 0; phase < entry->row.period; phase++) {
    const double theta = remainder(start[0] - entry->theta[phase], 2 * M_PI);
    least = fmin(least, hypot(theta, (start[1] - entry->velocity[phase]) / measured->plan->options.shock_scale));
  }
  return least;
}

/* Mean settling time of the starts of each attractor, each divided by its distance if `per_distance`. */
static void mean_times(const kz_measured *measured, bool per_distance, double *value) {
  const kz_ended *ended = &measured->starts;
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    const kz_entry *entry = measured->catalogue.entries + id;
    double sum = 0;
    int64_t hits = 0;
    for (int64_t i = 0; i < ended->n; i++) {
      if (ended->id[i] != id) continue;
      const double distance = per_distance ? distance_of(measured, ended->start + 2 * i, entry) : 1;
      sum += distance == 0 ? 0 : ended->time[i] / distance; /* a start on a strobe point has settled */
      hits++;
    }
    value[id] = hits > 0 ? sum / (double)hits : NAN;
  }
}

void kz_measure_settling_mean(const kz_measured *measured, double *value) {
  mean_times(measured, false, value);
}

void kz_measure_settling_pace(const kz_measured *measured, double *value) {
  mean_times(measured, true, value);
}
