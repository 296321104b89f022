/* Random starts of other drives than the sine lie in their enclosures after 1, 5 and 20 periods, by quad precision (in
 * triples: by orbits of 200 bits): 100,000 of each drive in doubles and in pairs and 1000 in triples, which takes half
 * an hour. With arguments DRIVE (0, 1, 2), PRECISION (0: doubles, 1: pairs, 2: triples), FIRST and END the starts FIRST
 * .. END - 1 of one drive: many can be followed in parts. Exit status 1 if one lies outside. */
#include "../tests/tools/enclosed.h"
#include "../tests/tools/enclosed_orbit.h"
#include "../tests/tools/reference.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 2048, STAGES = 3, DIGITS_BITS = 200 };
static const int64_t periods[STAGES] = {1, 4, 15}; /* Periods of each stage */

/* Fig. 12's pendulum on a path tilted by 5 degrees, and under the wave of scenes/square-wave.yaml; a junction. */
#define FIG12 .k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3
#define SQUARE(j) (0.3 * 4 / M_PI / (j) * ((j) % 4 == 1 ? 1 : -1))
static const struct {
  const char *name;
  kz_pendulum pendulum;
} drives[] = {
    {"tilted", {FIG12, .vertical = {{-0.00114158}}, .horizontal = {{0.0261467}}, .harmonics = 1, .unmirrored = 1}},
    {"square",
     {FIG12, .vertical = {{SQUARE(1) - 0.3}, {0, -0.02}, {SQUARE(3)}, {0}, {SQUARE(5)}, {0}, {SQUARE(7)}},
      .harmonics = 7}},
    {"Josephson",
     {.k = 0.01031954,
      .beta = 0.1,
      .torque = 0.1,
      .vertical = {{0}, {0.009027166, -0.00182367}, {0}, {-0.000425745, 0.000179337}},
      .horizontal = {{0.022164816, -0.002216482}, {0}, {-0.002299128, 0.0007087}},
      .harmonics = 4,
      .unmirrored = 1}},
};

typedef struct {
  int64_t inside, outside, lost;
  double farthest; /* the largest |z| / reach */
} counts;

/* Number j of start i, evenly in [from, to), independent of other starts: splitmix64 (Steele, Lea, Flood 2014). */
static double enclosures_uniform(int64_t i, int j, double from, double to) {
  uint64_t x = (2 * (uint64_t)i + (uint64_t)j + 1) * 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return from + (to - from) * (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

/* Counts a set, in whose coordinates the motion is at z. */
static void enclosures_count(const kz_enclosure *set, const double z[2], counts *of) {
  double share = 0;
  for (int j = 0; j < 2; j++) share = fmax(share, fabs(z[j]) / set->reach[j]);
  of->farthest = fmax(of->farthest, share);
  *(share <= 1 ? &of->inside : &of->outside) += 1;
}

/* Motions in quad precision, or, beside sets in triples, in 200 bits. */
typedef struct {
  kz_reference_state state[BATCH];
  kz_arbitrary *orbit[BATCH];
} motions;

static void enclosures_start(const kz_pendulum *pendulum, bool in_digits, int n, const double *theta,
                             const double *velocity, motions *m) {
  kz_reference_start(n, theta, velocity, NULL, m->state);
  for (int i = 0; i < n && in_digits; i++)
    m->orbit[i] =
        kz_arbitrary_create(pendulum, (kz_coordinate[2]){{.high = theta[i]}, {.high = velocity[i]}}, DIGITS_BITS);
}

static void enclosures_advance(const kz_pendulum *pendulum, bool in_digits, int n, int64_t steps, motions *m) {
  if (!in_digits) kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, n, steps, m->state);
  for (int i = 0; i < n && in_digits; i++)
    for (int64_t period = 0; period < steps; period++)
      if (kz_arbitrary_advance(m->orbit[i], DIGITS_BITS, 0, NULL) != KZ_OK) exit(1);
}

static void enclosures_place(bool in_digits, const motions *m, int i, const kz_enclosure *set, double z[2]) {
  quad end[2];
  memcpy(end, m->state[i].quads, sizeof end);
  if (in_digits)
    place_of_orbit(m->orbit[i], set, z);
  else
    place_of(end, set, z);
}

/* The starts first .. first + n - 1, n <= BATCH, through all stages. */
static void enclosures_follow(const kz_pendulum *pendulum, const kz_enclosure_tables *tables, bool in_digits,
                              int64_t first, int n, counts of[STAGES]) {
  static kz_enclosure set[BATCH];
  static motions m;
  static double theta[BATCH], velocity[BATCH];
  double z[2];
  for (int i = 0; i < n; i++) {
    theta[i] = enclosures_uniform(first + i, 0, -M_PI, M_PI);
    velocity[i] = enclosures_uniform(first + i, 1, -2, 2);
    set[i] = set_at(theta[i], velocity[i], 0);
  }
  enclosures_start(pendulum, in_digits, n, theta, velocity, &m);
  for (int s = 0; s < STAGES; s++) {
    for (int64_t period = 0; period < periods[s]; period++) kz_enclosures_advance(tables, KZ_NEW_FRAME, n, set);
    enclosures_advance(pendulum, in_digits, n, periods[s], &m);
    for (int i = 0; i < n; i++) {
      const bool lost = !isfinite(set[i].reach[0] + set[i].reach[1]);
      of[s].lost += lost;
      if (lost) continue;
      enclosures_place(in_digits, &m, i, &set[i], z);
      enclosures_count(&set[i], z, of + s);
    }
  }
  for (int i = 0; i < n && in_digits; i++) kz_arbitrary_free(m.orbit[i]);
}

/* Whether the starts lie in their sets. */
static bool enclosures_enclose(int drive, int32_t precision, int64_t first, int64_t end) {
  static const char *const names[] = {"doubles", "pairs", "triples"};
  const kz_pendulum *pendulum = &drives[drive].pendulum;
  kz_enclosure_tables *tables;
  counts of[STAGES] = {{0}};
  bool holds = kz_enclosure_tables_create(pendulum, precision, 6, &tables) == KZ_OK;
  if (!holds) return false;
  for (int64_t at = first; at < end; at += BATCH)
    enclosures_follow(pendulum, tables, precision == KZ_ENCLOSE_TRIPLES, at, (int)(end - at < BATCH ? end - at : BATCH),
                      of);
  kz_enclosure_tables_free(tables);
  for (int s = 0; s < STAGES; s++) {
    printf("%s, %s, stage %d: %lld outside of %lld, %lld lost; at most %.2g of the reach\n", drives[drive].name,
           names[precision], s, (long long)of[s].outside, (long long)(end - first), (long long)of[s].lost,
           of[s].farthest);
    holds = holds && of[s].outside == 0 && of[s].inside > 0.9 * (double)(end - first) && of[s].farthest > 0;
  }
  return holds;
}

int main(int count, char **words) {
  static const int64_t starts[] = {
      [KZ_ENCLOSE_DOUBLES] = 100000, [KZ_ENCLOSE_PAIRS] = 100000, [KZ_ENCLOSE_TRIPLES] = 1000};
  bool hold = true;
  if (count == 5) return !enclosures_enclose(atoi(words[1]), atoi(words[2]), atoll(words[3]), atoll(words[4]));
  for (int drive = 0; drive < 3; drive++)
    for (int32_t precision = 0; precision < KZ_ENCLOSURES; precision++)
      hold = enclosures_enclose(drive, precision, 0, starts[precision]) && hold;
  return !hold;
}
