/* Enclosures of 20 drive periods hold the motion: those in doubles against those in pairs of doubles, these against quads, whose own reach
 * counts as a part of the distance. KAPITZA_EXTENSIVE=1: 10^5 starts a pendulum, 1000 in pairs; tells how much wider than the error a set is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "kapitza/kernel.h"

enum { PERIODS = 20, FEW = 600, MANY = 100000, IN_PAIRS = 100 /* a hundredth of them */ };
static const double FASTEST = 2, WIDEST = 0.03; /* rad per drive radian: of the starts; of sets that are of use */

typedef struct {
  int64_t n, outside, kept;
  double *ratio; /* [n] of the kept ones: reach over error */
} comparison;

static double uniform(double from, double to) {
  return from + (to - from) * rand() / RAND_MAX;
}

static kz_enclosure *some_points(int64_t n) {
  kz_enclosure *set = calloc((size_t)n, sizeof *set);
  srand(1);
  for (int64_t i = 0; i < n; i++)
    set[i] =
        (kz_enclosure){.theta = {uniform(-M_PI, M_PI)}, .velocity = {uniform(-FASTEST, FASTEST)}, .matrix = {{1, 0}, {0, 1}}};
  return set;
}

static kz_enclosure_tables *tables_for(const kz_pendulum *pendulum, int32_t precision) {
  kz_enclosure_tables *tables;
  assert_int_equal(kz_enclosure_tables_create(pendulum, precision, 4, &tables), KZ_OK);
  return tables;
}

static double difference(const double a[3], const double b[3]) {
  return (double)((((__float128)a[0] - b[0]) + ((__float128)a[1] - b[1])) + ((__float128)a[2] - b[2]));
}

/* |z| / reach of the centre of a fine set in the coordinates of a coarse one (the larger of two); *surely: of its farthest point. */
static double place_of(const kz_enclosure *fine, const kz_enclosure *coarse, double *surely) {
  double x[2] = {difference(fine->theta, coarse->theta), difference(fine->velocity, coarse->velocity)}, place = 0;
  const double (*A)[2] = coarse->matrix, det = A[0][0] * A[1][1] - A[0][1] * A[1][0];
  const double inverse[2][2] = {{A[1][1] / det, -A[0][1] / det}, {-A[1][0] / det, A[0][0] / det}};
  x[0] -= 2 * M_PI * rint(x[0] / (2 * M_PI));
  *surely = 0;
  for (int i = 0; i < 2; i++) {
    double more = 0;
    const double z = inverse[i][0] * x[0] + inverse[i][1] * x[1];
    for (int j = 0; j < 2; j++)
      more += fabs(inverse[i][0] * fine->matrix[0][j] + inverse[i][1] * fine->matrix[1][j]) * fine->reach[j];
    place = fmax(place, fabs(z) / coarse->reach[i]);
    *surely = fmax(*surely, (fabs(z) + more) / coarse->reach[i]);
  }
  return place;
}

static void compare_sets(int64_t n, const kz_enclosure *fine, const kz_enclosure *coarse, comparison *c) {
  c->kept = 0;
  for (int64_t i = 0; i < n; i++) {
    double surely;
    if (!(coarse[i].reach[0] < WIDEST && coarse[i].reach[1] < WIDEST)) continue;
    const double place = place_of(&fine[i], &coarse[i], &surely);
    c->outside += !(surely <= 1);
    c->ratio[c->kept++] = 1 / place;
  }
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void report(const char *name, int32_t precision, int period, const comparison *c) {
  qsort(c->ratio, (size_t)c->kept, sizeof *c->ratio, by_size);
  print_message(
      "%s, %s, period %d: %lld sets of %lld narrower than 0.03 rad, %lld not; reach over error: median %.3g, 10 %% %.3g, least "
      "%.3g\n",
      name, precision == KZ_ENCLOSE_DOUBLES ? "doubles" : "pairs", period, (long long)c->kept, (long long)c->n,
      (long long)c->outside, c->ratio[c->kept / 2], c->ratio[c->kept / 10], c->ratio[0]);
}

static void follow(const char *name, const kz_pendulum *pendulum, int32_t precision, int64_t n) {
  kz_enclosure_tables *coarse = tables_for(pendulum, precision), *fine = tables_for(pendulum, precision + 1);
  kz_enclosure *set = some_points(n), *truth = some_points(n);
  comparison c = {.n = n, .ratio = calloc((size_t)n, sizeof *c.ratio)};
  for (int period = 1; period <= PERIODS; period++) {
    kz_enclosures_advance(coarse, KZ_NEW_FRAME, n, set);
    kz_enclosures_advance(fine, KZ_NEW_FRAME, n, truth);
    compare_sets(n, truth, set, &c);
    assert_int_equal(c.outside, 0);
    assert_true(c.kept > n / 2);
    if (getenv("KAPITZA_EXTENSIVE") && (period == 1 || period % 10 == 0)) report(name, precision, period, &c);
  }
  free(c.ratio);
  free(set);
  free(truth);
  kz_enclosure_tables_free(coarse);
  kz_enclosure_tables_free(fine);
}

static void no_motion_leaves_its_enclosure(void **state) {
  (void)state;
  static const struct {
    const char *name;
    kz_pendulum pendulum;
  } cases[] = {{"Fig. 12", {1.0 / 121, 1.0 / 55, 0.3}}, {"Fig. 13", {1.0 / 121, 1.0 / 55, 0.46}}};
  const int64_t n = getenv("KAPITZA_EXTENSIVE") ? MANY : FEW;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    follow(cases[i].name, &cases[i].pendulum, KZ_ENCLOSE_DOUBLES, n);
    follow(cases[i].name, &cases[i].pendulum, KZ_ENCLOSE_PAIRS, n / IN_PAIRS);
  }
}

/* What would be seen: a set whose centre is off by its own reach. */
static void a_centre_that_is_off_is_noticed(void **state) {
  (void)state;
  const kz_pendulum pendulum = {1.0 / 121, 1.0 / 55, 0.3};
  kz_enclosure_tables *coarse = tables_for(&pendulum, KZ_ENCLOSE_DOUBLES), *fine = tables_for(&pendulum, KZ_ENCLOSE_PAIRS);
  kz_enclosure *set = some_points(FEW), *truth = some_points(FEW);
  double ratio[FEW];
  comparison c = {.n = FEW, .ratio = ratio};
  kz_enclosures_advance(coarse, KZ_NEW_FRAME, FEW, set);
  kz_enclosures_advance(fine, KZ_NEW_FRAME, FEW, truth);
  for (int i = 0; i < FEW; i++)
    for (int j = 0; j < 2; j++) {
      set[i].theta[1] += 1.1 * set[i].matrix[0][j] * set[i].reach[j];
      set[i].velocity[1] += 1.1 * set[i].matrix[1][j] * set[i].reach[j];
    }
  compare_sets(FEW, truth, set, &c);
  assert_int_equal(c.outside, FEW);
  free(set);
  free(truth);
  kz_enclosure_tables_free(coarse);
  kz_enclosure_tables_free(fine);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_motion_leaves_its_enclosure),
                                     cmocka_unit_test(a_centre_that_is_off_is_noticed)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
