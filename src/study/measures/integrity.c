/* Integrity of basins (M. S. Soliman, J. M. T. Thompson, J. Sound Vib. 135 (1989) 453; G. Rega, S. Lenci, Nonlinear
 * Anal. 63 (2005) 902), from the picture, in the norm hypot(dtheta, dvelocity / shock_scale). */
#include "measures.h"
#include "picture.h"

static kz_picture picture_of(const kz_measured *measured) {
  const kz_measures_plan *plan = measured->plan;
  const double cells = (double)plan->options.cells;
  return (kz_picture){.columns = plan->options.cells,
                      .rows = plan->options.cells,
                      .across = (plan->theta.max - plan->theta.min) / cells,
                      .up = (plan->velocity.max - plan->velocity.min) / cells / plan->options.shock_scale,
                      .circle = kz_axis_is_circle(&plan->theta),
                      .id = measured->picture.id};
}

/* The radius of the largest circle about a state that holds no centre of a foreign cell, less half of a cell, and no
 * place beyond the picture; NaN if the state lies there. */
static double integrity_clearance(const kz_measured *measured, const kz_picture *picture, int64_t id, double theta,
                                  double velocity) {
  const kz_measures_plan *plan = measured->plan;
  const double scale = plan->options.shock_scale, half = fmin(picture->across, picture->up) / 2;
  const double x = theta - 2 * M_PI * floor((theta - plan->theta.min) / (2 * M_PI)) - plan->theta.min;
  const double y = (velocity - plan->velocity.min) / scale;
  const double width = (double)picture->columns * picture->across, height = (double)picture->rows * picture->up;
  double least = fmin(y, height - y);
  if (!picture->circle) least = fmin(least, fmin(x, width - x));
  if (least < 0) return NAN;
  for (int64_t i = 0; i < measured->picture.n; i++) {
    if (picture->id[i] == id) continue;
    double away = fabs(((double)(i % picture->columns) + 0.5) * picture->across - x);
    if (picture->circle) away = fmin(away, width - away);
    least = fmin(least, hypot(away, ((double)(i / picture->columns) + 0.5) * picture->up - y) - half);
  }
  return fmax(least, 0);
}

/* Smallest radius of the largest circles inside the basin about strobe points; NaN if one is off the picture. */
void kz_measure_integrity_local(const kz_measured *measured, double *value) {
  const kz_picture picture = picture_of(measured);
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    const kz_entry *entry = measured->catalogue.entries + id;
    value[id] = entry->row.period > 0 ? INFINITY : NAN;
    for (int32_t phase = 0; phase < entry->row.period; phase++) {
      const double radius = integrity_clearance(measured, &picture, id, entry->theta[phase], entry->velocity[phase]);
      value[id] = isnan(radius) || isnan(value[id]) ? NAN : fmin(value[id], radius);
    }
  }
}

/* The radius of the largest circle inside the basin, wherever it lies in the picture. */
void kz_measure_integrity_factor(const kz_measured *measured, double *value) {
  const kz_picture picture = picture_of(measured);
  KZ_AUTOFREE double *distance = kz_malloc((size_t)measured->picture.n * sizeof *distance);
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    value[id] = 0;
    kz_picture_distances(&picture, (int16_t)id, distance);
    for (int64_t i = 0; i < measured->picture.n; i++) value[id] = fmax(value[id], distance[i]);
  }
}

/* The area of the basin in the picture. */
void kz_measure_integrity_global(const kz_measured *measured, double *value) {
  const kz_picture picture = picture_of(measured);
  for (int64_t id = 0; id < measured->catalogue.count; id++) {
    int64_t cells = 0;
    for (int64_t i = 0; i < measured->picture.n; i++) cells += measured->picture.id[i] == id;
    value[id] = (double)cells * picture.across * picture.up * measured->plan->options.shock_scale;
  }
}
