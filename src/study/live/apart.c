/* How far two pendulums are apart. */
#include <math.h>

#include "live.h"

double kz_pendulums_parted(const kz_pendulum *a, const kz_pendulum *b) {
  double size = fabs(a->k) + fabs(a->m) + a->beta;
  double difference = fabs(a->k - b->k) + fabs(a->m - b->m) + fabs(a->beta - b->beta) + fabs(a->torque - b->torque);
  if (kz_is_mirrored(a) != kz_is_mirrored(b)) return INFINITY;
  for (int j = 0; j < KZ_HARMONICS; j++)
    for (int i = 0; i < 2; i++)
      difference += fabs(a->vertical[j][i] - b->vertical[j][i]) + fabs(a->horizontal[j][i] - b->horizontal[j][i]);
  return difference / size;
}
