/* The engine: residents of the last pendulums. */
#ifndef KAPITZA_STUDY_LIVE_ENGINE_H
#define KAPITZA_STUDY_LIVE_ENGINE_H

#include "resident.h"

enum { KZ_RESIDENTS = 6 };
struct kz_engine {
  kz_resident resident[KZ_RESIDENTS];
  int64_t calls, versions, tracks; /* counters */
  const kz_live_catalogue *shown;  /* the last catalogue: tracks go on from it */
};

/* The resident for a scene, made where there is none; it belongs to the engine. */
kz_status kz_engine_resident(kz_engine *engine, const kz_scene *scene, bool moving, kz_resident **resident);

/* Its attractors have become more. */
void kz_engine_list(kz_engine *engine, kz_resident *resident);

#endif
