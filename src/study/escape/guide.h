/* A guess of a path: where the motion of the attractor becomes that of the saddle. */
#pragma once

#include "routes.h"

typedef struct {
  int64_t periods, phase; /* periods of the path; first strobe of the attractor */
  double change, width;   /* drive periods: the middle of the change, and how long it lasts */
  double turn;            /* turns by which the saddle is more than the copy that is nearest at the change */
} kz_guess;

/* theta [periods samples + 1], and the turns of both ends. */
void kz_escape_guess(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                     const kz_guess *guess, double *theta, double turns[2]);
