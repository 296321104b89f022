/* Reference labels: the labels of random cells of a scene's window, followed in quad precision into the trapping
 * regions of one fixed, fine dynamics (split6 in double precision), whatever the scene's numerics. Other labels are
 * compared with these. */
#pragma once

#include "kapitza/dynamics_labels.h"
#include "kapitza/study.h"

enum {
  KZ_REFERENCE_FAR = 128 /* distance of a cell if all cells up to 64 cells away have the same label */
};

/* The reference label of one cell; labels are numbers of its attractors from 1, 0 = not settled within max_periods. */
typedef struct {
  kz_label end;     /* Label and periods of the cell's start */
  int16_t flipped;  /* Label of a start that is larger by one unit in the last place, in angle and velocity */
  uint8_t distance; /* cells along an axis to a different label, a power of two; KZ_REFERENCE_FAR = none found */
  uint8_t agrees;   /* 1 = another number of steps gave the same label, 0 = it gave another one, 2 = not tried */
} kz_reference_label;

typedef struct {
  const kz_basin_plan *plan;
  kz_pendulum pendulum;
  kz_kept_series *series; /* Series of the scene */
  int64_t total;          /* cells of the window */
  int64_t samples;        /* number of cells with a reference label: the first ones in the order of kz_shuffled */
  double max_velocity;    /* Largest speed, kz_dynamics_max_velocity */
  int64_t packed_size;
  double *packed;             /* the attractors, for kz_dynamics_unpack */
  kz_reference_label *labels; /* [samples] */
} kz_reference_labels;

/* Makes the reference labels of a damped scene's basin, of at most `samples` cells, on every rank. `path` (rank 0; NULL
 * = none) names the cache: labels of the same sample that it holds are not computed again. The stage is kept by a
 * checkpoint. Collective. */
kz_status kz_reference_labels_make(const kz_scene *scene, const kz_run *run, int64_t samples, const char *path,
                                   kz_reference_labels *reference);
/* Writes the cache if there are more labels than it has. Rank 0. */
kz_status kz_reference_labels_save(const kz_reference_labels *reference, const char *path);
void kz_reference_labels_free(kz_reference_labels *reference);

/* Reads labels from a cache that was made for the same pendulum, window, seed, limit and attractors: at most
 * reference->samples, into reference->labels. Returns their number; 0 for a missing, damaged or foreign cache. */
int64_t kz_reference_labels_recall(const char *path, kz_reference_labels *reference);

/* Finds steps accurate enough for reference labels at every speed of the window; KZ_REFUSED if there are none. */
kz_status kz_reference_labels_numerics(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_numerics *numerics);

/* Cell i in the order of the sample. */
int64_t kz_reference_labels_cell(const kz_reference_labels *reference, int64_t i);

/* Cells whose label the last place of the start changes; cells whose label another number of steps changes, of those
 * tried (asked); and the mean number of periods followed. */
typedef struct {
  int64_t flipped, disagree, asked;
  double mean_periods;
} kz_reference_labels_summary;
kz_reference_labels_summary kz_reference_labels_sum(const kz_reference_labels *reference);
