/* The table of keys, strict scalars, the reading of a scene and its resolved text. */
#include "../../tools/test.h"

#include "../../tools/resolved.h"
#include "scene/scene.h"
#include "kapitza/study_basin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GOOD                                                                   \
  "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}\n" \
  "basin:\n"                                                                   \
  "  velocity: {min: -2, max: 2}\n"

static kz_status read_scene(const char *text, const char *set, kz_scene *scene) {
  char *sets[1] = {(char *)set};
  kz_message_clear();
  return kz_scene_read(text, strlen(text), "s.yaml", set ? 1 : 0, sets, scene);
}

/* The whole message of a refused scene. */
static void expect_refused(const char *text, const char *set, const char *message) {
  kz_scene scene;
  assert_int_equal(read_scene(text, set, &scene), KZ_REFUSED);
  assert_string_equal(kz_message(), message);
}

TEST(defaults_are_those_of_the_table) {
  kz_scene scene;
  assert_int_equal(read_scene(GOOD, NULL, &scene), KZ_OK);
  assert_true(scene.has_basin);
  assert_string_equal(scene.title, "");
  assert_int_equal(scene.basin->theta.count, 1000);
  assert_true(scene.basin->theta.min == -M_PI && scene.basin->theta.max == M_PI);
  assert_int_equal(scene.basin->method, KZ_METHOD_EXACT);
  assert_int_equal(scene.basin->interpolation, KZ_QUINTIC);
  kz_scheme scheme;
  kz_scheme_row(scene.numerics.scheme, &scheme);
  assert_string_equal(scheme.name, "processed");
  assert_int_equal(scene.asked.steps_per_period, KZ_AUTO);
  assert_true(scene.asked.tolerance == 1e-12 && scene.numerics.steps_per_period > 12 &&
              scene.numerics.steps_per_period < 100);
  assert_true(fabs(scene.parameters.pendulum.k - 1.0 / 121) < 1e-18);
  assert_true(fabs(scene.parameters.pendulum.beta - 1.0 / 55) < 1e-17);
  kz_scene_free(&scene);
}

TEST(angles_are_in_degrees_where_they_say_so) {
  kz_scene scene;
  assert_int_equal(read_scene(GOOD, "basin.theta={min: -90 deg, max: 180 deg}", &scene), KZ_OK);
  assert_true(scene.basin->theta.min == -M_PI / 2 && scene.basin->theta.max == M_PI);
  kz_scene_free(&scene);
  expect_refused(
      GOOD "  theta: {min: 1 degree, max: 2}\n", NULL,
      "s.yaml:4:16: basin.theta.min: \"1 degree\" is not a finite decimal number; it must be a number from -1000000 to "
      "1000000 in rad, or in degrees such as 90 deg, or a part of pi such as pi/2");
  expect_refused(
      GOOD "  theta: {min: 1 deg, max: 2e9 deg}\n", NULL,
      "s.yaml:4:28: basin.theta.max: \"2e9 deg\" is out of range; it must be a number from -1000000 to 1000000 in rad, "
      "or in degrees such as 90 deg, or a part of pi such as pi/2");
  expect_refused(
      GOOD, "basin.velocity.min=-1 deg",
      "--set basin.velocity.min=-1 deg: basin.velocity.min: \"-1 deg\" is not a finite decimal number; it must be a "
      "number from -10000 to 10000 in rad per drive radian, or with its unit: rad/s, deg/s, °/s");
}

TEST(the_frequency_of_the_pivot_is_given_once) {
#define SI "pendulum: {mass: 1, radius: 1, inertia: 1, friction: 1, gravity: 1, pivot_amplitude: 1"
#define STUDY "basin: {velocity: {min: -1, max: 1}}\n"
  expect_refused(
      SI ", pivot_frequency: 10, frequency: 2}\n" STUDY, NULL,
      "s.yaml:1:121: pendulum.frequency: contradicts pivot_frequency, which gives the same; give one of them");
  expect_refused(SI "}\n" STUDY, NULL,
                 "s.yaml:1:11: pendulum.amplitude: the pendulum lacks: frequency (in Hz; or pivot_frequency in rad/s)");
}

TEST(undefined_parameters_are_nan) {
  kz_scene scene;
  assert_int_equal(read_scene(GOOD, "pendulum={k: 0, damping: 0.05, m: 0.5}", &scene), KZ_OK);
  assert_true(isnan(scene.parameters.quality_factor) && isnan(scene.parameters.drive_frequency));
  assert_true(scene.parameters.drive_amplitude == 0.5);
  kz_scene_free(&scene);
  assert_int_equal(read_scene(GOOD, "pendulum={drive_frequency: 11, drive_amplitude: 0.3}", &scene), KZ_OK);
  assert_true(scene.parameters.pendulum.beta == 0.0 && isnan(scene.parameters.quality_factor));
  kz_scene_free(&scene);
}

TEST(resolved_text_is_a_fixed_point) {
  kz_scene scene;
  assert_int_equal(read_scene("title: 'say \"a\\b\"'\n" GOOD, "numerics={scheme: rk4, tolerance: 1e-9}", &scene),
                   KZ_OK);
  char *once = resolved_text(&scene);
  kz_scene_free(&scene);
  assert_int_equal(read_scene(once, NULL, &scene), KZ_OK);
  assert_string_equal(scene.title, "say \"a\\b\"");
  char *twice = resolved_text(&scene);
  assert_string_equal(once, twice);
  assert_non_null(strstr(once, "\n  steps_per_period: auto\n"));
  free(once);
  free(twice);
  kz_scene_free(&scene);
}

TEST(options_override_and_create) {
  kz_scene scene;
  assert_int_equal(read_scene(GOOD, "basin.attractors.seed=7", &scene), KZ_OK);
  assert_int_equal(scene.basin->seed, 7);
  kz_scene_free(&scene);
  assert_int_equal(read_scene(GOOD, "basin.velocity={min: 0, max: 1, count: 3}", &scene), KZ_OK);
  assert_int_equal(scene.basin->velocity.count, 3);
  assert_true(scene.basin->velocity.min == 0.0 && scene.basin->velocity.max == 1.0);
  kz_scene_free(&scene);
}

TEST(errors_name_place_key_and_remedy) {
  expect_refused(GOOD "  methd: icm\n", NULL, "s.yaml:4:3: basin.methd: unknown key; did you mean method?");
  expect_refused(
      GOOD "  method: imc\n", NULL,
      "s.yaml:4:11: basin.method: \"imc\" is unknown; it must be one of icm, direct, exact (did you mean icm?)");
  expect_refused(
      GOOD "  max_periods: 1.5x\n", NULL,
      "s.yaml:4:16: basin.max_periods: \"1.5x\" is not a decimal number; it must be an integer from 1 to 4000000000");
  expect_refused(
      "basin: {}\n", NULL,
      "s.yaml:1:1: pendulum: is missing; it must be a mapping of quality_factor, drive_frequency, "
      "drive_amplitude, k, damping, m, length, frequency, amplitude, decay_time, gravity, mass, radius, "
      "inertia, friction, pivot_amplitude, pivot_frequency, constant_torque, oscillating_torque, "
      "beta_c, omega, i_dc, i_ac, tilt, ellipse, torque, torque_amplitude, constant_torque_ratio, torque_ratio, "
      "waveform, samples, harmonics, vertical, horizontal, ramp; also missing: basin.velocity");
  expect_refused(GOOD "  theta: {max: 1, min: 2}\n", NULL,
                 "s.yaml:4:16: basin.theta.max: 1 is too small; it must be greater than min = 2");
  expect_refused(GOOD, "basin.theta.cout=2",
                 "--set basin.theta.cout=2: basin.theta.cout: unknown key; did you mean basin.theta.count?");
  expect_refused(GOOD, "basin.theta.count=x",
                 "--set basin.theta.count=x: basin.theta.count: \"x\" is not a decimal number; it must be an integer "
                 "from 1 to 1000000");
}

/* A word that was removed is answered with the one to use. */
TEST(gone_words_name_the_new_one) {
  expect_refused(GOOD "  method: hybrid\n", NULL,
                 "s.yaml:4:11: basin.method: \"hybrid\" is unknown; it must be one of icm, direct, exact (it was "
                 "removed: use direct)");
}

/* Drives that the processed splitting does not carry are left to split6 with its own number of steps. */
TEST(numerics_fall_back) {
  kz_scene scene;
  kz_scheme scheme;
  assert_int_equal(read_scene(GOOD, "pendulum={k: 100, damping: 0.1, m: 1}", &scene), KZ_OK);
  kz_scheme_row(scene.numerics.scheme, &scheme);
  assert_string_equal(scheme.name, "split6");
  assert_true(scene.numerics.steps_per_period >= scheme.default_steps);
  kz_scene_free(&scene);
  assert_int_equal(read_scene(GOOD, "numerics={steps_per_period: 64}", &scene), KZ_OK);
  assert_int_equal(scene.numerics.steps_per_period, 64);
  assert_int_equal(scene.numerics.scheme, kz_scheme_find("processed"));
  kz_scene_free(&scene);
}

/* An error further up is told first, whichever check finds it; a missing key comes last. */
TEST(first_error_in_document_order) {
  expect_refused("basin:\n  velocity: {min: 2, max: -2}\npendulum: {k: nan}\n", NULL,
                 "s.yaml:2:27: basin.velocity.max: -2 is too small; it must be greater than min = 2");
  expect_refused("basin:\n  method: xyz\n", NULL,
                 "s.yaml:2:11: basin.method: \"xyz\" is unknown; it must be one of icm, direct, exact");
}

TEST(scalars_are_strict) {
  static const char *const bad[] = {"1.5x", "0x10",  "maybe", ".nan", ".inf", "nan", "inf",  "-inf",  "''",
                                    "'1'",  "\"1\"", "010",   "1_0",  "1e",   "e1",  ".",    "1e999", "1e-999",
                                    "--1",  "+-1",   "1 2",   "[1]",  "{}",   "~",   "null", "1e1.5"};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    char set[64];
    kz_scene scene;
    snprintf(set, sizeof set, "basin.velocity.max=%s", bad[i]);
    if (read_scene(GOOD, set, &scene) != KZ_REFUSED) fail_msg("%s was accepted", set);
    assert_non_null(strstr(kz_message(), "basin.velocity.max: "));
  }
  static const struct {
    const char *text;
    double value;
  } good[] = {{"3", 3},     {"+3.5", 3.5}, {".5", .5},   {"5.", 5},
              {"1e3", 1e3}, {"2E-1", .2},  {"0.1", 0.1}, {"5e-324", 5e-324}};
  for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
    double value;
    const kz_node node = {.kind = KZ_SCALAR, .text = (char *)good[i].text, .plain = true};
    assert_null(kz_scalar_real(&node, &value));
    assert_true(value == good[i].value);
  }
}

TEST(structure_is_strict) {
  expect_refused("", NULL, "s.yaml:1:1: scene: is empty; give a pendulum and a study");
  expect_refused("a: &x 1\n", NULL, "s.yaml:1:4: scene: an anchor (&name) stands here; write the value out");
  expect_refused("a: *x\n", NULL, "s.yaml:1:4: scene: an alias (*name) stands here; write the value out");
  expect_refused(GOOD "---\nb: 1\n", NULL,
                 "s.yaml:5:1: scene: a second YAML document begins here; a scene is a single one");
  expect_refused("[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]\n", NULL,
                 "s.yaml:1:17: scene: is nested too deeply; at most 16 levels are possible");
  expect_refused("a: 1\nb: \xff\n", NULL,
                 "s.yaml:2:4: scene: is not text (invalid leading UTF-8 octet); save the scene in UTF-8 without "
                 "control characters");
  expect_refused("title: a\ntitle: b\n" GOOD, NULL, "s.yaml:2:1: title: is given twice; give it once");
  expect_refused("pendulum: {k: 0, m: 1, mass: 3}\nbasin: {}\n", NULL,
                 "s.yaml:1:24: pendulum.mass: contradicts pendulum.k, which gives the same in another way; use the "
                 "keys of one way");
}

/* A table of its own tries the types that hold lists. */
typedef struct {
  kz_reals reals;
  kz_integers integers, words;
  bool boolean, study;
} lists;
static const kz_key list_keys[] = {
    {.path = "s", .type = KZ_KEY_MAPPING, .unit = "", .fallback = "", .offset = offsetof(lists, study), .help = ""},
    {.path = "s.r",
     .type = KZ_KEY_REALS,
     .unit = "rad",
     .low = -1,
     .high = 9,
     .fallback = "[0.5]",
     .offset = offsetof(lists, reals),
     .help = ""},
    {.path = "s.i",
     .type = KZ_KEY_INTEGERS,
     .unit = "",
     .low = 2,
     .high = 64,
     .fallback = "",
     .offset = offsetof(lists, integers),
     .help = ""},
    {.path = "s.w",
     .type = KZ_KEY_WORDS,
     .unit = "",
     .words = "red|green",
     .fallback = "[green, red]",
     .offset = offsetof(lists, words),
     .help = ""},
    {.path = "s.b",
     .type = KZ_KEY_BOOLEAN,
     .unit = "",
     .fallback = "false",
     .offset = offsetof(lists, boolean),
     .help = ""},
    {.path = NULL}};

TEST(lists_are_read_and_written) {
  static const struct {
    const char *text, *message, *written;
  } cases[] = {
      {"s: {}\n", "", "s.r: [0.5]\ns.w: [green, red]\ns.b: false\n"},
      {"s: {r: [1, 2.5], i: [2, 64], w: [red], b: true}\n", "", "s.r: [1, 2.5]\ns.i: [2, 64]\ns.w: [red]\ns.b: true\n"},
      {"s: {i: [2, 65]}\n", "f:1:12: s.i: \"65\" is out of range; it must be a list of integers from 2 to 64", NULL},
      {"s: {w: [red, gren]}\n",
       "f:1:14: s.w: \"gren\" is unknown; it must be a list out of red, green (did you mean green?)", NULL},
      {"s: {r: []}\n",
       "f:1:8: s.r: the value is an empty list; it must be a list of numbers from -1 to 9 in rad, or in degrees such "
       "as 90 "
       "deg, or a part of pi such as pi/2",
       NULL},
      {"s: {r: 1}\n",
       "f:1:8: s.r: \"1\" is not a list; it must be a list of numbers from -1 to 9 in rad, or in degrees such as 90 "
       "deg, or a "
       "part of pi such as pi/2",
       NULL},
      {"s: {b: yes}\n", "f:1:8: s.b: \"yes\" is neither true nor false; it must be true or false", NULL}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    lists scene;
    kz_reading reading = {.keys = list_keys, .scene = &scene};
    assert_int_equal(kz_tree_read(cases[i].text, strlen(cases[i].text), "f", false, &reading.root), KZ_OK);
    assert_int_equal(kz_reading_keys(&reading), KZ_OK);
    assert_string_equal(reading.message, cases[i].message);
    kz_tree_free(reading.root);
    if (!cases[i].written) continue;
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    kz_scene_write(list_keys, &scene, true, out);
    fclose(out);
    assert_string_equal(text, cases[i].written);
    free(text);
  }
}

/* Every row has a help, a default that its own range accepts, and a mapping above it in the table. */
TEST(table_is_sound) {
  kz_scene scene;
  memset(&scene, 0, sizeof scene);
  for (const kz_key *key = kz_scene_keys(); key->path; key++) {
    char parent[128];
    const char *dot = strrchr(key->path, '.');
    assert_true(key->help && key->help[0]);
    assert_ptr_equal(kz_key_find(kz_scene_keys(), key->path), key);
    snprintf(parent, sizeof parent, "%.*s", dot ? (int)(dot - key->path) : 0, key->path);
    const kz_key *above = dot ? kz_key_find(kz_scene_keys(), parent) : NULL;
    assert_true(!dot || (above && above < key && above->type == KZ_KEY_MAPPING));
  }
  assert_int_equal(read_scene(GOOD, NULL, &scene), KZ_OK);
  kz_scene_free(&scene);
}
