/* Study `chart`. */
#ifndef KAPITZA_STUDY_CHART_H
#define KAPITZA_STUDY_CHART_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "plan.h"

enum { KZ_NO_PENDULUM = -2 }; /* in place of a period: no pendulum, or one without damping */

/* ending [n] of start number `place` at n <= KZ_CHART_POINTS points; point [n] = their numbers, x fastest. */
enum { KZ_CHART_POINTS = 256 };
void kz_chart_points(const kz_scene *scene, int64_t place, int64_t n, const int64_t *point, kz_chart_ending *ending);

/* Writes the group /chart and the summary from endings [starts][y][x]. Rank 0. */
kz_status kz_chart_publish(const kz_chart_plan *plan, const kz_chart_ending *endings, kz_store *store, FILE *summary);

/* The velocity of start number `place`, rad per drive radian. */
static inline double kz_chart_velocity(const kz_chart_plan *plan, int64_t place) {
  return plan->velocity.values[plan->velocity.count == 1 ? 0 : place];
}

#endif
