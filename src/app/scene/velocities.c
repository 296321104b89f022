/* Velocities per second in a scene in SI units: one pass over the tree, before its keys are read, makes them numbers of the drive. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

/* The positive number that a key gives in `unit`: NaN where it is not given, 1 where it is wrong, which is reported when the key is read. */
static double read_positive(const kz_node *root, const char *path, const char *unit) {
  const kz_node *node = kz_tree_find(root, path);
  double value;
  if (!node) return NAN;
  return kz_scalar_quantity(node, unit, &value) || !(value > 0) ? 1 : value;
}

static double pivot_frequency(const kz_node *root) {
  const double hertz = read_positive(root, "pendulum.frequency", "Hz");
  return isnan(hertz) ? read_positive(root, "pendulum.pivot_frequency", "rad s-1") : 2 * M_PI * hertz;
}

/* Whether a study changes the frequency: its pendulums have different drive radians. */
static bool frequency_changes(const kz_node *root) {
  static const char *const parameters[] = {"sweep.parameter", "chart.x.parameter", "chart.y.parameter"};
  for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++) {
    const kz_node *node = kz_tree_find(root, parameters[i]);
    if (node && node->text && (strcmp(node->text, "frequency") == 0 || strcmp(node->text, "pivot_frequency") == 0)) return true;
  }
  return false;
}

static void convert(kz_reading *reading, const char *path, kz_node *node) {
  double value;
  const char *wrong;
  if (!kz_scalar_per_second(node, pivot_frequency(reading->root), &value, &wrong)) return;
  if (!wrong && frequency_changes(reading->root)) wrong = "is per second, but the scene changes the frequency of the pivot";
  if (wrong) {
    kz_complain_at(reading, node, path, "\"%.60s\" %s; it must be a number in %s", node->text, wrong, KZ_VELOCITY_UNIT);
    return;
  }
  free(node->text);
  node->text = kz_strdup(kz_shortest(value).text);
  node->plain = true;
}

void kz_reading_velocities(kz_reading *reading) {
  for (const kz_key *key = reading->keys; key->path; key++) {
    kz_node *node = strcmp(key->unit, KZ_VELOCITY_UNIT) == 0 ? kz_tree_find(reading->root, key->path) : NULL;
    if (!node) continue;
    convert(reading, key->path, node);
    for (kz_node *item = node->kind == KZ_SEQUENCE ? node->first : NULL; item; item = item->next)
      convert(reading, key->path, item);
  }
}
