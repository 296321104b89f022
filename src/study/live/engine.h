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

/* *resident = the resident for a scene; the engine makes it if necessary and owns it. */
kz_status kz_engine_resident(kz_engine *engine, const kz_scene *scene, bool moving, kz_resident **resident);

/* Makes the catalogue of a resident anew after new attractors were found. */
void kz_engine_list(kz_engine *engine, kz_resident *resident);

#endif
