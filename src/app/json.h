/* JSON by json-c, for other programs to read. */
#pragma once

#include <json-c/json.h>

#include "scene/scene.h"

typedef struct json_object kz_json;

/* Values. real: with the fewest digits that read back as the same number; null if it is not finite. text: bytes that
 * are not UTF-8, as where a message was cut, become '?'. */
kz_json *kz_json_real(double value);
kz_json *kz_json_text(const char *text);
/* The names of a list that NULL ends. */
kz_json *kz_json_texts(const char *const *texts);

/* Adds a member to an object, which then owns `value`. */
void kz_json_add(kz_json *object, const char *name, kz_json *value);
void kz_json_add_text(kz_json *object, const char *name, const char *value);
void kz_json_add_real(kz_json *object, const char *name, double value);
void kz_json_add_integer(kz_json *object, const char *name, int64_t value);
void kz_json_add_boolean(kz_json *object, const char *name, bool value);

/* Prints `value` on one line, with a newline, and frees it. */
void kz_json_print(kz_json *value, FILE *out);

/* Writes the keys as a JSON schema, without rules between keys of different mappings: the command check tests them. */
void kz_scene_schema(const kz_key *keys, FILE *out);
