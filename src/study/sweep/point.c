/* A point of a branch: of an attractor, mirrored, beside another one. */
#include <math.h>
#include <stdlib.h>

#include "sweep.h"

kz_attractor kz_branch_point_mirrored(kz_attractor point) {
  point.theta = -point.theta;
  point.velocity = -point.velocity;
  point.winding = -point.winding;
  return point;
}

double kz_branch_points_apart(const kz_attractor *a, const kz_attractor *b) {
  return fabs(remainder(a->theta - b->theta, 2 * M_PI)) + fabs(a->velocity - b->velocity);
}

int kz_branch_points_order(const kz_attractor *p, const kz_attractor *q) {
  const double keys[][2] = {{p->centre, q->centre},
                            {p->period > 0 ? p->period : INFINITY, q->period > 0 ? q->period : INFINITY},
                            {abs(p->winding) / fmax(p->period, 1), abs(q->winding) / fmax(q->period, 1)},
                            {-p->winding, -q->winding}};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (keys[i][0] != keys[i][1]) return keys[i][0] < keys[i][1] ? -1 : 1;
  return 0;
}
