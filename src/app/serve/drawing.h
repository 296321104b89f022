/* Answers requests, with the engine, orbits and charts. */
#ifndef KAPITZA_APP_DRAWING_H
#define KAPITZA_APP_DRAWING_H

#include "request.h"

typedef struct {
  kz_engine *engine;
  int64_t shown; /* version of the catalogue that was sent last */
} kz_drawing;

void kz_drawing_open(kz_drawing *drawing);
void kz_drawing_close(kz_drawing *drawing);

/* Answers where, orbit or catalogue. After KZ_REFUSED and KZ_FAILED no answer has been written. */
kz_status kz_drawing_answer(kz_drawing *drawing, kz_request *request);

/* Answers a frame or chart; `pause` (with its context) is called every few milliseconds, and anything but KZ_OK ends it. */
kz_status kz_drawing_make(kz_drawing *drawing, kz_request *request, kz_status (*pause)(void *), void *context);

#endif
