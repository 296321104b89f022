/* The path of a sweep; a point of a branch beside another one. */
#include "sweep.h"

static bool pendulum_of_scene(const void *context, double value, kz_pendulum *pendulum) {
  return kz_sweep_pendulum(context, value, pendulum);
}

kz_path kz_sweep_path(const kz_scene *scene, int64_t from, int64_t to, kz_fine_maps *maps) {
  return (kz_path){pendulum_of_scene, scene, kz_sweep_value(scene->sweep, from), kz_sweep_value(scene->sweep, to),
                   maps};
}

bool kz_branch_alike(const kz_attractor *a, const kz_attractor *b) {
  return a->period == b->period && a->winding == b->winding;
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
