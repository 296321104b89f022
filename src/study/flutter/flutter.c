/* Drives of a sine between which flutter attracts: the inverted state and its daughters, followed to stronger
 * drives. */
#include "kapitza/study_flutter.h"
#include "sweep/sweep.h"

/* Strongest drive m for the inverted state; longest daughter cycle, drive periods. */
static const double TOP = 2;
enum { LONGEST = 2 };

/* Gives the pendulum of `context` with another drive. */
static bool pendulum_of_drive(const void *context, double m, kz_pendulum *pendulum) {
  *pendulum = *(const kz_pendulum *)context;
  pendulum->m = m;
  return true;
}

/* The value at which the attracting cycle of two periods that begins at `begin` ends by `kind`; NaN = there is none. */
static double end_of(const kz_sweep_walk *walk, double begin, int32_t kind) {
  for (int64_t i = 0; i < walk->count; i++) {
    const kz_sweep_piece *piece = walk->piece + i;
    if (piece->begin == begin && piece->attracts && piece->point.period == LONGEST && !piece->from_start)
      return piece->reached < 0 && piece->end_kind == kind ? piece->end : NAN;
  }
  return NAN;
}

void kz_flutter_drives(const kz_pendulum *pendulum, double *onset, double *end) {
  const kz_attractor inverted = {.period = 1, .centre = 1, .symmetric = 1, .theta = M_PI};
  double low, high;
  kz_sweep_walk walk;
  *onset = *end = NAN;
  kz_standing_drives(pendulum, &low, &high);
  if (!(pendulum->beta > 0) || isnan(high)) return;
  const kz_path path = {.pendulum = pendulum_of_drive, .context = pendulum, .from = (low + high) / 2, .to = TOP};
  kz_sweep_follow(&path, LONGEST, &inverted, 0, &walk);
  if (walk.piece->reached >= 0 || walk.piece->end_kind != KZ_END_PERIOD_DOUBLING) return;
  *onset = walk.piece->end;
  *end = end_of(&walk, end_of(&walk, *onset, KZ_END_SYMMETRY_BREAKING), KZ_END_PERIOD_DOUBLING);
}
