/* Tiles of a window: a tile is one HDF5 chunk of the variables of the cells, a piece of work and a record. */
#ifndef KAPITZA_STUDY_TILES_H
#define KAPITZA_STUDY_TILES_H

#include "kapitza/study.h"

enum { KZ_BOX = 5 }; /* cells along an edge of a box of the basin entropy */

/* A tile is a number of whole rows of cells, or a part of one row, so its cells are consecutive. If the window is its own mirror image,
 * tile t is the mirror image of tile n - 1 - t. */
typedef struct {
  int64_t rows, columns; /* of cells in the window */
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

#endif
