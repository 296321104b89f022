/* Tiles of a window: a tile is one HDF5 chunk of the variables of the cells, a piece of work and a record. */
#ifndef KAPITZA_STUDY_TILES_H
#define KAPITZA_STUDY_TILES_H

#include "kapitza/study.h"

enum { KZ_BOX = 5 }; /* cells along an edge of a box of the basin entropy */

/* Whole rows of cells, or a piece of one row. So the cells of a tile are consecutive. Where the window is its own mirror image tile
 * t mirrors tile n - 1 - t. */
typedef struct {
  int64_t rows, columns; /* of cells in the window */
  int64_t chunk[2];      /* cells of a tile along velocity and theta; the last ones may reach beyond the window */
  int64_t across;        /* tiles along theta */
  int64_t n, own;        /* tiles of the window; of these the first ones are labelled, the others mirror them */
  int64_t cells, unique_cells;
  bool whole; /* no box and no row lies in two tiles */
} kz_tiles;

/* The tiles of a scene's basin, of about `target` cells: a function of the scene alone. */
kz_tiles kz_tiles_of(const kz_scene *scene, int64_t target);
/* First cell of a tile, and how many it has within the window. */
int64_t kz_tile_first(const kz_tiles *tiles, int64_t tile);
int64_t kz_tile_count(const kz_tiles *tiles, int64_t tile);
/* How many of these are labelled: all but in the tile in the middle, which mirrors itself. */
int64_t kz_tile_own(const kz_tiles *tiles, int64_t tile);
/* Cells of every chunk. */
int64_t kz_tile_capacity(const kz_tiles *tiles);

#endif
