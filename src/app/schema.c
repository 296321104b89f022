/* The table of keys as a JSON schema (draft 2020-12), for editors and other checkers. */
#include "app.h"
#include "json.h"

/* A key of the mapping `parent` itself. */
static bool stands_in(const kz_key *key, const char *parent) {
  const size_t length = (size_t)(kz_key_name(key) - key->path);
  return length == (parent[0] ? strlen(parent) + 1 : 0) && strncmp(key->path, parent, strlen(parent)) == 0;
}

/* An object with one member. */
static kz_json *object_of(const char *name, kz_json *value) {
  kz_json *object = json_object_new_object();
  kz_json_add(object, name, value);
  return object;
}

static void add_word(kz_json *list, const char *before, const char *word, int length) {
  char text[128];
  snprintf(text, sizeof text, "%s%.*s", before, length, word);
  json_object_array_add(list, kz_json_text(text));
}

/* Adds the words, each with the symbol of the key that it names. */
static void add_words(kz_json *list, const char *before, const char *words) {
  int length;
  for (const char *word; (word = kz_words_next(&words, &length));) {
    const kz_key *key = kz_scene_keys();
    add_word(list, before, word, length);
    while (key->path && (!key->symbol || strlen(kz_key_name(key)) != (size_t)length ||
                         strncmp(kz_key_name(key), word, (size_t)length) != 0))
      key++;
    if (key->path) add_word(list, before, key->symbol, (int)strlen(key->symbol));
  }
}

static kz_json *words_of(const kz_key *key) {
  kz_json *list = json_object_new_array();
  add_words(list, "", kz_key_words(key));
  if (kz_key_is_parameter(key)) add_words(list, KZ_OF_PENDULUM, kz_key_words(key));
  return object_of("enum", list);
}

static kz_json *number_of(const kz_key *key, const char *type) {
  kz_json *number = object_of("type", kz_json_text(type));
  if (key->low == KZ_ABOVE_ZERO)
    kz_json_add_integer(number, "exclusiveMinimum", 0);
  else if (key->low > -DBL_MAX)
    kz_json_add_real(number, "minimum", key->low);
  if (key->high < DBL_MAX) kz_json_add_real(number, "maximum", key->high);
  return number;
}

static const char HARMONIC[] =
    "{\"type\": \"object\", \"required\": [\"order\", \"amplitude\"], \"additionalProperties\": false, "
    "\"properties\": {\"order\": {\"type\": \"integer\", \"minimum\": 1, \"maximum\": " KZ_STRINGIFY(KZ_HARMONICS) "}, "
    "\"amplitude\": {\"type\": \"number\"}, \"phase\": {\"anyOf\": [{\"type\": \"number\"}, "
    "{\"type\": \"string\", \"pattern\": \"^[-+.0-9eE]+ deg$\"}]}}}";

/* Schema of one value. */
static kz_json *value_of(const kz_key *key) {
  switch (key->type) {
    case KZ_KEY_TEXT:
      return json_tokener_parse("{\"type\": \"string\", \"maxLength\": 500}");
    case KZ_KEY_BOOLEAN:
      return object_of("type", kz_json_text("boolean"));
    case KZ_KEY_WORD:
    case KZ_KEY_WORDS:
      return words_of(key);
    case KZ_KEY_REAL:
    case KZ_KEY_DECIMAL:
    case KZ_KEY_REALS:
      return number_of(key, "number");
    case KZ_KEY_HARMONICS:
      return json_tokener_parse(HARMONIC);
    case KZ_KEY_MAPPING:
    case KZ_KEY_INTEGER:
    case KZ_KEY_COUNT:
    case KZ_KEY_INTEGERS:
      break;
  }
  return number_of(key, "integer");
}

/* A number, or a word such as "auto". */
static bool takes_a_word(const kz_key *key) {
  return key->type == KZ_KEY_COUNT && key->words;
}

/* Schema of what may stand in place of a number: one with a unit, a part of pi, a word; NULL = nothing. */
static kz_json *other_of(const kz_key *key) {
  const bool angle = kz_key_is_angle(key), decimal = key->type == KZ_KEY_DECIMAL,
             own = strcmp(key->unit, KZ_OWN_UNIT) == 0;
  const bool real = key->type == KZ_KEY_REAL || decimal || key->type == KZ_KEY_REALS;
  const bool unit = real && (kz_unit_is_known(key->unit) || own);
  char pattern[128];
  if (takes_a_word(key)) return words_of(key);
  if (!angle && !decimal && !unit) return NULL;
  if (angle)
    snprintf(pattern, sizeof pattern, "^([-+.0-9eE]+ ?(deg|\xc2\xb0)|%s[-+.0-9eE]* ?pi(/[0-9]+)?)$",
             decimal ? "[-+.0-9eE]+|" : "");
  else
    snprintf(pattern, sizeof pattern, "^([-+.0-9eE]+%s%s)$",
             unit ? decimal ? "( ?(rad|deg|\xc2\xb0)/s)?" : " ?(\xc2\xb0(/s)?|[A-Za-z1][A-Za-z0-9/^ *]*)" : "",
             unit && own ? "|[-+.0-9eE]* ?pi(/[0-9]+)?" : "");
  kz_json *text = object_of("type", kz_json_text("string"));
  kz_json_add_text(text, "pattern", pattern);
  return text;
}

static kz_json *key_of(const kz_key *key) {
  kz_json *value = value_of(key), *other = other_of(key);
  if (other) {
    kz_json *any = json_object_new_array();
    json_object_array_add(any, other);
    json_object_array_add(any, value);
    value = object_of("anyOf", any);
  }
  if (key->type >= KZ_KEY_WORDS) {
    kz_json *list = object_of("type", kz_json_text("array"));
    kz_json_add_integer(list, "minItems", 1);
    kz_json_add_integer(list, "maxItems", KZ_LIST_MAX);
    kz_json_add(list, "items", value);
    value = list;
  }
  const char *fallback = key->fallback ? key->fallback : "";
  const bool word = key->type == KZ_KEY_WORD || (takes_a_word(key) && strcmp(fallback, key->words) == 0);
  if (fallback[0]) kz_json_add(value, "default", word ? kz_json_text(fallback) : json_tokener_parse(fallback));
  kz_json_add_text(value, "description", key->help);
  if (key->unit[0]) kz_json_add_text(value, "unit", key->unit);
  return value;
}

/* Whether a key belongs to a form; 0: to none. */
static bool schema_belongs(const kz_key *key, char form) {
  return form ? key->form && strchr(key->form, form) : !key->form;
}

/* The keys of `parent` that belong to `form` (0: to none), must be there and have no symbol. */
static kz_json *required_of(const kz_key *keys, const char *parent, char form) {
  kz_json *list = json_object_new_array();
  for (const kz_key *key = keys; key->path; key++)
    if (!key->fallback && !key->symbol && schema_belongs(key, form) && stands_in(key, parent))
      json_object_array_add(list, kz_json_text(kz_key_name(key)));
  return list;
}

/* An object with this member. */
static kz_json *with_member(const char *name) {
  return object_of("required", kz_json_texts((const char *const[]){name, NULL}));
}

/* Requires those of them that have a symbol, by their name or their symbol. */
static void require_symbols(const kz_key *keys, const char *parent, char form, kz_json *object) {
  kz_json *all = json_object_new_array();
  for (const kz_key *key = keys; key->path; key++) {
    if (key->fallback || !key->symbol || !schema_belongs(key, form) || !stands_in(key, parent)) continue;
    kz_json *one = json_object_new_array();
    json_object_array_add(one, with_member(kz_key_name(key)));
    json_object_array_add(one, with_member(key->symbol));
    json_object_array_add(all, object_of("oneOf", one));
  }
  if (json_object_array_length(all) > 0)
    kz_json_add(object, "allOf", all);
  else
    json_object_put(all);
}

/* One of the ways to give the same: its required keys, and none of the other ways. */
static kz_json *form_of(const kz_key *keys, const char *parent, char form) {
  kz_json *object = object_of("required", required_of(keys, parent, form)), *others = json_object_new_object();
  for (const kz_key *key = keys; key->path; key++) {
    if (!key->form || schema_belongs(key, form) || !stands_in(key, parent)) continue;
    kz_json_add_boolean(others, kz_key_name(key), false);
    if (key->symbol) kz_json_add_boolean(others, key->symbol, false);
  }
  kz_json_add(object, "properties", others);
  require_symbols(keys, parent, form, object);
  return object;
}

/* Alternatives of a mapping, one of which is needed: ways to give its keys; of the scene (""): studies with a field. */
static kz_json *choices_of(const kz_key *keys, const char *parent) {
  kz_json *list = json_object_new_array();
  char seen = 0; /* forms come in the order of their letters */
  for (const kz_key *key = keys; key->path; key++) {
    if (!stands_in(key, parent)) continue;
    if (key->form && key->form[0] > seen) json_object_array_add(list, form_of(keys, parent, seen = key->form[0]));
    if (!parent[0] && key->type == KZ_KEY_MAPPING && key->offset != KZ_NO_FIELD)
      json_object_array_add(list, with_member(key->path));
  }
  return list;
}

static kz_json *mapping_of(const kz_key *keys, const char *parent, const char *help) {
  kz_json *object = object_of("type", kz_json_text("object")), *properties = json_object_new_object();
  kz_json *choices = choices_of(keys, parent);
  for (const kz_key *key = keys; key->path; key++) {
    if (!stands_in(key, parent)) continue;
    kz_json_add(properties, kz_key_name(key),
                key->type == KZ_KEY_MAPPING ? mapping_of(keys, key->path, key->help) : key_of(key));
    if (key->symbol) kz_json_add(properties, key->symbol, key_of(key));
  }
  kz_json_add_text(object, "description", help);
  kz_json_add_boolean(object, "additionalProperties", false);
  kz_json_add(object, "required", required_of(keys, parent, 0));
  kz_json_add(object, "properties", properties);
  if (json_object_array_length(choices) > 0)
    kz_json_add(object, "anyOf", choices);
  else
    json_object_put(choices);
  return object;
}

void kz_scene_schema(const kz_key *keys, FILE *out) {
  kz_json *schema = object_of("$schema", kz_json_text("https://json-schema.org/draft/2020-12/schema")),
          *all = json_object_new_array();
  json_object_array_add(all, mapping_of(keys, "", "What is modelled: a pendulum and at least one study."));
  kz_json_add_text(schema, "title", "A scene of kapitza");
  kz_json_add(schema, "allOf", all);
  fputs(json_object_to_json_string_ext(
            schema, JSON_C_TO_STRING_PRETTY | JSON_C_TO_STRING_SPACED | JSON_C_TO_STRING_NOSLASHESCAPE),
        out);
  fputc('\n', out);
  json_object_put(schema);
}
