/* Windows by their middle: numbers of any digits, in quotes or not, in degrees too; where they are refused. */
#include <math.h>
#include <string.h>

#include "../../tools/test.h"

#include "scene/scene.h"
#include "kapitza/study_basin.h"

static const char text[] =
    "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}\nbasin:\n  method: exact\n";

static kz_status read_window(const char *theta, const char *velocity, kz_scene *scene) {
  char *sets[] = {(char *)theta, (char *)velocity};
  kz_message_clear();
  return kz_scene_read(text, strlen(text), "s.yaml", 2, sets, scene);
}

/* A tenth and pi to 32 digits; the text stays as it was written. */
TEST(digits_beyond_double_precision_count) {
  kz_scene scene;
  assert_int_equal(
      read_window("basin.theta={centre: '180 deg', width: 1}",
                  "basin.velocity={centre: 0.1, width: 1.00000000000000000000000000000001e-20, count: 2}", &scene),
      KZ_OK);
  const kz_decimal *velocity = &scene.basin->velocity.centre, *theta = &scene.basin->theta.centre,
                   *width = &scene.basin->velocity.width;
  assert_true(velocity->high == 0.1 && fabs(velocity->low + 5.5511151231257827e-18) < 1e-33);
  assert_true(theta->high == M_PI && fabs(theta->low - 1.2246467991473532e-16) < 1e-31);
  assert_true(width->high == 1e-20 && fabs(width->low - 5.484672854579044e-37) < 1e-51);
  assert_string_equal(velocity->text, "0.1");
  assert_string_equal(theta->text, "180 deg");
  assert_true(scene.basin->velocity.min == 0.1 && scene.basin->velocity.max == 0.1);
  assert_true(kz_axis_is_deep(&scene.basin->velocity) && !kz_axis_is_deep(&scene.basin->theta));
  kz_scene_free(&scene);
}

static void expect_refused(const char *velocity, const char *words) {
  kz_scene scene;
  assert_int_equal(read_window("basin.theta.count=10", velocity, &scene), KZ_REFUSED);
  if (!strstr(kz_message(), words)) print_message("%s\n", kz_message());
  assert_non_null(strstr(kz_message(), words));
}

TEST(what_is_no_window_is_refused) {
  char longest[1100] = "basin.velocity={width: 1, centre: 0.";
  memset(longest + strlen(longest), '1', 1022);
  strcpy(longest + strlen(longest), "}");
  expect_refused(longest, "basin.velocity.centre: \"0.1111");
  expect_refused(longest, "has more than 1023 characters");
  expect_refused("basin.velocity={centre: 1e999, width: 1}", "is too large for double precision");
  expect_refused("basin.velocity={centre: 1, width: 1e-999}", "is too small for double precision");
  expect_refused("basin.velocity={centre: 1 deg, width: 1}", "\"1 deg\" is not a finite decimal number");
  expect_refused("basin.velocity={centre: [1], width: 1}", "is a list");
  expect_refused("basin.velocity={centre: 1, width: 1e-301}", "it must be a number from 1e-300");
  expect_refused("basin.velocity={min: 0, max: 5e-324, count: 50}", "too narrow for double precision");
  expect_refused("basin.velocity={centre: 1, max: 2}", "contradicts basin.velocity.centre");
}
