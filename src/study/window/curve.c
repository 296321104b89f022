#include "window.h"

#include "numerics/cells.h"

enum { PER_CELL = 16 };
static const double thin = 0.1; /* steps: the width of what counts as a curve */

/* The direction in which a linear map stretches most. */
static void find_direction(const double J[2][2], double along[2]) {
  const double xx = J[0][0] * J[0][0] + J[1][0] * J[1][0], yy = J[0][1] * J[0][1] + J[1][1] * J[1][1];
  const double xy = J[0][0] * J[0][1] + J[1][0] * J[1][1], angle = atan2(2 * xy, xx - yy) / 2;
  along[0] = cos(angle);
  along[1] = sin(angle);
}

/* How far the images of a corner and of its place on the curve lie from each other, over the image of a step. */
static double width_at(const kz_window_curve *c, const double half[2], int corner) {
  const double off[2] = {corner & 1 ? half[0] : -half[0], corner & 2 ? half[1] : -half[1]};
  const double on = c->along[0] * off[0] + c->along[1] * off[1];
  double image[3][2];
  kz_hand_over_change(c->hand_over, c->middle[0] + off[0], c->middle[1] + off[1], image[0]);
  kz_hand_over_change(c->hand_over, c->middle[0] + on * c->along[0], c->middle[1] + on * c->along[1], image[1]);
  const double next = on - copysign(c->step, on);
  kz_hand_over_change(c->hand_over, c->middle[0] + next * c->along[0], c->middle[1] + next * c->along[1], image[2]);
  return hypot(image[0][0] - image[1][0], image[0][1] - image[1][1]) /
         hypot(image[2][0] - image[1][0], image[2][1] - image[1][1]);
}

/* Places of an axis's cells, in steps. */
static double *curve_places(const kz_axis *axis, double along, double scale, double first) {
  double *place = kz_malloc((size_t)axis->count * sizeof *place);
  for (int64_t i = 0; i < axis->count; i++) place[i] = along * scale * kz_axis_share(axis, i) - first;
  return place;
}

void kz_window_curve_make(const kz_window_starts *starts, kz_window_curve *curve) {
  const kz_basin_plan *plan = starts->plan;
  const kz_axis *axes[2] = {&plan->theta, &plan->velocity};
  double scale[2], half[2];
  kz_view view;
  *curve = (kz_window_curve){.columns = plan->theta.count};
  if (!starts->images || !kz_images_serve(starts->images, starts->dynamics, starts->pendulum, axes[0], axes[1], &view))
    return;
  curve->hand_over = starts->hand_over;
  if (curve->hand_over->periods < kz_release_strobes(&starts->images->release)) return;
  find_direction(curve->hand_over->linear, curve->along);
  for (int i = 0; i < 2; i++) {
    scale[i] = (double)view.scale[i];
    half[i] = scale[i] / 2;
    curve->middle[i] = (double)view.offset[i];
    curve->step = fmax(curve->step, fabs(curve->along[i]) * scale[i] / (double)axes[i]->count / PER_CELL);
  }
  for (int corner = 0; corner < 4; corner++)
    if (!(width_at(curve, half, corner) < thin)) return;
  const double farthest = (fabs(curve->along[0]) * half[0] + fabs(curve->along[1]) * half[1]) / curve->step;
  curve->count = 2 * (int64_t)ceil(farthest) + 1;
  curve->column = curve_places(axes[0], curve->along[0] / curve->step, scale[0], -ceil(farthest));
  curve->row = curve_places(axes[1], curve->along[1] / curve->step, scale[1], 0);
}

void kz_window_curve_free(kz_window_curve *curve) {
  free(curve->column);
  free(curve->row);
  *curve = (kz_window_curve){0};
}

int64_t kz_window_curve_sample(const kz_window_curve *curve, int64_t cell) {
  return lrint(curve->column[cell % curve->columns] + curve->row[cell / curve->columns]);
}

void kz_window_curve_state(const kz_window_curve *curve, int64_t sample, double state[2], int64_t *periods) {
  const double at = ((double)sample - (double)(curve->count / 2)) * curve->step;
  kz_start start;
  kz_hand_over_start(curve->hand_over, curve->middle[0] + at * curve->along[0], curve->middle[1] + at * curve->along[1],
                     &start);
  kz_start_state(start.theta[0], start.velocity[0], state);
  *periods = start.periods;
}
