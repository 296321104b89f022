/* Labels of the cells of a window, tile by tile; the rank that labels a tile keeps it, packed. */
#pragma once

#include "numerics/counts.h"
#include "labelling/search.h"
#include "cells/cell_starts.h"
#include "numerics/cells.h"

/* A tile is a number of whole rows of cells, or a part of one row, so its cells are consecutive. If the window is its
 * own mirror image, tile t is the mirror image of tile n - 1 - t. */
typedef struct {
  int64_t rows, columns; /* Cells of the window */
  int64_t chunk[2];      /* cells of a tile along velocity and theta; the last ones may reach beyond the window */
  int64_t across;        /* tiles along theta */
  int64_t n, own;        /* tiles of the window; the first `own` of them are labelled, the others are mirror images */
  int64_t cells, unique_cells;
  bool whole; /* no box and no row extends over two tiles */
} kz_tiles;

/* The tiles of a scene's basin, of about `target` cells each; they depend on the scene only. */
kz_tiles kz_tiles_of(const kz_scene *scene, int64_t target);
/* Number of the first cell of a tile, and its number of cells within the window. */
int64_t kz_tile_first(const kz_tiles *tiles, int64_t tile);
int64_t kz_tile_count(const kz_tiles *tiles, int64_t tile);
/* How many of its cells are labelled: all, but half of the tile in the middle, which is its own mirror image. */
int64_t kz_tile_own(const kz_tiles *tiles, int64_t tile);
/* Number of cells of a chunk. */
int64_t kz_tile_capacity(const kz_tiles *tiles);

typedef struct kz_window_labels kz_window_labels;
/* ---- parts that other folders add: rows of kz_studies with `of_basin`, whose work the basin's run does ---- */

typedef struct kz_chunks kz_chunks;
struct kz_basin_part {
  /* Bytes of memory that it takes on a rank. Every function may be NULL. */
  double (*bytes)(const kz_scene *scene);
  /* *own = what it needs until `free`; without them the scene. */
  kz_status (*make)(const kz_scene *scene, void **own);
  void (*free)(void *own);
  /* After the attractors of the window are found: may change labelling->labeller, that of its cells. Collective. */
  kz_status (*label)(void *own, kz_window_labels *labelling);
  /* Where that gave the cells starts that doubles do not distinguish: others like them, up to `reach` of the window's
   * width from its middle, for start_at; NULL: it did not. The caller frees it. start_at: at these shares of the width,
   * from the middle, for a level. */
  void *(*starts)(void *own, double reach);
  void (*start_at)(const void *starts, kz_precision level, __float128 theta, __float128 velocity, kz_start *start);
  /* Advice about cells that stay undecided; NULL = none. */
  const char *(*advice)(void *own);
  /* After the cells are labelled. Collective. */
  kz_status (*follow)(void *own, kz_window_labels *labelling);
  /* Replaces labels of the own cells of a tile of this rank, cell [kz_tile_own]. */
  kz_status (*take)(void *own, int64_t tile, kz_label *cell);
  /* Attributes, variables and lines of the summary. Rank 0. */
  kz_status (*write)(void *own, const kz_chunks *chunks, FILE *summary);
  /* Writes results derived from the stored labels; store and summary are NULL except on rank 0. Collective. */
  kz_status (*find)(void *own, const kz_chunks *chunks, kz_store *store, FILE *summary);
};
/* A part of this run. */
typedef struct {
  const kz_basin_part *part;
  void *own;
} kz_part;

struct kz_window_labels {
  const kz_basin_plan *plan;
  const kz_parameters *parameters;
  kz_dynamics *dynamics;
  kz_search search; /* Search from the starts */
  kz_tiles tiles;
  kz_cell_starts starts; /* Starts of all cells */
  int n_parts;
  kz_part *parts;       /* [n_parts] */
  kz_labeller labeller; /* Labeller of the cells, whose items are their numbers */
  int64_t tile;         /* most cells that are followed together */
  const kz_run *run;
  kz_label *cell;           /* [kz_tile_capacity] a tile, unpacked */
  kz_local_records records; /* tiles of this rank, packed */
  int16_t wanted;           /* label of the pending cells: 0 or KZ_DOUBTFUL */
  int64_t *before;          /* [own tiles + 1]: number of pending cells in all tiles before */
  int64_t *reached;         /* [INT16_MAX + 1]: number of starts and tiles that ended on each attractor */
};

/* Finds the attractors and labels all cells but mirror images. Out: `records`, the tiles of this rank; `reached`, of
 * all ranks. The caller frees *labelling in every case. Collective. */
kz_status kz_label_window(kz_window_labels *labelling);
void kz_window_labels_free(kz_window_labels *labelling);

/* Makes starts and labeller. Collective. */
kz_status kz_window_labels_start(kz_window_labels *labelling);

/* ---- packed tiles ---- */

/* Largest number of bytes of a packed tile. */
size_t kz_tile_labels_bytes(const kz_window_labels *labelling);
/* Packs the own cells of a tile, labelling->cell; unpacks them. */
kz_status kz_tile_labels_pack(const kz_window_labels *labelling, int64_t tile, void *record);
kz_status kz_tile_labels_unpack(kz_window_labels *labelling, const kz_local_record *kept);
/* Packs them into `kept`, a record of this rank, in place of what it holds. */
kz_status kz_tile_labels_replace(const kz_window_labels *labelling, kz_local_record *kept);
/* Number of cells of a packed tile with the label `wanted`, 0 or KZ_DOUBTFUL. */
int64_t kz_tile_labels_pending(const kz_local_record *kept, int16_t wanted);
/* Adds the tile to labelling->reached of every attractor that one of its cells ends on. */
void kz_tile_labels_note_reached(const kz_window_labels *labelling, const kz_local_record *kept);
