/* Reads the tree of a scene into kz_scene, key by key of the table. */
#include <limits.h>
#include <stdarg.h>

#include "scene.h"

/* "FILE:LINE:COLUMN" or the option. */
static void print_place(const kz_node *node, bool at_name, char *text, size_t bytes) {
  const int line = at_name ? node->name_line : node->line;
  const int column = at_name ? node->name_column : node->column;
  if (line > 0)
    snprintf(text, bytes, "%s:%d:%d", node->source, line, column);
  else
    snprintf(text, bytes, "%s", node->source);
}

/* The deepest mapping on the way to `path` that the scene has. */
static const kz_node *nearest_mapping(const kz_node *root, const char *path) {
  const kz_node *node = root;
  char name[64];
  for (size_t length; path[length = strcspn(path, ".")] == '.'; path += length + 1) {
    snprintf(name, sizeof name, "%.*s", (int)length, path);
    const kz_node *child = kz_tree_child(node, name);
    if (!child) break;
    node = child;
  }
  return node;
}

/* Keeps a complaint at the value or key of `node`; NULL: at the mapping that lacks `path`, after all others. */
static void reading_complain(kz_reading *reading, const kz_node *node, bool at_name, const char *path,
                             const char *format, va_list arguments) {
  const int order = node ? node->order : INT_MAX - 1;
  if (order >= reading->first) return;
  reading->first = order;
  char place[1200];
  print_place(node ? node : nearest_mapping(reading->root, path), at_name, place, sizeof place);
  const int length = snprintf(reading->message, sizeof reading->message, "%s: %s: ", place, path);
  if (length >= 0 && (size_t)length < sizeof reading->message)
    vsnprintf(reading->message + length, sizeof reading->message - (size_t)length, format, arguments);
}

#define COMPLAIN(reading, node, at_name, path, format)                 \
  do {                                                                 \
    va_list arguments;                                                 \
    va_start(arguments, format);                                       \
    reading_complain(reading, node, at_name, path, format, arguments); \
    va_end(arguments);                                                 \
  } while (0)

void kz_complain(kz_reading *reading, const char *path, const char *format, ...) {
  COMPLAIN(reading, kz_tree_find(reading->root, path), false, path, format);
}

void kz_complain_at(kz_reading *reading, const kz_node *node, const char *path, const char *format, ...) {
  COMPLAIN(reading, node, false, path, format);
}

__attribute__((format(printf, 4, 5))) static void complain_key(kz_reading *reading, const kz_node *node,
                                                               const char *path, const char *format, ...) {
  COMPLAIN(reading, node, true, path, format);
}

/* Complains about a value: what is wrong with it, what would be accepted. */
static void complain_value(kz_reading *reading, const kz_key *key, const kz_node *node, const char *wrong) {
  char accepted[700], nearest[64], hint[96] = "", path[256];
  snprintf(path, sizeof path, "%s.%.60s", key->path, node->kind == KZ_SCALAR ? node->text : "");
  const char *of_word = kz_key_missing_power(path), *power = of_word ? of_word : kz_key_missing_power(key->path);
  kz_key_accepts(reading->keys, key, accepted, sizeof accepted);
  if (node->kind == KZ_SCALAR && kz_key_renamed(key, node->text, nearest, sizeof nearest))
    snprintf(hint, sizeof hint, " (it was removed: use %s)", nearest);
  else if (node->kind == KZ_SCALAR && kz_scalar_with_a_point(node->text, nearest, sizeof nearest))
    snprintf(hint, sizeof hint, " (with a decimal point: %s)", nearest);
  else if (power)
    snprintf(hint, sizeof hint, " (%s the power %s, which this build leaves out)",
             of_word ? "it needs" : "other words need", power);
  else if (node->kind == KZ_SCALAR && kz_key_suggest(node->text, kz_key_words(key), nearest, sizeof nearest))
    snprintf(hint, sizeof hint, strcmp(wrong, "is not a list") == 0 ? " (did you mean [%s]?)" : " (did you mean %s?)",
             nearest);
  if (node->kind == KZ_SCALAR && node->text[0])
    kz_complain_at(reading, node, key->path, "\"%.60s\" %s; it must be %s%s", node->text, wrong, accepted, hint);
  else
    kz_complain_at(reading, node, key->path, "the value %s; it must be %s", wrong, accepted);
}

/* "0,3" in a flow mapping is the number 0 and a key 3 without a value. */
static bool is_decimal_comma(const kz_node *node) {
  return node->kind == KZ_SCALAR && !node->text[0] && node->name[0] &&
         node->name[strspn(node->name, "0123456789")] == '\0';
}

static void complain_unknown(kz_reading *reading, const kz_node *node, const char *parent, const char *path) {
  char wrong[1200] = "is no key; a number takes a decimal point (0.3), and a comma ends it";
  if (!is_decimal_comma(node)) kz_key_unknown(reading->keys, parent, node->name, "", wrong, sizeof wrong);
  complain_key(reading, node, path, "%s", wrong);
}

static void read_mapping(kz_reading *reading, const kz_node *mapping, const char *parent);

static void read_key(kz_reading *reading, const kz_key *key, const kz_node *node) {
  const kz_node *culprit = node;
  const char *wrong = NULL;
  if (key->type != KZ_KEY_MAPPING) {
    wrong = kz_value_read(key, node, reading->scene, &culprit);
  } else if (node->kind == KZ_MAPPING) {
    kz_value_give(key, reading->scene);
    read_mapping(reading, node, key->path);
  } else {
    wrong = node->kind == KZ_SCALAR && !node->text[0] ? "is empty" : "is not a mapping";
  }
  if (wrong) complain_value(reading, key, culprit, wrong);
}

/* The first key of one form alone, else the first of several: it chooses the form. NULL if there is none. */
static const kz_key *form_chooser(const kz_key *keys, const kz_node *mapping, const char *parent) {
  const kz_key *several = NULL;
  for (const kz_node *child = mapping->first; child; child = child->next) {
    char path[256];
    snprintf(path, sizeof path, "%s.%.100s", parent, child->name);
    const kz_key *key = kz_key_find(keys, path);
    if (key && key->form && !key->form[1]) return key;
    if (key && key->form && !several) several = key;
  }
  return several;
}

/* First key that gives something in another way than `key`: the chooser, or one before `child`. NULL: none. */
static const kz_key *other_way(const kz_key *keys, const kz_node *mapping, const kz_node *child, const char *parent,
                               const kz_key *key) {
  if (!key || !key->form) return NULL;
  const kz_key *chooser = form_chooser(keys, mapping, parent);
  if (!strpbrk(chooser->form, key->form)) return chooser;
  for (const kz_node *before = mapping->first; before != child; before = before->next) {
    char path[256];
    snprintf(path, sizeof path, "%s.%.100s", parent, before->name);
    const kz_key *found = kz_key_find(keys, path);
    if (found && found->form && !strpbrk(found->form, key->form)) return found;
  }
  return NULL;
}

static void read_child(kz_reading *reading, const kz_node *mapping, const kz_node *child, const char *parent) {
  char path[256];
  snprintf(path, sizeof path, "%s%s%.100s", parent, parent[0] ? "." : "", child->name);
  const kz_key *key = kz_key_find(reading->keys, path);
  const kz_key *other = other_way(reading->keys, mapping, child, parent, key);
  if (kz_tree_child(mapping, child->name) != child)
    complain_key(reading, child, path, "is given twice; give it once");
  else if (!key)
    complain_unknown(reading, child, parent, path);
  else if (other)
    complain_key(reading, child, path, "contradicts %s, which gives the same in another way; use the keys of one way",
                 other->path);
  else
    read_key(reading, key, child);
}

/* Stops at the first complaint, because later parts of the document cannot come before it. */
static void read_mapping(kz_reading *reading, const kz_node *mapping, const char *parent) {
  for (const kz_node *child = mapping->first; child && child->order < reading->first; child = child->next)
    read_child(reading, mapping, child, parent);
}

/* The mapping that should hold `key`, or NULL where it is not there. */
static const kz_node *reading_holder(const kz_reading *reading, const kz_key *key, char *parent, size_t bytes) {
  const char *dot = strrchr(key->path, '.');
  snprintf(parent, bytes, "%.*s", dot ? (int)(dot - key->path) : 0, key->path);
  const kz_node *node = dot ? kz_tree_find(reading->root, parent) : reading->root;
  return node && node->kind == KZ_MAPPING ? node : NULL;
}

/* The study stability has its own values of k, m and damping: a scene of it alone needs no pendulum. */
static bool needs_no_pendulum(const kz_reading *reading) {
  for (const kz_key *key = reading->keys; key->path; key++) {
    const bool study = key->type == KZ_KEY_MAPPING && key->offset != KZ_NO_FIELD;
    if (study && strcmp(key->path, "stability") != 0 && kz_tree_find(reading->root, key->path)) return false;
  }
  return kz_tree_child(reading->root, "stability") != NULL;
}

static bool is_missing(const kz_reading *reading, const kz_key *key) {
  char parent[256];
  const kz_node *mapping = reading_holder(reading, key, parent, sizeof parent);
  if (!mapping || key->fallback || kz_tree_find(reading->root, key->path)) return false;
  if (strcmp(key->path, "pendulum") == 0 && needs_no_pendulum(reading)) return false;
  const kz_key *chooser = key->form ? form_chooser(reading->keys, mapping, parent) : NULL;
  return !chooser || strpbrk(chooser->form, key->form);
}

/* One complaint: about the first missing key, with the names of the others. */
static void check_missing(kz_reading *reading) {
  char accepted[700], others[512] = "";
  const kz_key *first = NULL;
  for (const kz_key *key = reading->keys; key->path; key++) {
    if (!is_missing(reading, key)) continue;
    const size_t used = strlen(others);
    if (first)
      snprintf(others + used, sizeof others - used, "%s%s", used ? ", " : "; also missing: ", key->path);
    else
      first = key;
  }
  if (!first) return;
  kz_key_accepts(reading->keys, first, accepted, sizeof accepted);
  kz_complain(reading, first->path, "is missing; it must be %s%s", accepted, others);
}

/* A key beside the number that answers it. */
static void check_chosen(kz_reading *reading, const kz_key *key) {
  const kz_node *node = key->chosen_by ? kz_tree_find(reading->root, key->path) : NULL;
  if (node && kz_tree_find(reading->root, key->chosen_by))
    complain_key(reading, node, key->path, "contradicts %s, which chooses it; give one of them", key->chosen_by);
}

/* A top-level mapping with a field is a study: at least one is needed. */
static void check_studies(kz_reading *reading) {
  char names[512] = "";
  for (const kz_key *key = reading->keys; key->path; key++) {
    if (key->type != KZ_KEY_MAPPING || key->offset == KZ_NO_FIELD || strchr(key->path, '.')) continue;
    if (kz_tree_child(reading->root, key->path)) return;
    snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", names[0] ? ", " : "", key->path);
  }
  kz_complain_at(reading, NULL, "scene", "asks for no study; give at least one of: %s", names);
}

static void number_nodes(kz_node *node, int *next) {
  for (; node; node = node->next) {
    node->order = (*next)++;
    number_nodes(node->first, next);
  }
}

/* Positive number of a key in `unit`; NaN if not given, 1 if wrong, which reading the key reports. */
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
  static const char *const parameters[] = {"sweep.parameter", "sweep.x.parameter", "sweep.y.parameter"};
  for (size_t i = 0; i < sizeof parameters / sizeof *parameters; i++) {
    const kz_node *node = kz_tree_find(root, parameters[i]);
    if (node && node->text && (strcmp(node->text, "frequency") == 0 || strcmp(node->text, "pivot_frequency") == 0))
      return true;
  }
  return false;
}

static void reading_convert(kz_reading *reading, const char *path, kz_node *node) {
  double value;
  const char *wrong;
  if (!kz_scalar_per_second(node, pivot_frequency(reading->root), &value, &wrong)) return;
  if (!wrong && frequency_changes(reading->root))
    wrong = "is per second, but the scene changes the frequency of the pivot";
  if (wrong) {
    kz_complain_at(reading, node, path, "\"%.60s\" %s; it must be a number in %s", node->text, wrong, KZ_VELOCITY_UNIT);
    return;
  }
  free(node->text);
  node->text = kz_strdup(kz_shortest(value).text);
  node->plain = true;
}

/* Velocities per second in a scene in SI units become numbers of the drive before the keys are read. */
static void read_velocities(kz_reading *reading) {
  for (const kz_key *key = reading->keys; key->path; key++) {
    kz_node *node = strcmp(key->unit, KZ_VELOCITY_UNIT) == 0 ? kz_tree_find(reading->root, key->path) : NULL;
    if (!node) continue;
    reading_convert(reading, key->path, node);
    for (kz_node *item = node->kind == KZ_SEQUENCE ? node->first : NULL; item; item = item->next)
      reading_convert(reading, key->path, item);
  }
}

kz_status kz_reading_keys(kz_reading *reading) {
  int next = 0;
  reading->first = INT_MAX;
  number_nodes(reading->root, &next);
  for (const kz_key *key = reading->keys; key->path; key++) KZ_TRY(kz_value_default(key, reading->scene));
  if (reading->root->kind != KZ_MAPPING) {
    kz_complain_at(reading, reading->root, "scene",
                   "is not a mapping; write lines such as \"pendulum: {k: 0, damping: 0.05, m: 0.5}\"");
    return KZ_OK;
  }
  read_velocities(reading);
  read_mapping(reading, reading->root, "");
  check_missing(reading);
  for (const kz_key *key = reading->keys; key->path; key++) check_chosen(reading, key);
  check_studies(reading);
  return KZ_OK;
}
