/* A pendulum in all forms and units that say the same, and parts of pi. */
#include "../../tools/test.h"

#include <math.h>
#include <string.h>

#include "kapitza/study.h"
#include "scene/scene.h"
#include "kapitza/study_basin.h"

static const char TEXT[] = "pendulum: {k: 0, damping: 0.05, m: 0.5}\nbasin: {velocity: {min: -1, max: 1}}\n";

static void read_with(const char *option, kz_scene *scene) {
  char text[512];
  strcpy(text, option);
  char *sets[] = {text};
  assert_int_equal(kz_scene_read(TEXT, sizeof TEXT - 1, "s.yaml", 1, sets, scene), KZ_OK);
}

/* k = 1/121, beta = 1/55, m = 0.3: Q = 5, Omega = 11 (BSG Eq. 1, 2); at 100 rad/s, length 0.4 m; M r/I = 2.5 /m. */
TEST(units_and_ways_agree) {
#define GRAVITY "gravity: 33.057851239669425"
  static const char *const ways[] = {
      "pendulum={quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}",
      "pendulum={k: 0.008264462809917356, damping: 0.01818181818181818, m: 0.3}",
      ("pendulum={mass: 0.1, radius: 0.2, inertia: 0.008, friction: 0.014545454545454545, " GRAVITY
       ", pivot_amplitude: 0.12, "
       "frequency: 15.915494309189533}"),
      ("pendulum={mass: 100 g, radius: 20cm, inertia: 80000 g*cm^2, friction: 0.014545454545454545 N m s, "
       "gravity: 3305.7851239669425 cm/s^2, amplitude: 120 mm, frequency: 954.92965855137201 rpm}"),
      "pendulum={length: 40 cm, " GRAVITY
      ", amplitude: 12 cm, pivot_frequency: 15.915494309189533 Hz, quality_factor: 5}",
      "pendulum={length: 0.4, " GRAVITY ", amplitude: 0.12, frequency: 100 rad/s, decay_time: 1100 ms}",
      "pendulum={length: 0.4, mass: 2, " GRAVITY
      ", amplitude: 0.12, pivot_frequency: 100, friction: 0.58181818181818179}"};
  for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
    kz_scene scene;
    read_with(ways[i], &scene);
    assert_true(fabs(scene.parameters.pendulum.k - 1.0 / 121) < 1e-15);
    assert_true(fabs(scene.parameters.pendulum.beta - 1.0 / 55) < 1e-15);
    assert_true(fabs(scene.parameters.pendulum.m - 0.3) < 1e-15);
    assert_true(fabs(scene.parameters.quality_factor - 5.0) < 1e-12);
    assert_true(fabs(scene.parameters.drive_frequency - 11.0) < 1e-12);
    assert_true(i < 2 ? isnan(scene.parameters.pivot_frequency) : fabs(scene.parameters.pivot_frequency - 100) < 1e-12);
    kz_scene_free(&scene);
  }
}

TEST(gravity_is_the_standard_one_where_it_is_left_out) {
  kz_scene scene;
  read_with("pendulum={length: 0.2, frequency: 50, amplitude: 1 mm, quality_factor: 9}", &scene);
  assert_true(fabs(scene.parameters.pendulum.k - 9.80665 / (0.2 * 1e4 * M_PI * M_PI)) < 1e-15);
  kz_scene_free(&scene);
}

TEST(angles_are_parts_of_pi) {
  kz_scene scene;
  read_with("basin.theta={min: -pi/2, max: 0.5 pi}", &scene);
  assert_true(scene.basin->theta.min == -M_PI / 2 && scene.basin->theta.max == M_PI / 2);
  kz_scene_free(&scene);
  static const char *const wrong[] = {"pi/0", "pi/", "2 pie", "pi pi", "pi/2x", "e pi"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    double value;
    const kz_node node = {.kind = KZ_SCALAR, .text = (char *)wrong[i], .plain = true};
    assert_non_null(kz_scalar_angle(&node, &value));
  }
}
