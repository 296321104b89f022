/* One pendulum that stays: its map, its attractors, its trapping regions, its catalogue. */
#ifndef KAPITZA_STUDY_LIVE_RESIDENT_H
#define KAPITZA_STUDY_LIVE_RESIDENT_H

#include "attractors/catalogue.h"
#include "attractors/search.h"
#include "kapitza/study_live.h"
#include "window/starts.h"

typedef struct {
  kz_scene scene; /* pendulum, numerics, and the basin whose window was searched; no title */
  bool moving;    /* for moving frames */
  bool busy;      /* a frame is being made of it */
  int64_t used;   /* the larger, the later */
  kz_dynamics *dynamics;
  kz_search search;
  kz_images *images; /* of the last window whose cells they served; NULL: none yet */
  kz_live_catalogue catalogue;
} kz_resident;

/* Attractors of the scene's window, trapping regions, catalogue without tracks. To be freed in every case. */
kz_status kz_resident_make(const kz_scene *scene, bool moving, kz_resident *resident);
void kz_resident_free(kz_resident *resident);

/* Does it serve a frame of the scene? */
bool kz_resident_serves(const kz_resident *resident, const kz_scene *scene, bool moving);

/* The catalogue once more, after attractors have joined; `version` is the new one's. Tracks come from `before` (NULL: none) where an attractor is the same
 * or has moved, else from *tracks, which counts them. */
void kz_resident_list(kz_resident *resident, int64_t version, const kz_live_catalogue *before, int64_t *tracks);

#endif
