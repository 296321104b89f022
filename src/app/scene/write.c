/* Output of the table of keys: a scene as YAML, and the reference of all keys. */
#include "scene.h"

/* True where a mapping on the way to `key` is a study that the scene does not hold. */
static bool is_left_out(const kz_key *keys, const kz_key *key, const void *scene) {
  for (const kz_key *row = keys; row->path; row++) {
    const size_t length = strlen(row->path);
    const bool above =
        strncmp(row->path, key->path, length) == 0 && (key->path[length] == '.' || key->path[length] == '\0');
    if (above && !kz_value_is_given(row, scene)) return true;
  }
  return false;
}

/* True where another key answers this one. */
static bool is_chosen(const kz_key *keys, const kz_key *key, const void *scene) {
  return key->chosen_by && kz_value_is_set(kz_key_find(keys, key->chosen_by), scene);
}

/* True where the mapping of the key lacks a required one: it is not given, and the key has its default. */
static bool is_idle(const kz_key *keys, const kz_key *key, const void *scene) {
  const char *dot = strrchr(key->path, '.');
  const size_t length = dot ? (size_t)(dot - key->path) + 1 : 0;
  for (const kz_key *row = keys; row->path; row++) {
    const bool beside = strncmp(row->path, key->path, length) == 0 && !strchr(row->path + length, '.');
    if (length && beside && row->type != KZ_KEY_MAPPING && !row->fallback && !row->form && !kz_value_is_set(row, scene))
      return true;
  }
  return false;
}

static void write_indent(int depth, FILE *out) {
  fprintf(out, "%*s", 2 * depth, "");
}

/* Opens the mappings of `path` that `last`, the path written before, was not in; then writes the name of the key. */
static void write_name(const char *path, const char *last, FILE *out) {
  int depth = 0;
  bool inside = true; /* whether the path written before lies in the same mappings so far */
  const char *name = path;
  for (const char *dot; (dot = strchr(name, '.')); name = dot + 1, depth++) {
    inside = inside && strncmp(last, path, (size_t)(dot - path) + 1) == 0;
    if (inside) continue;
    write_indent(depth, out);
    fprintf(out, "%.*s:\n", (int)(dot - name), name);
  }
  write_indent(depth, out);
  fprintf(out, "%s: ", name);
}

void kz_scene_write(const kz_key *keys, const void *scene, bool flat, FILE *out) {
  const char *last = "";
  for (const kz_key *key = keys; key->path; key++) {
    if (key->type == KZ_KEY_MAPPING || !kz_value_is_set(key, scene) || is_left_out(keys, key, scene) ||
        is_chosen(keys, key, scene) || is_idle(keys, key, scene))
      continue;
    if (flat)
      fprintf(out, "%s: ", key->path);
    else
      write_name(key->path, last, out);
    kz_value_print(key, scene, out);
    fputc('\n', out);
    last = key->path;
  }
}

static const char *default_of(const kz_key *key) {
  if (!key->fallback) return "required";
  return key->fallback[0] ? key->fallback : "-";
}

enum { LONG_TEXT = 60, /* characters from which a text is printed once in the reference */ TEXT_BYTES = 700 };

/* Writes a text, or the name of the first key of the table that has the same long one: its help, or what it accepts. */
static void write_text(const kz_key *keys, const kz_key *key, bool help, FILE *out) {
  char text[TEXT_BYTES], other[TEXT_BYTES];
  const kz_key *row = keys;
  snprintf(text, sizeof text, "%s", help ? key->help : "");
  if (!help) kz_type_accepts(keys, key, text, sizeof text);
  for (; row != key && strlen(text) >= LONG_TEXT; row++) {
    snprintf(other, sizeof other, "%s", help ? row->help : "");
    if (!help) kz_type_accepts(keys, row, other, sizeof other);
    if (strcmp(text, other) == 0) break;
  }
  if (row != key && strlen(text) >= LONG_TEXT)
    fprintf(out, "as `%s`", row->path);
  else
    fputs(text, out);
}

static void write_row(const kz_key *keys, const kz_key *key, FILE *out) {
  fprintf(out, "| `%s`", key->path);
  if (key->symbol) fprintf(out, " or `%s`", key->symbol);
  fputs(" | ", out);
  if (key->type == KZ_KEY_MAPPING)
    fputs("a mapping", out);
  else
    write_text(keys, key, false, out);
  fprintf(out, " | %s | ", default_of(key));
  if (key->form) fprintf(out, "(%s) ", key->form);
  write_text(keys, key, true, out);
  fputs(" |\n", out);
}

/* A section for each top-level mapping. */
void kz_scene_reference(const kz_key *keys, FILE *out) {
  fputs(
      "# The keys of a scene\n\n"
      "Every key that a scene can hold: what it accepts, its default, what it means.\n"
      "Written by `kapitza keys` from the program's own table; do not edit. `-` = may be left out and has no default.\n"
      "A letter in parentheses marks one of several ways to give the same. Use the keys of one letter only; `required` "
      "then "
      "holds for that letter. Names of types lead to [their definitions](#types-of-numbers).\n\n",
      out);
  fputs("| key | accepted | default | meaning |\n| --- | --- | --- | --- |\n", out);
  for (const kz_key *key = keys; key->path; key++) {
    if (key->type == KZ_KEY_MAPPING && !strchr(key->path, '.'))
      fprintf(out, "\n## %s\n\n%s\n\n| key | accepted | default | meaning |\n| --- | --- | --- | --- |\n", key->path,
              key->help);
    else
      write_row(keys, key, out);
  }
  kz_types_write(keys, out);
}
