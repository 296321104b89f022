/* Study `wada`: the list of attractors of the file, and the basins that a branch of an unstable manifold meets. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "manifolds/plan.h"
#include "plan.h"

/* The attractors of the file beside those of kz_dynamics. */
typedef struct {
  int64_t count;                 /* of the file */
  int32_t id[INT16_MAX + 1];     /* of attractor `number` of kz_dynamics; -1 = not in the file */
  int32_t mirror[INT16_MAX + 1]; /* id of the mirror image of attractor `id` */
} kz_file_attractors;

/* The basins that one branch meets. */
typedef struct {
  double theta, velocity, arc_length; /* a point of the branch in the basin; NaN = none is known */
  double periods;                     /* until a trapping region holds it */
} kz_witness;
typedef struct {
  double followed;      /* 1 if all points of the branch lie in one basin, the last one in the trapping region; else 0 */
  kz_witness witness[]; /* [count] */
} kz_branch_basins;

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  const kz_file_attractors *attractors;
  int64_t max_periods;
} kz_wada_job;

/* Writes the group wada from the basins of both branches of each cycle, in order, `stride` bytes apart, and prints what they prove. */
kz_status kz_wada_write(int64_t n_saddles, int64_t n_attractors, const void *basins, size_t stride, kz_store *store,
                        FILE *summary);
