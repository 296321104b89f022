/* Values of the types of the table: cleared, read from a node, printed. */
#include <inttypes.h>

#include "scene.h"

static const char *read_text(const kz_key *key, const kz_node *node, void *field) {
  (void)key;
  const char *wrong = kz_scalar_text(node);
  if (wrong) return wrong;
  free(*(char **)field);
  *(char **)field = kz_strdup(node->text);
  return NULL;
}

static const char *find_word(const kz_key *key, const kz_node *node, int64_t *index) {
  const char *wrong = kz_scalar_text(node);
  if (wrong) return wrong;
  *index = kz_word_find(kz_key_words(key), node->text);
  return *index < 0 ? "is unknown" : NULL;
}

static const char *read_word(const kz_key *key, const kz_node *node, void *field) {
  int64_t index;
  const char *wrong = find_word(key, node, &index);
  if (!wrong) *(int32_t *)field = (int32_t)index;
  return wrong;
}

static const char *read_index(const kz_key *key, const kz_node *node, void *field) {
  return find_word(key, node, field);
}

static const char *read_boolean(const kz_key *key, const kz_node *node, void *field) {
  (void)key;
  return kz_scalar_boolean(node, field);
}

static const char *find_integer(const kz_key *key, const kz_node *node, int64_t *value) {
  const char *wrong = kz_scalar_integer(node, value);
  if (wrong) return wrong;
  return (double)*value < key->low || (double)*value > key->high ? "is out of range" : NULL;
}

static const char *read_integer(const kz_key *key, const kz_node *node, void *field) {
  int64_t value;
  const char *wrong = find_integer(key, node, &value);
  if (!wrong) *(int64_t *)field = value;
  return wrong;
}

static const char *read_count(const kz_key *key, const kz_node *node, void *field) {
  int64_t value;
  if (key->words && node->kind == KZ_SCALAR && strcmp(node->text, key->words) == 0) {
    *(int32_t *)field = 0;
    return NULL;
  }
  const char *wrong = find_integer(key, node, &value);
  if (!wrong) *(int32_t *)field = (int32_t)value;
  return wrong;
}

/* A value of a key that another key names: its unit is not known yet. */
static const char *read_any(const kz_node *node, double *value) {
  const char *wrong = kz_scalar_quantity(node, "", value);
  return wrong && !kz_scalar_angle(node, value) ? NULL : wrong;
}

static const char *read_real(const kz_key *key, const kz_node *node, void *field) {
  double value;
  const char *wrong = kz_key_is_angle(key)                  ? kz_scalar_angle(node, &value)
                      : kz_unit_is_known(key->unit)         ? kz_scalar_quantity(node, key->unit, &value)
                      : strcmp(key->unit, KZ_OWN_UNIT) == 0 ? read_any(node, &value)
                                                            : kz_scalar_real(node, &value);
  if (wrong) return wrong;
  if (value < key->low || value > key->high) return "is out of range";
  *(double *)field = value;
  return NULL;
}

static const char *read_decimal(const kz_key *key, const kz_node *node, void *field) {
  kz_decimal value;
  const char *wrong = kz_scalar_decimal(node, kz_key_is_angle(key), &value);
  if (wrong) return wrong;
  if (value.high < key->low || value.high > key->high) return "is out of range";
  *(kz_decimal *)field = value;
  return NULL;
}

/* A number of one key of a harmonic; `fallback` where it is not there. */
static const char *read_part(const kz_node *harmonic, const char *name, bool angle, double fallback, double *value) {
  const kz_node *node = kz_tree_child(harmonic, name);
  *value = fallback;
  if (!node) return isnan(fallback) ? "has no order or no amplitude" : NULL;
  return (angle ? kz_scalar_angle : kz_scalar_real)(node, value);
}

static const char *read_harmonic(const kz_key *key, const kz_node *node, void *field) {
  (void)key;
  kz_harmonic *harmonic = field;
  double order;
  if (node->kind != KZ_MAPPING) return "is not a mapping";
  for (const kz_node *part = node->first; part; part = part->next)
    if (strcmp(part->name, "order") != 0 && strcmp(part->name, "amplitude") != 0 && strcmp(part->name, "phase") != 0)
      return "has a key that is none of order, amplitude, phase";
  const char *wrong = read_part(node, "order", false, NAN, &order);
  if (!wrong) wrong = read_part(node, "amplitude", false, NAN, &harmonic->amplitude);
  if (!wrong) wrong = read_part(node, "phase", true, 0, &harmonic->phase);
  if (wrong) return wrong;
  if (order != rint(order) || order < 1 || order > KZ_HARMONICS)
    return "has an order that is no integer from 1 to " KZ_STRINGIFY(KZ_HARMONICS);
  harmonic->order = (int64_t)order;
  return NULL;
}

static void print_named(const kz_key *key, int64_t index, FILE *out) {
  const char *words = kz_key_words(key), *word;
  int length;
  while ((word = kz_words_next(&words, &length)) && index > 0) index--;
  if (word) fprintf(out, "%.*s", length, word);
}

static void print_word(const kz_key *key, const void *value, FILE *out) {
  print_named(key, *(const int32_t *)value, out);
}

static void print_index(const kz_key *key, const void *value, FILE *out) {
  print_named(key, *(const int64_t *)value, out);
}

static void print_boolean(const kz_key *key, const void *value, FILE *out) {
  (void)key;
  fputs(*(const bool *)value ? "true" : "false", out);
}

static void print_integer(const kz_key *key, const void *value, FILE *out) {
  (void)key;
  fprintf(out, "%" PRId64, *(const int64_t *)value);
}

static void print_count(const kz_key *key, const void *value, FILE *out) {
  const int32_t count = *(const int32_t *)value;
  if (key->words && count == 0)
    fputs(key->words, out);
  else
    fprintf(out, "%" PRId32, count);
}

/* With its unit where the number alone would be refused. */
static void print_real(const kz_key *key, const void *value, FILE *out) {
  const double number = *(const double *)value;
  fprintf(out, fabs(number) > kz_key_most_bare(key) ? "%s m" : "%s", kz_shortest(number).text);
}

/* Prints the text in double quotes; only quotes and backslashes need escapes in what may stand in one. */
static void print_quoted(const char *text, FILE *out) {
  fputc('"', out);
  for (; *text; text++) fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
  fputc('"', out);
}

static void print_text(const kz_key *key, const void *value, FILE *out) {
  (void)key;
  print_quoted(*(char *const *)value, out);
}

static void print_decimal(const kz_key *key, const void *value, FILE *out) {
  (void)key;
  print_quoted(((const kz_decimal *)value)->text, out);
}

static void print_harmonic(const kz_key *key, const void *value, FILE *out) {
  const kz_harmonic *harmonic = value;
  fprintf(out, "{\"order\": %" PRId64 ", \"amplitude\": ", harmonic->order);
  print_real(key, &harmonic->amplitude, out);
  fputs(", \"phase\": ", out);
  print_real(key, &harmonic->phase, out);
  fputc('}', out);
}

/* First bytes of a field that is not given. */
static const bool no_flag = false;
static char *const no_text = NULL;
static const int32_t no_word = KZ_UNSET_WORD;
static const int64_t no_integer = KZ_UNSET_INTEGER, no_items = 0;
static const double no_real = NAN;
_Static_assert(offsetof(kz_decimal, text) == 0 && offsetof(kz_reals, count) == 0 && offsetof(kz_integers, count) == 0 &&
                   offsetof(kz_harmonics, count) == 0,
               "a field that is not given is recognised by its first bytes");

/* How one value of each type, or one value of a list, is read and printed. */
static const struct {
  const char *(*read)(const kz_key *key, const kz_node *node, void *value);
  void (*print)(const kz_key *key, const void *value, FILE *out);
  const void *unset;
  size_t unset_bytes;
  size_t first, bytes; /* Offset of the first value of a list; bytes of a value */
} types[] = {
    [KZ_KEY_MAPPING] = {NULL, NULL, &no_flag, sizeof no_flag, 0, 0},
    [KZ_KEY_TEXT] = {read_text, print_text, &no_text, sizeof no_text, 0, 0},
    [KZ_KEY_WORD] = {read_word, print_word, &no_word, sizeof no_word, 0, 0},
    [KZ_KEY_BOOLEAN] = {read_boolean, print_boolean, &no_flag, sizeof no_flag, 0, 0},
    [KZ_KEY_INTEGER] = {read_integer, print_integer, &no_integer, sizeof no_integer, 0, 0},
    [KZ_KEY_COUNT] = {read_count, print_count, &no_word, sizeof no_word, 0, 0},
    [KZ_KEY_REAL] = {read_real, print_real, &no_real, sizeof no_real, 0, 0},
    [KZ_KEY_DECIMAL] = {read_decimal, print_decimal, "", 1, 0, 0},
#define LIST(type) &no_items, sizeof no_items, offsetof(type, values), sizeof((type *)0)->values[0]
    [KZ_KEY_WORDS] = {read_index, print_index, LIST(kz_integers)},
    [KZ_KEY_INTEGERS] = {read_integer, print_integer, LIST(kz_integers)},
    [KZ_KEY_REALS] = {read_real, print_real, LIST(kz_reals)},
    [KZ_KEY_HARMONICS] = {read_harmonic, print_harmonic, LIST(kz_harmonics)},
#undef LIST
};

static bool is_list(const kz_key *key) {
  return key->type >= KZ_KEY_WORDS;
}

/* The field of a key, in the scene or in one of its plans. */
static void *field_of(const kz_key *key, const void *scene) {
  char *holder = key->plan ? *(char *const *)((const char *)scene + key->plan) : (char *)scene;
  return holder + key->offset;
}

bool kz_value_is_given(const kz_key *key, const void *scene) {
  return key->type != KZ_KEY_MAPPING || key->offset == KZ_NO_FIELD || *(const bool *)field_of(key, scene);
}

void kz_value_give(const kz_key *mapping, void *scene) {
  if (mapping->offset != KZ_NO_FIELD) *(bool *)field_of(mapping, scene) = true;
}

static const char *read_list(const kz_key *key, const kz_node *node, void *list, const kz_node **culprit) {
  if (node->kind != KZ_SEQUENCE) return "is not a list";
  int64_t *count = list;
  *count = 0;
  for (*culprit = node->first; *culprit; *culprit = (*culprit)->next) {
    if (key->type == KZ_KEY_HARMONICS && *count == KZ_HARMONICS)
      return "is one harmonic too many (at most " KZ_STRINGIFY(KZ_HARMONICS) ")";
    if (*count == KZ_LIST_MAX) return "is one value too many (at most " KZ_STRINGIFY(KZ_LIST_MAX) ")";
    void *value = (char *)list + types[key->type].first + (size_t)(*count)++ * types[key->type].bytes;
    const char *wrong = types[key->type].read(key, *culprit, value);
    if (wrong) return wrong;
  }
  *culprit = node;
  return *count > 0 ? NULL : "is an empty list";
}

const char *kz_value_read(const kz_key *key, const kz_node *node, void *scene, const kz_node **culprit) {
  void *field = field_of(key, scene);
  *culprit = node;
  return is_list(key) ? read_list(key, node, field, culprit) : types[key->type].read(key, node, field);
}

/* Marks the field as not given. */
static void value_clear(const kz_key *key, void *scene) {
  if (key->offset != KZ_NO_FIELD) memcpy(field_of(key, scene), types[key->type].unset, types[key->type].unset_bytes);
}

kz_status kz_value_default(const kz_key *key, void *scene) {
  value_clear(key, scene);
  if (key->type == KZ_KEY_MAPPING || !key->fallback || !key->fallback[0]) return KZ_OK;
  kz_node *node;
  const kz_node *culprit;
  KZ_TRY(kz_tree_read(key->fallback, strlen(key->fallback), key->path, true, &node));
  const char *wrong = kz_value_read(key, node, scene, &culprit);
  kz_tree_free(node);
  return wrong ? kz_fail(KZ_FAILED, "%s: its default %s", key->path, wrong) : KZ_OK;
}

bool kz_value_is_set(const kz_key *key, const void *scene) {
  if (key->offset == KZ_NO_FIELD || key->type == KZ_KEY_BOOLEAN) return key->offset != KZ_NO_FIELD;
  const void *field = field_of(key, scene);
  if (key->type == KZ_KEY_REAL) return !isnan(*(const double *)field);
  return memcmp(field, types[key->type].unset, types[key->type].unset_bytes) != 0;
}

void kz_value_print(const kz_key *key, const void *scene, FILE *out) {
  const char *field = field_of(key, scene), *value = field + types[key->type].first;
  if (!is_list(key)) {
    types[key->type].print(key, field, out);
    return;
  }
  for (int64_t i = 0; i < *(const int64_t *)field; i++) {
    fputs(i == 0 ? "[" : ", ", out);
    types[key->type].print(key, value + (size_t)i * types[key->type].bytes, out);
  }
  fputc(']', out);
}
