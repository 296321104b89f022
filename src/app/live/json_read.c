/* Requests of other programs: JSON read into a tree as of a scene. */
#include "json_read.h"

enum { MOST_DEPTH = 100 };

/* Where json-c takes what is not JSON: a single quote for a double one, a control character in a text. The place of the
 * first, or `length`. */
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

static kz_status json_read_parse(const char *line, size_t length, const char *source, kz_json **json) {
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
  KZ_TRY(json_read_parse(line, length, source, &json));
  *root = node_of(json, source);
  json_object_put(json);
  return KZ_OK;
}
