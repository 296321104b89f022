/* The measure `ends` of a sweep over a plane: where the same starts end. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/dynamics_ends.h"
#include "plan.h"

enum { KZ_NO_PENDULUM = -2 }; /* in place of a period: no pendulum, or one without damping */

/* ending [n] of start number `place` at n <= KZ_ENDS_POINTS points; point [n] = their numbers, x fastest. */
enum { KZ_ENDS_POINTS = 256 };
void kz_ends_points(const kz_scene *scene, int64_t place, int64_t n, const int64_t *point, kz_plane_ending *ending);
