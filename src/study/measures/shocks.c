/* Measures of sudden changes of the state: the smallest that leave the basin, over all strobe points of an attractor,
 * and how many of a size do not (src/study/resilience). */
#include "measures.h"

/* The smallest shock of a kind: 0 of the angle, 1 of the velocity, 2 of both. */
static void shocks_smallest(const kz_measured *measured, int kind, double *value) {
  for (int64_t id = 0; id < measured->catalogue.count; id++) value[id] = NAN;
  for (int64_t i = 0; i < measured->n_points; i++) {
    double *least = value + measured->catalogue.id_of[measured->point[i].number];
    *least = fmin(*least, measured->point[i].shock[kind].size); /* fmin of a number and NaN is the number */
  }
}

void kz_measure_shock_angle(const kz_measured *measured, double *value) {
  shocks_smallest(measured, 0, value);
}

void kz_measure_shock_velocity(const kz_measured *measured, double *value) {
  shocks_smallest(measured, 1, value);
}

void kz_measure_shock(const kz_measured *measured, double *value) {
  shocks_smallest(measured, 2, value);
}

/* The mean over the strobe points. */
void kz_measure_harmless(const kz_measured *measured, double *value) {
  const int64_t sizes = measured->plan->options.sizes.count;
  for (int64_t i = 0; i < measured->catalogue.count * sizes; i++)
    value[i] = measured->catalogue.entries[i / sizes].row.period > 0 ? 0 : NAN;
  for (int64_t i = 0; i < measured->n_points; i++) {
    const int64_t id = measured->catalogue.id_of[measured->point[i].number];
    for (int64_t size = 0; size < sizes; size++) {
      const kz_harmless *one = measured->point[i].harmless + size;
      value[id * sizes + size] +=
          (double)one->harmless / (double)one->shocks / measured->catalogue.entries[id].row.period;
    }
  }
}
