/* Random starts of other drives than the sine lie in their enclosures after 1, 5 and 20 periods, by quad precision. With KAPITZA_EXTENSIVE=1 100,000 of
 * each drive in doubles and 10,000 in pairs, which takes some ten minutes. */
#include "../tools/enclosed.h"
#include "../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 2048, STAGES = 3 };
static const int64_t periods[STAGES] = {1, 4, 15}; /* of each stage */

/* Fig. 12's pendulum on a path that is tilted by 5 degrees, and under the wave of scenes/square-wave.yaml; a Josephson junction. */
#define FIG12 .k = 1.0 / 121, .beta = 1.0 / 55, .m = 0.3
#define SQUARE(j) (0.3 * 4 / M_PI / (j) * ((j) % 4 == 1 ? 1 : -1))
static const struct {
  const char *name;
  kz_pendulum pendulum;
} drives[] = {
    {"tilted", {FIG12, .vertical = {{-0.00114158}}, .horizontal = {{0.0261467}}, .harmonics = 1, .unmirrored = 1}},
    {"square",
     {FIG12, .vertical = {{SQUARE(1) - 0.3}, {0, -0.02}, {SQUARE(3)}, {0}, {SQUARE(5)}, {0}, {SQUARE(7)}}, .harmonics = 7}},
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

static double uniform(double from, double to) {
  return from + (to - from) * rand() / RAND_MAX;
}

static void count(int n, const kz_enclosure *set, const kz_reference_state *state, counts *of) {
  for (int i = 0; i < n; i++) {
    quad end[2];
    double z[2], share = 0;
    memcpy(end, state[i].quads, sizeof end);
    if (!isfinite(set[i].reach[0] + set[i].reach[1])) {
      of->lost++;
      continue;
    }
    place_of(end, &set[i], z);
    for (int j = 0; j < 2; j++) share = fmax(share, fabs(z[j]) / set[i].reach[j]);
    of->farthest = fmax(of->farthest, share);
    *(share <= 1 ? &of->inside : &of->outside) += 1;
  }
}

/* Points, n <= BATCH, through all stages. */
static void follow(const kz_pendulum *pendulum, const kz_enclosure_tables *tables, int n, counts of[STAGES]) {
  static kz_enclosure set[BATCH];
  static kz_reference_state state[BATCH];
  double theta[BATCH], velocity[BATCH];
  for (int i = 0; i < n; i++) {
    theta[i] = uniform(-M_PI, M_PI);
    velocity[i] = uniform(-2, 2);
    set[i] = set_at(theta[i], velocity[i], 0);
  }
  kz_reference_start(n, theta, velocity, NULL, state);
  for (int s = 0; s < STAGES; s++) {
    for (int64_t period = 0; period < periods[s]; period++) kz_enclosures_advance(tables, KZ_NEW_FRAME, n, set);
    kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, n, periods[s], state);
    count(n, set, state, of + s);
  }
}

static void enclose(int drive, int32_t precision, int64_t starts) {
  const kz_pendulum *pendulum = &drives[drive].pendulum;
  kz_enclosure_tables *tables;
  counts of[STAGES] = {{0}};
  assert_int_equal(kz_enclosure_tables_create(pendulum, precision, 6, &tables), KZ_OK);
  srand(11);
  for (int64_t done = 0; done < starts; done += BATCH)
    follow(pendulum, tables, (int)(starts - done < BATCH ? starts - done : BATCH), of);
  kz_enclosure_tables_free(tables);
  for (int s = 0; s < STAGES; s++)
    print_message("%s, %s, stage %d: %lld outside of %lld, %lld lost; at most %.3f of the reach\n", drives[drive].name,
                  precision == KZ_ENCLOSE_PAIRS ? "pairs" : "doubles", s, (long long)of[s].outside, (long long)starts,
                  (long long)of[s].lost, of[s].farthest);
  for (int s = 0; s < STAGES; s++) assert_true(of[s].outside == 0 && of[s].inside > 0.9 * (double)starts && of[s].farthest > 0);
}

TEST(starts_lie_in_their_enclosures) {
  const int64_t starts = getenv("KAPITZA_EXTENSIVE") ? 100000 : 64;
  for (int drive = 0; drive < 3; drive++) {
    enclose(drive, KZ_ENCLOSE_DOUBLES, starts);
    enclose(drive, KZ_ENCLOSE_PAIRS, starts / (starts > 64 ? 10 : 4));
  }
}
