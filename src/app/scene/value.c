/* Values of the types of the table: cleared, read from a node, printed. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene.h"

static const char *read_text(const kz_key *key, const kz_node *node, void *field) {
  (void)key;
  const char *wrong = kz_scalar_text(node);
  if (wrong) return wrong;
  char *copy = kz_strdup(node->text);
  if (!copy) return "does not fit in memory";
  free(*(char **)field);
  *(char **)field = copy;
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

static const char *read_real(const kz_key *key, const kz_node *node, void *field) {
  double value;
  const char *wrong = kz_key_is_angle(key)                  ? kz_scalar_angle(node, &value)
                      : kz_unit_is_known(key->unit)         ? kz_scalar_quantity(node, key->unit, &value)
                      : strcmp(key->unit, KZ_OWN_UNIT) == 0 ? kz_scalar_quantity(node, "", &value)
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
  if (order != rint(order) || order < 1 || order > KZ_HARMONICS) return "has an order that is no integer from 1 to 16";
  harmonic->order = (int64_t)order;
  return NULL;
}

typedef const char *(*read_function)(const kz_key *key, const kz_node *node, void *field);

/* One value, or one value of a list, by the type of its key. */
static const read_function readers[] = {
    [KZ_KEY_TEXT] = read_text,       [KZ_KEY_WORD] = read_word,          [KZ_KEY_BOOLEAN] = read_boolean,
    [KZ_KEY_INTEGER] = read_integer, [KZ_KEY_COUNT] = read_count,        [KZ_KEY_REAL] = read_real,
    [KZ_KEY_DECIMAL] = read_decimal, [KZ_KEY_WORDS] = read_index,        [KZ_KEY_INTEGERS] = read_integer,
    [KZ_KEY_REALS] = read_real,      [KZ_KEY_HARMONICS] = read_harmonic,
};

static bool is_list(const kz_key *key) {
  return key->type >= KZ_KEY_WORDS;
}

/* The count and value i of a list: kz_reals, or kz_integers. */
static int64_t *count_of(const kz_key *key, void *list) {
  if (key->type == KZ_KEY_HARMONICS) return &((kz_harmonics *)list)->count;
  return key->type == KZ_KEY_REALS ? &((kz_reals *)list)->count : &((kz_integers *)list)->count;
}

static void *value_of(const kz_key *key, void *list, int64_t i) {
  if (key->type == KZ_KEY_HARMONICS) return &((kz_harmonics *)list)->values[i];
  return key->type == KZ_KEY_REALS ? (void *)&((kz_reals *)list)->values[i] : (void *)&((kz_integers *)list)->values[i];
}

static const char *read_list(const kz_key *key, const kz_node *node, void *list, const kz_node **culprit) {
  if (node->kind != KZ_SEQUENCE) return "is not a list";
  int64_t *count = count_of(key, list);
  *count = 0;
  for (*culprit = node->first; *culprit; *culprit = (*culprit)->next) {
    if (key->type == KZ_KEY_HARMONICS && *count == KZ_HARMONICS) return "is one harmonic too many (at most 16)";
    if (*count == KZ_LIST_MAX) return "is one value too many (at most 256)";
    const char *wrong = readers[key->type](key, *culprit, value_of(key, list, (*count)++));
    if (wrong) return wrong;
  }
  *culprit = node;
  return *count > 0 ? NULL : "is an empty list";
}

const char *kz_value_read(const kz_key *key, const kz_node *node, void *scene, const kz_node **culprit) {
  void *field = (char *)scene + key->offset;
  *culprit = node;
  return is_list(key) ? read_list(key, node, field, culprit) : readers[key->type](key, node, field);
}

void kz_value_clear(const kz_key *key, void *scene) {
  if (key->offset == KZ_NO_FIELD) return;
  void *field = (char *)scene + key->offset;
  switch (key->type) {
    case KZ_KEY_MAPPING:
    case KZ_KEY_BOOLEAN:
      *(bool *)field = false;
      break;
    case KZ_KEY_TEXT:
      *(char **)field = NULL;
      break;
    case KZ_KEY_WORD:
    case KZ_KEY_COUNT:
      *(int32_t *)field = KZ_UNSET_WORD;
      break;
    case KZ_KEY_INTEGER:
      *(int64_t *)field = KZ_UNSET_INTEGER;
      break;
    case KZ_KEY_REAL:
      *(double *)field = NAN;
      break;
    case KZ_KEY_DECIMAL:
      *(kz_decimal *)field = (kz_decimal){.text = ""};
      break;
    default:
      *count_of(key, field) = 0;
  }
}

static bool is_set(const kz_key *key, const void *field) {
  switch (key->type) {
    case KZ_KEY_MAPPING:
      return false;
    case KZ_KEY_BOOLEAN:
      return true;
    case KZ_KEY_TEXT:
      return *(char *const *)field != NULL;
    case KZ_KEY_WORD:
    case KZ_KEY_COUNT:
      return *(const int32_t *)field != KZ_UNSET_WORD;
    case KZ_KEY_INTEGER:
      return *(const int64_t *)field != KZ_UNSET_INTEGER;
    case KZ_KEY_REAL:
      return !isnan(*(const double *)field);
    case KZ_KEY_DECIMAL:
      return ((const kz_decimal *)field)->text[0] != '\0';
    default:
      return *count_of(key, (void *)field) > 0;
  }
}

bool kz_value_is_set(const kz_key *key, const void *scene) {
  return key->offset != KZ_NO_FIELD && is_set(key, (const char *)scene + key->offset);
}

static void print_word(const kz_key *key, int64_t index, FILE *out) {
  const char *word = kz_key_words(key);
  for (; index > 0; index--) word += strcspn(word, "|") + 1;
  fprintf(out, "%.*s", (int)strcspn(word, "|"), word);
}

static void print_real(double value, FILE *out) {
  char text[32];
  kz_scalar_print(value, text);
  fputs(text, out);
}

void kz_text_print(const char *text, FILE *out) {
  fputc('"', out);
  for (; *text; text++) fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
  fputc('"', out);
}

static void print_harmonic(const kz_harmonic *harmonic, FILE *out) {
  fprintf(out, "{\"order\": %" PRId64 ", \"amplitude\": ", harmonic->order);
  print_real(harmonic->amplitude, out);
  fputs(", \"phase\": ", out);
  print_real(harmonic->phase, out);
  fputc('}', out);
}

static void print_list(const kz_key *key, const void *field, FILE *out) {
  const int64_t count = *count_of(key, (void *)field);
  for (int64_t i = 0; i < count; i++) {
    const void *value = value_of(key, (void *)field, i);
    fputs(i == 0 ? "[" : ", ", out);
    if (key->type == KZ_KEY_WORDS) print_word(key, *(const int64_t *)value, out);
    if (key->type == KZ_KEY_INTEGERS) fprintf(out, "%" PRId64, *(const int64_t *)value);
    if (key->type == KZ_KEY_REALS) print_real(*(const double *)value, out);
    if (key->type == KZ_KEY_HARMONICS) print_harmonic(value, out);
  }
  fputc(']', out);
}

void kz_value_print(const kz_key *key, const void *scene, FILE *out) {
  const void *field = (const char *)scene + key->offset;
  switch (key->type) {
    case KZ_KEY_MAPPING:
      break;
    case KZ_KEY_BOOLEAN:
      fputs(*(const bool *)field ? "true" : "false", out);
      break;
    case KZ_KEY_TEXT:
      kz_text_print(*(char *const *)field, out);
      break;
    case KZ_KEY_WORD:
      print_word(key, *(const int32_t *)field, out);
      break;
    case KZ_KEY_COUNT:
      if (key->words && *(const int32_t *)field == 0)
        fputs(key->words, out);
      else
        fprintf(out, "%" PRId32, *(const int32_t *)field);
      break;
    case KZ_KEY_INTEGER:
      fprintf(out, "%" PRId64, *(const int64_t *)field);
      break;
    case KZ_KEY_REAL:
      print_real(*(const double *)field, out);
      break;
    case KZ_KEY_DECIMAL:
      kz_text_print(((const kz_decimal *)field)->text, out);
      break;
    default:
      print_list(key, field, out);
  }
}
