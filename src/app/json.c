#include "json.h"

kz_json *kz_json_real(double value) {
  return isfinite(value) ? json_object_new_double_s(value, kz_shortest(value).text) : NULL;
}

/* Number of bytes of the UTF-8 character at `c`; 0 if there is none. */
static size_t character_bytes(const char *c) {
  static const struct {
    unsigned char mask, lead;
  } kinds[] = {{0x80, 0x00}, {0xE0, 0xC0}, {0xF0, 0xE0}, {0xF8, 0xF0}};
  for (size_t n = 0; n < sizeof kinds / sizeof kinds[0]; n++) {
    if (((unsigned char)*c & kinds[n].mask) != kinds[n].lead) continue;
    for (size_t i = 1; i <= n; i++)
      if (((unsigned char)c[i] & 0xC0) != 0x80) return 0;
    return n + 1;
  }
  return 0;
}

kz_json *kz_json_text(const char *text) {
  KZ_AUTOFREE char *clean = kz_strdup(text);
  for (char *c = clean; *c;) {
    const size_t bytes = character_bytes(c);
    if (bytes == 0) *c = '?';
    c += bytes > 0 ? bytes : 1;
  }
  return json_object_new_string(clean);
}

kz_json *kz_json_texts(const char *const *texts) {
  kz_json *list = json_object_new_array();
  for (; *texts; texts++) json_object_array_add(list, kz_json_text(*texts));
  return list;
}

void kz_json_add(kz_json *object, const char *name, kz_json *value) {
  json_object_object_add(object, name, value);
}

void kz_json_add_text(kz_json *object, const char *name, const char *value) {
  kz_json_add(object, name, kz_json_text(value));
}

void kz_json_add_real(kz_json *object, const char *name, double value) {
  kz_json_add(object, name, kz_json_real(value));
}

void kz_json_add_integer(kz_json *object, const char *name, int64_t value) {
  kz_json_add(object, name, json_object_new_int64(value));
}

void kz_json_add_boolean(kz_json *object, const char *name, bool value) {
  kz_json_add(object, name, json_object_new_boolean(value));
}

void kz_json_print(kz_json *value, FILE *out) {
  fputs(json_object_to_json_string_ext(value, JSON_C_TO_STRING_SPACED | JSON_C_TO_STRING_NOSLASHESCAPE), out);
  fputc('\n', out);
  json_object_put(value);
}
