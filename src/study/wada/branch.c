/* Where the points of a branch of an unstable manifold end. */
#include <math.h>
#include <stdlib.h>

#include "labelling/labeller.h"
#include "wada.h"

/* rad: bound of the distance of a computed point from the manifold, which shrinks along it; docs/explanation/wada.md. */
static const double OFF = 1e-11;
/* rad: nearer to the cycle, points are not labelled, because OFF counts there; the others contain their images. */
static const double BESIDE = 1e-6;

/* A kz_start_fn: the items are points of a branch, with their error. */
static kz_status start_of_point(void *context, int64_t item, int32_t level, kz_start *start) {
  const double *point = (const double *)context + 4 * item;
  (void)level;
  *start = kz_start_at(point[0], point[1]);
  start->error[0] = start->error[2] = OFF * OFF;
  return KZ_OK;
}

/* Whether all points end on one attractor, and the last one is in its trapping region. */
static bool is_followed(int64_t n, const kz_label *label) {
  if (n < 1 || label[n - 1].label <= 0 || label[n - 1].periods > 0) return false;
  for (int64_t i = 0; i < n; i++)
    if (label[i].label != label[n - 1].label) return false;
  return true;
}

/* Of each basin the point that settles first. */
static void find_witnesses(const kz_file_attractors *attractors, int64_t n, const double *point, const kz_label *label,
                           kz_witness *witness) {
  for (int64_t i = 0; i < attractors->count; i++) witness[i] = (kz_witness){NAN, NAN, NAN, NAN};
  for (int64_t i = 0; i < n; i++) {
    const int32_t id = label[i].label > 0 ? attractors->id[label[i].label] : -1;
    if (id < 0 || label[i].periods >= witness[id].periods) continue;
    const double *at = point + 4 * i;
    witness[id] = (kz_witness){at[0], at[1], at[2], label[i].periods};
  }
}

kz_status kz_branch_basins_find(const kz_wada_job *job, const kz_branch *branch, kz_branch_basins *basins) {
  KZ_FREED double *all = kz_malloc(4 * KZ_BRANCH_POINTS * sizeof *all);
  double *point = all;
  KZ_FREED kz_label *label = kz_calloc(KZ_BRANCH_POINTS, sizeof *label);
  int64_t n = kz_manifold_grow(&job->scene->parameters.pendulum, branch, KZ_BRANCH_POINTS, point);
  for (; n > 0 && point[2] < BESIDE; n--) point += 4;
  const kz_labeller labeller = {job->dynamics, job->max_periods, KZ_BY_LEVELS,    KZ_OPEN_DOUBTFUL,
                                true,          start_of_point,   .context = point};
  KZ_TRY(kz_label_first(&labeller, n, NULL, label));
  basins->followed = is_followed(n, label);
  find_witnesses(job->attractors, n, point, label, basins->witness);
  return KZ_OK;
}
