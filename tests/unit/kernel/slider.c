/* Series of pendulums along a slider come from their neighbours. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <math.h>
#include <cmocka.h>

#include "kapitza/kernel.h"

enum { VALUES = 11 };
double kz_test_slid_error(int64_t n, const kz_pendulum *pendulum, kz_kept_series *series);

/* Pendulum i of a slider: its force, its damping, both, the direction of its drive. */
static kz_pendulum by_drive(int i) {
  return (kz_pendulum){0.1, 0.1, 0.4 * pow(4, 0.004 * i)};
}

static kz_pendulum by_damping(int i) {
  return (kz_pendulum){0.1, 0.1 * pow(4, 0.004 * i), 0.4};
}

static kz_pendulum by_frequency(int i) {
  const double omega = 11 * pow(4, 0.004 * i);
  return (kz_pendulum){1 / (omega * omega), 1 / (5 * omega), 0.3};
}

static kz_pendulum by_tilt(int i) {
  const double tilt = 0.1 + 0.004 * i;
  return (kz_pendulum){0.1, 0.1, 0.4 * cos(tilt), .horizontal = {{0.4 * sin(tilt)}}, .harmonics = 1, .unmirrored = 1};
}

/* Never by more than moving frames bear, and never not at all: most of the values are interpolated. */
static void test_sliders(void **state) {
  (void)state;
  static kz_pendulum (*const slider[])(int) = {by_drive, by_damping, by_frequency, by_tilt};
  for (int s = 0; s < 4; s++) {
    kz_pendulum pendulum[VALUES];
    for (int i = 0; i < VALUES; i++) pendulum[i] = slider[s](i);
    assert_true(kz_test_slid_error(VALUES, pendulum, NULL) <= 0); /* nothing is kept, nothing interpolated */
    kz_kept_series *series = kz_kept_series_create();
    const double error = kz_test_slid_error(VALUES, pendulum, series);
    kz_kept_series_free(series);
    print_message("slider %d: %.1e rad\n", s, error);
    assert_true(error > 0 && error < 1e-9);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_sliders)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
