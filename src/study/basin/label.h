/* Labels of the cells of a window, tile by tile; the rank that labels a tile keeps it, packed. */
#ifndef KAPITZA_STUDY_LABEL_H
#define KAPITZA_STUDY_LABEL_H

#include "attractors/search.h"
#include "tiles.h"
#include "window/starts.h"

/* How a label was found: the values of the file's variable `evidence`. From KZ_UNDECIDED on the scene's own numerics did not decide it. The
 * values KZ_PROVED, KZ_PROVED_IN_PAIRS and KZ_PROVED_IN_QUADS are from basin.proof with any method; they occur in the file only, not in
 * tiles. KZ_LEFT is a doubtful label of method direct. */
enum {
  KZ_UNSETTLED = 0,
  KZ_INSIDE = 1,
  KZ_FOLLOWED = 2,
  KZ_UNDECIDED = 3,
  KZ_IN_QUAD = 4,
  KZ_IN_PAIRS = 5,
  KZ_PROVED = 6,
  KZ_IN_FINE = 7,
  KZ_IN_ARBITRARY = 8,
  KZ_LEFT = 9,
  KZ_PROVED_IN_PAIRS = 10,
  KZ_PROVED_IN_QUADS = 11
};

/* A cell. */
typedef struct {
  uint32_t periods;
  int16_t label;    /* number of kz_dynamics, 0 = not settled, KZ_DOUBTFUL until a level decides it */
  int16_t other;    /* of an undecided cell: the second candidate, 0 = none */
  uint8_t evidence; /* from KZ_FOLLOWED on */
  uint8_t proof;    /* KZ_PROVED, ..._IN_PAIRS, ..._IN_QUADS, 0 = not proved */
  uint8_t proved;   /* number of the attractor, in kz_dynamics, on which it is proved to end */
  uint8_t unused;   /* 0 */
} kz_cell_label;

typedef struct kz_workspace kz_workspace;

typedef struct {
  const kz_basin_plan *plan;
  const kz_pendulum *pendulum;
  kz_dynamics *dynamics;
  kz_search search; /* of the starts */
  kz_tiles tiles;
  kz_images *images;       /* for a window by centre and width with method exact; else NULL */
  kz_window_starts starts; /* of all cells */
  int64_t batch;           /* cells that are followed together */
  const kz_run *run;
  kz_workspace *work;       /* of this rank */
  kz_cell_label *cell;      /* [kz_tile_capacity] a tile, unpacked */
  kz_local_records records; /* tiles of this rank, packed */
  int before_level;         /* the level at which the cells of the present stage were doubtful */
  int level;                /* of the present stage; KZ_LEVELS: it looks for candidates of undecided cells */
  int16_t wanted;           /* label of the pending cells: 0 or KZ_DOUBTFUL */
  int64_t *before;          /* [own tiles + 1]: number of pending cells in all tiles before */
  int64_t n_pending;        /* number of pending cells that the present stage labels again */
  const int64_t *pending;   /* [n_pending]: their numbers */
  int64_t *reached;         /* [INT16_MAX + 1]: number of starts and tiles that ended on each attractor */
} kz_window_labels;

/* Finds the attractors and labels all cells but mirror images. Out: `records`, the tiles of this rank; `reached`, of all ranks. The caller
 * frees *labelling in every case. Collective. */
kz_status kz_label_window(kz_window_labels *labelling);
void kz_window_labels_free(kz_window_labels *labelling);

/* Unpacks the labelled cells of a tile into labelling->cell. */
kz_status kz_tile_labels_unpack(kz_window_labels *labelling, const kz_local_record *kept);

#endif
