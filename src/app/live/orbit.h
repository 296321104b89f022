/* The request orbit of the command serve. */
#pragma once

#include "request.h"

/* Computes the orbit in a thread of its own and answers the request. `meanwhile` is called every few milliseconds, once
 * the orbit takes longer than these; it reads what has arrived. When it sets request->ended, the answer is `ended`, at
 * once, and the thread stops within a stretch of the orbit. KZ_REFUSED, KZ_FAILED: nothing has been answered. */
kz_status kz_orbit_answer(const kz_request *request, kz_status (*meanwhile)(void *context), void *context);
