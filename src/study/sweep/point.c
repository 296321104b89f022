/* A point of a branch: of an attractor, mirrored, beside another one. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sweep.h"

kz_branch_point kz_branch_point_of(const kz_attractor *row, double theta, double velocity) {
  kz_branch_point point = {.theta = row->period > 0 ? theta : row->mean,
                           .velocity = row->period > 0 ? velocity : row->mean_velocity,
                           .amplitude = row->amplitude,
                           .period = row->period,
                           .winding = row->winding,
                           .centre = row->centre,
                           .symmetric = row->symmetric};
  memcpy(point.multiplier_re, row->multiplier_re, sizeof row->multiplier_re);
  memcpy(point.multiplier_im, row->multiplier_im, sizeof row->multiplier_im);
  return point;
}

kz_branch_point kz_branch_point_mirrored(kz_branch_point point) {
  point.theta = -point.theta;
  point.velocity = -point.velocity;
  point.winding = -point.winding;
  return point;
}

double kz_branch_points_apart(const kz_branch_point *a, const kz_branch_point *b) {
  return fabs(remainder(a->theta - b->theta, 2 * M_PI)) + fabs(a->velocity - b->velocity);
}

int kz_branch_points_order(const kz_branch_point *p, const kz_branch_point *q) {
  const double keys[][2] = {{p->centre, q->centre},
                            {p->period > 0 ? p->period : INFINITY, q->period > 0 ? q->period : INFINITY},
                            {abs(p->winding) / fmax(p->period, 1), abs(q->winding) / fmax(q->period, 1)},
                            {-p->winding, -q->winding}};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (keys[i][0] != keys[i][1]) return keys[i][0] < keys[i][1] ? -1 : 1;
  return 0;
}
