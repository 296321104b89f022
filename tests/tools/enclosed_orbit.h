/* Where an orbit in many digits lies in a set: for sets that are narrower than the last digit of quad precision. */
#pragma once

#include <stdlib.h>

#include "digits/number.h"
#include "enclosed.h"

/* z of an orbit, in the coordinates of a set; the same but for a whole turn. */
static inline void place_of_orbit(const kz_arbitrary *orbit, const kz_enclosure *set, double z[2]) {
  enum { BITS = 300 };
  const size_t size = kz_arbitrary_size(orbit);
  char *text = malloc(size);
  quad distance[2];
  KZ_NUMBER(x);
  KZ_NUMBER(part);
  kz_arbitrary_write(orbit, text);
  for (int axis = 0; axis < 2; axis++) {
    if (!kz_number_read(text + axis * (int)(size / 2), &x)) abort();
    for (int i = 0; i < 3; i++) {
      kz_number_of_double((axis ? set->velocity : set->theta)[i], &part);
      kz_number_subtract(&x, &x, &part, BITS);
    }
    kz_number_two_pi(&part, BITS);
    if (axis == 0 && kz_number_double(&x) > 3) kz_number_subtract(&x, &x, &part, BITS);
    if (axis == 0 && kz_number_double(&x) < -3) kz_number_add(&x, &x, &part, BITS);
    distance[axis] = kz_number_quad(&x);
  }
  free(text);
  place_at(distance[0], distance[1], set, z);
}
