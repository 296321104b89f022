#include "share.h"

#include <math.h>

static const double Z = 1.959963984540054; /* 97.5 % of the normal distribution lie below */

/* Wilson's interval with z^2 = `square`. */
static kz_share share_interval(int64_t hits, int64_t n, double square) {
  if (n == 0) return (kz_share){NAN, 0, 1};
  const double k = (double)hits, of = (double)n;
  const double centre = (k + square / 2) / (of + square);
  const double half = sqrt(square) / (of + square) * sqrt(k * (of - k) / of + square / 4);
  return (kz_share){k / of, hits == 0 ? 0 : fmax(0, centre - half), hits == n ? 1 : fmin(1, centre + half)};
}

kz_share kz_share_of(int64_t hits, int64_t n) {
  return share_interval(hits, n, Z * Z);
}

kz_share kz_share_of_part(int64_t hits, int64_t n, int64_t total) {
  if (n > 0 && n == total)
    return (kz_share){(double)hits / (double)n, (double)hits / (double)n, (double)hits / (double)n};
  return share_interval(hits, n, total > 1 ? Z * Z * (double)(total - n) / (double)(total - 1) : Z * Z);
}

kz_unseen kz_unseen_of(int64_t once, int64_t twice) {
  const double f1 = (double)once, f2 = (double)twice + 1, number = f1 * (f1 - 1) / (2 * f2);
  const double of_once = f1 * (2 * f1 - 1) * (2 * f1 - 1) / (4 * f2 * f2);
  const double of_twice = f1 * f1 * (f2 - 1) * (f1 - 1) * (f1 - 1) / (4 * f2 * f2 * f2 * f2);
  return (kz_unseen){number, number + of_once + of_twice};
}

void kz_unseen_interval(kz_unseen unseen, double *low, double *high) {
  const double t = unseen.number;
  const double factor = t > 0 ? exp(Z * sqrt(log1p(unseen.variance / (t * t)))) : 1;
  *low = t / factor;
  *high = t * factor;
}

int64_t kz_share_sample(double share) {
  int64_t n = (int64_t)ceil(Z * Z * (1 / share - 1));
  while (kz_share_of(0, n).high > share) n++;
  return n;
}

static const uint64_t GAMMA = 0x9e3779b97f4a7c15u;

static uint64_t share_mix(uint64_t x) {
  x += GAMMA;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

void kz_even_share(int64_t i, double share[2]) {
  share[0] = fmod(0.5 + 0.7548776662466927 * (double)i, 1);
  share[1] = fmod(0.5 + 0.5698402909980532 * (double)i, 1);
}

uint64_t kz_random_bits(uint64_t index) {
  return share_mix((index - 1) * GAMMA);
}

/* One pass of a Feistel network over 2 * bits bits: a permutation. */
static uint64_t share_feistel(uint64_t x, int bits, uint64_t key) {
  const uint64_t mask = ((uint64_t)1 << bits) - 1;
  uint64_t left = x >> bits, right = x & mask;
  for (uint64_t round = 0; round < 6; round++) {
    const uint64_t next = left ^ (share_mix(right ^ share_mix(key + round)) & mask);
    left = right;
    right = next;
  }
  return left << bits | right;
}

int64_t kz_shuffled(int64_t i, int64_t total, int64_t seed) {
  int bits = 1;
  while ((int64_t)1 << (2 * bits) < total) bits++;
  uint64_t x = (uint64_t)i;
  do x = share_feistel(x, bits, share_mix((uint64_t)seed));
  while (x >= (uint64_t)total);
  return (int64_t)x;
}
