#include "json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DEPTH = 100 };

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
  KZ_FREED char *clean = kz_strdup(text);
  for (char *c = clean; *c;) {
    const size_t bytes = character_bytes(c);
    if (bytes == 0) *c = '?';
    c += bytes > 0 ? bytes : 1;
  }
  return json_object_new_string(clean);
}

kz_json *kz_json_pair(double first, double second) {
  kz_json *pair = json_object_new_array();
  json_object_array_add(pair, kz_json_real(first));
  json_object_array_add(pair, kz_json_real(second));
  return pair;
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

/* ---- reading ---- */

/* Where json-c takes what is not JSON: a single quote for a double one, a control character in a text. The place of the first, or `length`. */
static size_t lenient_place(const char *line, size_t length) {
  bool inside = false;
  for (size_t i = 0; i < length; i++) {
    if (inside ? (unsigned char)line[i] < 32 : line[i] == '\'') return i;
    if (inside && line[i] == '\\')
      i++;
    else if (line[i] == '"')
      inside = !inside;
  }
  return length;
}

static kz_status parse(const char *line, size_t length, const char *source, kz_json **json) {
  const size_t sound = lenient_place(line, length);
  struct json_tokener *tokener = json_tokener_new_ex(MOST_DEPTH);
  if (!tokener) return kz_fail(KZ_FAILED, "%s: out of memory", source);
  json_tokener_set_flags(tokener, JSON_TOKENER_STRICT | JSON_TOKENER_VALIDATE_UTF8);
  *json = json_tokener_parse_ex(tokener, line, (int)sound);
  if (json_tokener_get_error(tokener) == json_tokener_continue && sound == length) /* the end of the line is its end */
    *json = json_tokener_parse_ex(tokener, "", 1);
  const enum json_tokener_error error = json_tokener_get_error(tokener);
  const bool lenient = sound < length && (error == json_tokener_success || error == json_tokener_continue);
  const size_t place = lenient ? sound : json_tokener_get_parse_end(tokener);
  json_tokener_free(tokener);
  if (error == json_tokener_success && !lenient) return KZ_OK;
  json_object_put(*json);
  return kz_fail(KZ_REFUSED, "%s: is not JSON: %s at byte %zu", source,
                 lenient ? "unexpected character" : json_tokener_error_desc(error), place + 1);
}

/* json-c ends whole numbers at those of 64 bits: digits beyond are not known. */
static bool is_cut(kz_json *json) {
  return json_object_get_type(json) == json_type_int &&
         (json_object_get_uint64(json) == UINT64_MAX || json_object_get_int64(json) == INT64_MIN);
}

static kz_node *node_of(kz_json *json, const char *source);

/* Members of an object or items of a list as children of `node`. */
static void add_children(kz_json *json, kz_node *node) {
  kz_node **end = &node->first;
  if (node->kind == KZ_MAPPING) {
    json_object_object_foreach(json, name, member) {
      *end = node_of(member, node->source);
      free((*end)->name);
      (*end)->name = kz_strdup(name);
      end = &(*end)->next;
    }
    return;
  }
  for (size_t i = 0; i < json_object_array_length(json); i++, end = &(*end)->next)
    *end = node_of(json_object_array_get_idx(json, i), node->source);
}

static kz_node *node_of(kz_json *json, const char *source) {
  const enum json_type type = json_object_get_type(json);
  kz_node *node = kz_calloc(1, sizeof *node);
  *node = (kz_node){.kind = KZ_SCALAR, .source = source, .name = kz_strdup(""), .plain = type != json_type_string};
  if (type == json_type_object || type == json_type_array) {
    node->kind = type == json_type_object ? KZ_MAPPING : KZ_SEQUENCE;
    add_children(json, node);
  } else if (type == json_type_string) {
    node->text = kz_node_text(json_object_get_string(json), (size_t)json_object_get_string_len(json));
  } else {
    node->text = kz_strdup(is_cut(json) ? "a number beyond 64 bits" : json ? json_object_get_string(json) : "null");
  }
  return node;
}

kz_status kz_json_read(const char *line, size_t length, const char *source, kz_node **root) {
  kz_json *json = NULL;
  *root = NULL;
  KZ_TRY(parse(line, length, source, &json));
  *root = node_of(json, source);
  json_object_put(json);
  return KZ_OK;
}
