/* Records of tiles: seeds and curves. */
#pragma once

#include "types.h"

enum { KZ_ATLAS_CURVE_BYTES = 1 << 20, KZ_ATLAS_SEEDS_BYTES = 1 << 19 };
/* The records of a stage, in the order of its tiles. */
typedef struct {
  int64_t n;
  char **record; /* [n]: each begins with its number of bytes, a uint64_t */
} kz_atlas_bag;
void kz_atlas_bag_free(kz_atlas_bag *b);
/* Runs a kept stage whose records have at most `bytes` bytes; all ranks get them. */
kz_status kz_atlas_gather(const kz_run *run, const char *name, int64_t n, size_t bytes, kz_tile_fn work, void *context,
                          kz_atlas_bag *b);
/* Seeds and curves as records; the seeds of a record stay where they are, a curve is copied. */
void kz_atlas_put_seeds(const kz_atlas_seeds *seeds, void *record);
kz_atlas_seeds kz_atlas_seeds_in(const char *record);
void kz_atlas_put_curve(const kz_atlas_curve *curve, void *record);
kz_atlas_curve kz_atlas_curve_in(const char *record);
