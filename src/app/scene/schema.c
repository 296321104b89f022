/* The table of keys as a JSON schema (draft 2020-12), for editors and other checkers. */
#include <string.h>

#include "scene.h"

static const char *name_of(const kz_key *key) {
  const char *dot = strrchr(key->path, '.');
  return dot ? dot + 1 : key->path;
}

/* A key of the mapping `parent` itself. */
static bool stands_in(const kz_key *key, const char *parent) {
  const size_t length = (size_t)(name_of(key) - key->path);
  return length == (parent[0] ? strlen(parent) + 1 : 0) && strncmp(key->path, parent, strlen(parent)) == 0;
}

static void indent(int depth, FILE *out) {
  fprintf(out, "\n%*s", 2 * depth, "");
}

static void write_words(const char *words, FILE *out) {
  fputs("{\"enum\": [", out);
  int length;
  const char *separator = "";
  for (const char *word; (word = kz_words_next(&words, &length)); separator = ", ")
    fprintf(out, "%s\"%.*s\"", separator, length, word);
  fputs("]", out);
}

static void write_number(const kz_key *key, const char *type, FILE *out) {
  fprintf(out, "{\"type\": \"%s\"", type);
  if (key->low == KZ_ABOVE_ZERO)
    fputs(", \"exclusiveMinimum\": 0", out);
  else if (key->low > -DBL_MAX)
    fprintf(out, ", \"minimum\": %s", kz_shortest(key->low).text);
  if (key->high < DBL_MAX) fprintf(out, ", \"maximum\": %s", kz_shortest(key->high).text);
}

/* What one value may be; the object is left open. */
static void open_value(const kz_key *key, FILE *out) {
  switch (key->type) {
    case KZ_KEY_TEXT:
      fputs("{\"type\": \"string\", \"maxLength\": 500", out);
      break;
    case KZ_KEY_BOOLEAN:
      fputs("{\"type\": \"boolean\"", out);
      break;
    case KZ_KEY_WORD:
    case KZ_KEY_WORDS:
      write_words(kz_key_words(key), out);
      break;
    case KZ_KEY_REAL:
    case KZ_KEY_DECIMAL:
    case KZ_KEY_REALS:
      write_number(key, "number", out);
      break;
    case KZ_KEY_HARMONICS:
      fprintf(out,
              "{\"type\": \"object\", \"required\": [\"order\", \"amplitude\"], \"additionalProperties\": false, "
              "\"properties\": {\"order\": {\"type\": \"integer\", \"minimum\": 1, \"maximum\": %d}, \"amplitude\": {\"type\": "
              "\"number\"}, \"phase\": {\"anyOf\": [{\"type\": \"number\"}, {\"type\": \"string\", \"pattern\": "
              "\"^[-+.0-9eE]+ deg$\"}]}}",
              KZ_HARMONICS);
      break;
    default:
      write_number(key, "integer", out);
  }
}

static void write_key(const kz_key *key, FILE *out) {
  const bool list = key->type >= KZ_KEY_WORDS, angle = kz_key_is_angle(key), decimal = key->type == KZ_KEY_DECIMAL;
  if (list) fprintf(out, "{\"type\": \"array\", \"minItems\": 1, \"maxItems\": %d, \"items\": ", KZ_LIST_MAX);
  const bool word_too = key->type == KZ_KEY_COUNT && key->words; /* a number or a word, as "auto" */
  const bool real = key->type == KZ_KEY_REAL || decimal || key->type == KZ_KEY_REALS;
  const bool unit = real && (kz_unit_is_known(key->unit) || strcmp(key->unit, KZ_OWN_UNIT) == 0);
  if (angle)
    fprintf(out, "{\"anyOf\": [{\"type\": \"string\", \"pattern\": \"^([-+.0-9eE]+ ?(deg|\xc2\xb0)|%s)$\"}, ",
            decimal ? "[-+.0-9eE]+|[-+.0-9eE]* ?pi(/[0-9]+)?" : "[-+.0-9eE]* ?pi(/[0-9]+)?");
  else if (decimal || unit)
    fprintf(out, "{\"anyOf\": [{\"type\": \"string\", \"pattern\": \"^([-+.0-9eE]+%s%s)$\"}, ",
            unit ? decimal ? "( ?(rad|deg|\xc2\xb0)/s)?" : " ?(\xc2\xb0(/s)?|[A-Za-z1][A-Za-z0-9/^ *]*)" : "",
            unit && strcmp(key->unit, KZ_OWN_UNIT) == 0 ? "|[-+.0-9eE]* ?pi(/[0-9]+)?" : "");
  if (word_too) {
    fputs("{\"anyOf\": [", out);
    write_words(key->words, out);
    fputs("}, ", out);
  }
  open_value(key, out);
  if (angle || decimal || unit || word_too) fputs("}]", out);
  if (list) fputc('}', out);
  if (key->fallback && key->fallback[0]) {
    fputs(", \"default\": ", out);
    if (key->type == KZ_KEY_WORD || (word_too && strcmp(key->fallback, key->words) == 0))
      kz_text_print(key->fallback, out);
    else
      fputs(key->fallback, out);
  }
  fputs(", \"description\": ", out);
  kz_text_print(key->help, out);
  if (key->unit[0]) fprintf(out, ", \"unit\": \"%s\"", key->unit);
  fputc('}', out);
}

/* Whether a key belongs to a form; 0: to none. */
static bool belongs(const kz_key *key, char form) {
  return form ? key->form && strchr(key->form, form) : !key->form;
}

/* "required" of the keys of `parent` that belong to `form` (0: to none) and must be there. */
static void write_required(const kz_key *keys, const char *parent, char form, FILE *out) {
  const char *between = "\"required\": [";
  for (const kz_key *key = keys; key->path; key++) {
    if (key->fallback || !belongs(key, form) || !stands_in(key, parent)) continue;
    fprintf(out, "%s\"%s\"", between, name_of(key));
    between = ", ";
  }
  fputs(between[0] == ',' ? "]" : "\"required\": []", out);
}

/* One of the ways to give the same: its required keys, and none of the other ways. */
static void write_form(const kz_key *keys, const char *parent, char form, FILE *out) {
  const char *between = "";
  fputc('{', out);
  write_required(keys, parent, form, out);
  fputs(", \"properties\": {", out);
  for (const kz_key *key = keys; key->path; key++) {
    if (!key->form || belongs(key, form) || !stands_in(key, parent)) continue;
    fprintf(out, "%s\"%s\": false", between, name_of(key));
    between = ", ";
  }
  fputs("}}", out);
}

static void write_forms(const kz_key *keys, const char *parent, int depth, FILE *out) {
  char seen = 0; /* forms come in the order of their letters */
  for (const kz_key *key = keys; key->path; key++) {
    if (!key->form || key->form[0] <= seen || !stands_in(key, parent)) continue;
    fputs(seen ? "," : ", \"anyOf\": [", out);
    seen = key->form[0];
    indent(depth + 1, out);
    write_form(keys, parent, seen, out);
  }
  if (seen) fputc(']', out);
}

/* The scene must ask for one study at least: a mapping at the top that has a field. */
static void write_studies(const kz_key *keys, FILE *out) {
  const char *between = ", \"anyOf\": [";
  for (const kz_key *key = keys; key->path; key++) {
    if (key->type != KZ_KEY_MAPPING || key->offset == KZ_NO_FIELD || strchr(key->path, '.')) continue;
    fprintf(out, "%s{\"required\": [\"%s\"]}", between, key->path);
    between = ", ";
  }
  fputc(']', out);
}

static void write_mapping(const kz_key *keys, const char *parent, const char *help, int depth, FILE *out) {
  const char *between = "";
  fputs("{\"type\": \"object\", \"description\": ", out);
  kz_text_print(help, out);
  fputs(", \"additionalProperties\": false, ", out);
  write_required(keys, parent, 0, out);
  fputs(", \"properties\": {", out);
  for (const kz_key *key = keys; key->path; key++) {
    if (!stands_in(key, parent)) continue;
    fputs(between, out);
    indent(depth + 1, out);
    fprintf(out, "\"%s\": ", name_of(key));
    if (key->type == KZ_KEY_MAPPING)
      write_mapping(keys, key->path, key->help, depth + 1, out);
    else
      write_key(key, out);
    between = ",";
  }
  fputc('}', out);
  write_forms(keys, parent, depth, out);
  if (!parent[0]) write_studies(keys, out);
  fputc('}', out);
}

void kz_scene_schema(const kz_key *keys, FILE *out) {
  fputs("{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\", \"title\": \"A scene of kapitza\", \"allOf\": [\n",
        out);
  write_mapping(keys, "", "What is modelled: a pendulum and at least one study.", 0, out);
  fputs("\n]}\n", out);
}
