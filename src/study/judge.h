/* What labels are judged by: the true labels of random cells of a scene's window, followed in quad precision into the trapping
 * regions of one fixed, fine dynamics (split6 in double precision, 1000 x 1000 nodes), whatever the scene's numerics. */
#ifndef KAPITZA_STUDY_JUDGE_H
#define KAPITZA_STUDY_JUDGE_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

enum {
  KZ_JUDGE_FAR = 128 /* distance of a cell whose neighbours agree up to 64 cells away */
};

/* The verdict on one cell; labels are numbers of the judge's attractors from 1, 0 = not settled within max_periods. */
typedef struct {
  int16_t label;    /* the truth */
  int16_t flipped;  /* the truth of a start one unit in the last place farther out, in angle and velocity */
  uint8_t distance; /* cells along an axis to a different label, a power of two; KZ_JUDGE_FAR = none seen */
  uint8_t agrees;   /* 1 = another number of steps gave the same label, 0 = it did not, 2 = not asked */
  uint32_t periods; /* that the truth was followed */
} kz_verdict;

typedef struct {
  const kz_basin_plan *plan;
  kz_pendulum pendulum;
  int64_t total;   /* cells of the window */
  int64_t samples; /* cells with a verdict: the first of kz_shuffled */
  double reach;    /* of kz_dynamics_reach */
  int64_t packed_size;
  double *packed;       /* the attractors, for kz_dynamics_unpack */
  kz_verdict *verdicts; /* [samples] */
} kz_judge;

/* Makes the judge of a damped scene's basin from at most `samples` cells, on every rank. `path` (rank 0; NULL = none) names the
 * cache: what it holds of this very sample is not computed again. Its stage is kept by a checkpoint. Collective. */
kz_status kz_judge_make(const kz_scene *scene, kz_team *team, int64_t samples, const char *path, kz_judge *judge);
/* Writes the cache, where it would hold more than it does. Rank 0. */
kz_status kz_judge_save(const kz_judge *judge, const char *path);
void kz_judge_free(kz_judge *judge);

/* The verdicts of a cache that was made for the same pendulum, window, seed, limit and attractors: as many as there are and at
 * most judge->samples, into judge->verdicts; returns how many. A missing, damaged or foreign cache gives 0. */
int64_t kz_judge_recall(const char *path, kz_judge *judge);

/* Steps that carry every speed of the window well enough to judge labels. KZ_REFUSED where they are not to be had. */
kz_status kz_judge_numerics(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_numerics *numerics);

/* Cell i of the judge's order. */
int64_t kz_judge_cell(const kz_judge *judge, int64_t i);

/* Cells flipped by the last place of the start, cells where the step counts disagree, and the mean periods of the truth. */
typedef struct {
  int64_t flipped, disagree, asked;
  double mean_periods;
} kz_judge_summary;
kz_judge_summary kz_judge_sum(const kz_judge *judge);

#endif
