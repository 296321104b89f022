/* The raster of the plane: lists of attractors, its largest regions. */
#pragma once

#include "types.h"

/* A connected part of the raster with one list of attractors. */
typedef struct {
  int64_t cells, cell; /* how many cells, and the one farthest from its edge */
  double radius;       /* radius around that cell, cells */
} kz_atlas_region;

/* The attractors of the cells of a raster, points x points, and its largest regions. */
enum { KZ_ATLAS_REGIONS = 120, KZ_ATLAS_NOT_KNOWN = 255 };
typedef struct {
  int64_t points, n_classes, n_regions, lists,
      negative;        /* different lists; cells whose list is not known, as some count is negative there */
  uint8_t *attracting; /* [class][y][x]; KZ_ATLAS_NOT_KNOWN where the list is not known */
  int16_t *count;      /* [y][x]: of all, mirror images too; -1 = not known */
  int32_t *list;       /* [y][x]: number of the list of attractors; -1 = not known */
  kz_atlas_region region[KZ_ATLAS_REGIONS];
  int64_t *hits, *other; /* [region][class], [region]: of the starts at the region's place; NULL = not asked for */
} kz_atlas_raster;
/* Counts attractors in the cells of a column, into `raster` if not NULL. Returns the number of unknown lists. */
int64_t kz_atlas_fill_column(kz_atlas *atlas, int64_t column, kz_atlas_raster *raster);
/* The middle of a row or column of cells. */
double kz_atlas_middle(int64_t i, int64_t points);
/* The classes must be in their order (kz_atlas_order). */
void kz_atlas_raster_make(kz_atlas *atlas, kz_atlas_raster *raster);
void kz_atlas_raster_free(kz_atlas_raster *raster);
/* The place of a region: the middle of the cell that is farthest from its edge. */
void kz_atlas_region_place(const kz_atlas_raster *raster, int64_t region, double place[2]);
/* Lists all classes, in the order of the file. */
void kz_atlas_order(kz_atlas *atlas);

/* Writes the group /atlas and the summary. Rank 0. */
kz_status kz_atlas_write(kz_atlas *atlas, const kz_atlas_raster *raster, kz_store *store, FILE *summary);
