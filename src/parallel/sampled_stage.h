/* A stage of a sampled run, and what it shares with other stages. */
#pragma once

#include "kapitza/parallel.h"

/* The work of a tile, or of the items that it is made of. */
static inline kz_status kz_stage_work(const kz_stage *stage, int64_t tile, void *record) {
  if (!stage->items) return stage->work(stage->context, tile, record);
  const int64_t tiles = (stage->n_items + stage->batch - 1) / stage->batch; /* of a row */
  const int64_t first = tile % tiles * stage->batch, left = stage->n_items - first;
  return stage->items(stage->context, tile / tiles * stage->n_items + first, left < stage->batch ? left : stage->batch, record);
}

/* A stage of a sampled run. KZ_STOPPED: the time for samples is over. */
kz_status kz_stage_sample(kz_sampling *sample, const kz_stage *stage, void *records);
