/* Mutated scenes: each is read or refused in one line that names the file; what is read has a resolved text that is a
 * fixed point. KZ_FUZZ_INPUTS sets the number of inputs (default 6000, with sanitizers 1500), KZ_FUZZ_SEED the random
 * numbers. */
#include "../../tools/test.h"

#include <stdlib.h>
#include <string.h>

#include "../../tools/part.h"
#include "../../tools/resolved.h"
#include "scene/scene.h"

enum { LONGEST = 4096 };

static const char seed[] =
    "title: \"a 'b'\"  # words\npendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.300}\n"
    "numerics:\n  scheme: split6\n  steps_per_period: 24\nbasin:\n  theta: {min: -1, max: 1, count: 10}\n"
    "  velocity: {min: -2, max: 2, count: 1000}\n  method: icm\n  icm: {theta: 100, velocity: 100, interpolation: "
    "quintic}\n"
    "  max_periods: 2000\n  attractors: {starts: 8192, max_period: 48, seed: 1}\n";

/* Texts that a scene may not hold, or holds elsewhere. clang-format would give each a line of its own. */
/* clang-format off */
static const char *const pieces[] = {
    "&a ", "*a", "!!int ", "---\n", "...\n", "%YAML 1.1\n", "<<: ", "- ", "? ", "{", "}", "[", "]", ": ", "|\n", ">-\n",
    "'", "\"", "\\0", "\t", "\r\n", "#", "\1", "\xef\xbb\xbf", "\xff", "\xc2\x85", "\xe2\x80\xa8",
    "1e999", "-0", ".nan", "0x1", "99999999999999999999", "~", "true", "k: 0, damping: 0, m: 1", "basin: {}\n"};
/* clang-format on */

/* xorshift64* (Vigna 2016). */
static uint64_t state;
static size_t scene_fuzz_draw(size_t n) {
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return (size_t)((state * 2685821657736338717u) >> 33) % n;
}

/* Replaces `cut` bytes at `at` by `piece`; returns the new length. */
static size_t scene_fuzz_splice(char *text, size_t length, size_t at, size_t cut, const char *piece, size_t n) {
  if (cut > length - at) cut = length - at;
  if (length - cut + n >= LONGEST) return length;
  memmove(text + at + n, text + at + cut, length - at - cut);
  memcpy(text + at, piece, n);
  return length - cut + n;
}

static size_t scene_fuzz_mutate(char *text, size_t length) {
  char copy[64];
  const size_t at = scene_fuzz_draw(length + 1);
  const char *piece = pieces[scene_fuzz_draw(sizeof pieces / sizeof pieces[0])];
  const char byte = (char)scene_fuzz_draw(256);
  const size_t from = scene_fuzz_draw(length + 1), n = scene_fuzz_draw(length - from + 1) % sizeof copy;
  switch (scene_fuzz_draw(5)) {
    case 0:
      return scene_fuzz_splice(text, length, at, 1, &byte, 1);
    case 1:
      return scene_fuzz_splice(text, length, at, scene_fuzz_draw(20), "", 0);
    case 2:
      memcpy(copy, text + from, n);
      return scene_fuzz_splice(text, length, at, 0, copy, n);
    default:
      return scene_fuzz_splice(text, length, at, scene_fuzz_draw(3), piece, strlen(piece));
  }
}

static void check_fixed_point(kz_scene *scene) {
  char *once = resolved_text(scene);
  kz_scene_free(scene);
  if (kz_scene_read(once, strlen(once), "resolved", 0, NULL, scene) != KZ_OK) fail_msg("%s in\n%s", kz_message(), once);
  char *twice = resolved_text(scene);
  assert_string_equal(once, twice);
  free(once);
  free(twice);
}

static void check_input(const char *text, size_t length) {
  kz_scene scene;
  char *exact = malloc(length + 1); /* a block of its own, so that the sanitizer sees a read past the end */
  memcpy(exact, text, length);
  kz_message_clear();
  const kz_status status = kz_scene_read(exact, length, "f.yaml", 0, NULL, &scene);
  free(exact);
  if (status == KZ_OK) {
    check_fixed_point(&scene);
    kz_scene_free(&scene);
  } else if (status != KZ_REFUSED || strncmp(kz_message(), "f.yaml:", 7) != 0 || !strchr(kz_message(), ';')) {
    fail_msg("%s for\n%.*s", kz_message(), (int)length, text);
  }
}

static size_t scene_fuzz_number(const char *name, size_t otherwise) {
  const char *value = getenv(name);
  return value ? strtoull(value, NULL, 10) : otherwise;
}

TEST(mutated_scenes_are_read_or_refused) {
  state = scene_fuzz_number("KZ_FUZZ_SEED", 1) * 2654435769u + 1;
  size_t read = 0;
  for (size_t i = scene_fuzz_number("KZ_FUZZ_INPUTS", PART > 1 ? 1500 : 6000); i > 0; i--) {
    char text[LONGEST];
    size_t length = sizeof seed - 1;
    memcpy(text, seed, length);
    for (size_t changes = scene_fuzz_draw(6); changes > 0; changes--) length = scene_fuzz_mutate(text, length);
    check_input(text, length);
    read += kz_message()[0] == '\0';
  }
  assert_true(read > 0);
}
