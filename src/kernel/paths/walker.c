/* Motions under noise: half a drift, half a kick, friction and noise by their exact solution, and back (N.
 * Groenbech-Jensen, O. Farago, Mol. Phys. 111 (2013) 983). Random numbers are hashes of counters, so that a motion does
 * not depend on who follows it. */
#include "kapitza/kernel_paths.h"

uint64_t kz_path_hash(uint64_t seed,
                      uint64_t counter) { /* SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014) */
  uint64_t z = seed * 0xd1342543de82ef95u + (counter + 1) * 0x9e3779b97f4a7c15u;
  for (int round = 0; round < 2; round++) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
  }
  return z;
}

double kz_path_random(uint64_t seed, uint64_t counter) {
  return (double)(kz_path_hash(seed, counter) >> 11) * 0x1p-53;
}

/* Two normal numbers. */
static void normal_pair(uint64_t seed, uint64_t counter, double pair[2]) {
  const double radius = sqrt(-2 * log(1 - kz_path_random(seed, 2 * counter)));
  const double angle = 2 * M_PI * kz_path_random(seed, 2 * counter + 1);
  pair[0] = radius * cos(angle);
  pair[1] = radius * sin(angle);
}

kz_walker *kz_walker_create(const kz_pendulum *pendulum, double temperature, int32_t steps) {
  kz_walker *walker = kz_malloc(sizeof *walker);
  const double h = 2 * M_PI / steps, decay = exp(-pendulum->beta * h);
  *walker =
      (kz_walker){.steps = steps, .half = h / 2, .decay = decay, .noise = sqrt(temperature * (1 - decay * decay))};
  walker->force = kz_malloc((size_t)steps * sizeof *walker->force);
  kz_path_forces(pendulum, steps, 0.5, walker->force[0]);
  return walker;
}

void kz_walker_free(kz_walker *walker) {
  if (walker) free(walker->force);
  free(walker);
}

void kz_walker_advance(const kz_walker *walker, uint64_t seed, uint64_t period, double *theta, double *velocity) {
  double x = *theta, v = *velocity, noise[2];
  for (int32_t i = 0; i < walker->steps; i++) {
    const double *f = walker->force[i];
    if (i % 2 == 0) normal_pair(seed, period * (uint64_t)walker->steps + (uint64_t)i, noise);
    x += walker->half * v;
    const double kick = walker->half * (f[2] - f[0] * sin(x) + f[1] * cos(x));
    v = (v + kick) * walker->decay + walker->noise * noise[i % 2] + kick;
    x += walker->half * v;
  }
  *theta = x;
  *velocity = v;
}
