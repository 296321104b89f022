/* Intermingledness of the basins (Attractors.jl, function intermingledness): the mean distance of two starts of the
 * same basin, over that of a start of it and one of another basin. 1 = as near to each other as to the others.
 * Distances have the norm hypot(dtheta, dvelocity / shock_scale), with dtheta around the circle. */
#include "measures.h"

/* mean [attractors][attractors] of the distances. */
static void mean_distances(const kz_measured *measured, double *mean) {
  const kz_ended *ended = &measured->starts;
  const double scale = measured->plan->options.shock_scale;
  const int64_t n = measured->catalogue.count;
  KZ_AUTOFREE int64_t *hits = kz_calloc((size_t)n + 1, sizeof *hits);
  for (int64_t i = 0; i < n * n; i++) mean[i] = 0;
  for (int64_t i = 0; i < ended->n; i++) {
    if (ended->id[i] < 0) continue;
    hits[ended->id[i]]++;
    for (int64_t j = 0; j < i; j++) {
      if (ended->id[j] < 0) continue;
      const double theta = remainder(ended->start[2 * i] - ended->start[2 * j], 2 * M_PI);
      const double distance = hypot(theta, (ended->start[2 * i + 1] - ended->start[2 * j + 1]) / scale);
      mean[ended->id[i] * n + ended->id[j]] += distance;
      mean[ended->id[j] * n + ended->id[i]] += distance;
    }
  }
  for (int64_t i = 0; i < n * n; i++) {
    const int64_t pairs = hits[i / n] * hits[i % n];
    mean[i] = pairs > 0 ? mean[i] / (double)pairs : NAN;
  }
}

void kz_measure_intermingled_with(const kz_measured *measured, double *value) {
  const int64_t n = measured->catalogue.count;
  KZ_AUTOFREE double *mean = kz_malloc((size_t)(n * n) * sizeof *mean + 1);
  mean_distances(measured, mean);
  for (int64_t i = 0; i < n * n; i++) value[i] = isgreater(mean[i], 0) ? mean[i / n * n + i / n] / mean[i] : NAN;
}

/* The mean over the other basins. */
void kz_measure_intermingledness(const kz_measured *measured, double *value) {
  const int64_t n = measured->catalogue.count;
  KZ_AUTOFREE double *with = kz_malloc((size_t)(n * n) * sizeof *with + 1);
  kz_measure_intermingled_with(measured, with);
  for (int64_t id = 0; id < n; id++) {
    double sum = 0;
    int64_t others = 0;
    for (int64_t other = 0; other < n; other++) {
      if (other == id || isnan(with[id * n + other])) continue;
      sum += with[id * n + other];
      others++;
    }
    value[id] = others > 0 ? sum / (double)others : NAN;
  }
}
