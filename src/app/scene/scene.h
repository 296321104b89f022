/* scene: reads the YAML text of a user into kz_scene, and writes it back (C; layer 4).
 *
 * ONE table, kz_scene_keys, holds every key of a scene. Checks, defaults, suggestions, `check`, the resolved text and
 * docs/reference/scene.md all come from its rows: a new key is a new row. */
#pragma once

#include "kapitza/study_keys.h"

/* The table: the keys of the pendulum and of numerics, then those of each study; a row without path ends it. */
const kz_key *kz_scene_keys(void);

/* The words of a key, joined by '|'; "" for other types. */
const char *kz_key_words(const kz_key *key);
/* The place of a word in the words "a|b|c"; -1 if it is none of them. */
int64_t kz_word_find(const char *words, const char *word);
/* The largest value, in m, that needs no unit; infinity for other units. */
double kz_key_most_bare(const kz_key *key);
/* True if the words of the key are the names of keys of the pendulum. */
bool kz_key_is_parameter(const kz_key *key);
/* True if the key is an angle, which may be written in degrees. */
bool kz_key_is_angle(const kz_key *key);
/* The last part of the key's path. */
const char *kz_key_name(const kz_key *key);
/* The row of `path`, whose last part may be the symbol of the key; NULL if there is none. */
const kz_key *kz_key_find(const kz_key *keys, const char *path);
/* The words "a|b|c" as "a, b, c", written to `text` [bytes]. */
void kz_key_list(const char *words, char *text, size_t bytes);
/* Writes what the key accepts, such as "an integer from 1 to 512", to `text` [bytes]. */
void kz_key_accepts(const kz_key *keys, const kz_key *key, char *text, size_t bytes);
/* Expectation with another noun and other words for the unit; kz_key_unit_words: " in m, or with its unit: cm, mm". */
void kz_key_accepts_with(const kz_key *keys, const kz_key *key, const char *noun, const char *unit, char *text,
                         size_t bytes);
void kz_key_unit_words(const kz_key *key, char *text, size_t bytes);
/* The types of numbers in the reference of keys: accepts = as kz_key_accepts, with the type's name as a link for its
 * units; write = the definitions to which these links lead. */
void kz_type_accepts(const kz_key *keys, const kz_key *key, char *text, size_t bytes);
void kz_types_write(const kz_key *keys, FILE *out);
/* Copies the replacement of a removed word to `now` [bytes]; false if `word` is not a removed word. */
bool kz_key_renamed(const kz_key *key, const char *word, char *now, size_t bytes);
/* Power, left out of this build, that a key, a word of it (KEY.WORD) or more of them need; NULL = none. */
const char *kz_key_missing_power(const char *path);
/* Copies the word of `words` ("a|b|c") closest to `word` to `nearest` [bytes]; false if none is similar. */
bool kz_key_suggest(const char *word, const char *words, char *nearest, size_t bytes);
/* Writes to `text` [bytes] why `name` is no key of mapping `parent`; `prefix` stands before a suggestion. */
void kz_key_unknown(const kz_key *keys, const char *parent, const char *name, const char *prefix, char *text,
                    size_t bytes);

/* The YAML text as a tree, with the place of every node in the text. */
typedef enum { KZ_SCALAR, KZ_SEQUENCE, KZ_MAPPING } kz_node_kind;
typedef struct kz_node {
  kz_node_kind kind;
  char *name;                 /* its key in the mapping above; "" at the root and in a list */
  char *text;                 /* Text of a scalar, else NULL */
  bool plain;                 /* a scalar without quotes */
  const char *source;         /* file name, or the option "--set KEY=VALUE"; not owned */
  int name_line, name_column; /* from 1; 0 in an option */
  int line, column;
  int order; /* rank in document order */
  struct kz_node *first, *next;
} kz_node;

/* Reads YAML `text` [length]; `option` = the value of a --set: flow text on one line, errors without line and column.
 * KZ_REFUSED names the place. The caller frees *root. */
kz_status kz_tree_read(const char *text, size_t length, const char *source, bool option, kz_node **root);
void kz_tree_free(kz_node *root);
/* A child of a mapping by name (the first one), or NULL. */
kz_node *kz_tree_child(const kz_node *mapping, const char *name);
/* The node at a path such as "basin.theta", or NULL. */
kz_node *kz_tree_find(const kz_node *root, const char *path);
/* Puts `value` at `path` instead of the old node, with mappings on the way. The tree owns it in any case. */
kz_status kz_tree_set(kz_node *root, const char *path, kz_node *value);
#define KZ_OF_PENDULUM "pendulum." /* may stand before a key of the pendulum that a sweep or a plane names */
/* Replaces symbols of keys: "Q: 5" by "quality_factor: 5", and "parameter: Q" of a sweep likewise. */
void kz_tree_name_symbols(const kz_key *keys, kz_node *root);
/* Removes the node at `path` from the tree and returns it, or NULL; the caller frees it. */
kz_node *kz_tree_take(kz_node *root, const char *path);
/* Copies a text for a node; a NUL becomes the control character 1, which no text may hold. The caller frees it. */
char *kz_node_text(const char *text, size_t length);

/* [-+] digits [. digits] [e [-+] digits], no leading zeros. *whole: neither point nor exponent. */
bool kz_text_is_decimal(const char *text, bool *whole);
/* Reads one scalar strictly. Returns what is wrong with it ("is not a number"), or NULL. */
const char *kz_scalar_integer(const kz_node *node, int64_t *value);
const char *kz_scalar_real(const kz_node *node, double *value);
const char *kz_text_real(const char *text, double *value); /* as kz_scalar_real, of a text without quotes */
/* An angle in rad, or in degrees with "deg" behind the number, or a part of pi such as "3 pi/4"; value in rad. */
const char *kz_scalar_angle(const kz_node *node, double *value);
/* A number of any digits, with or without quotes, as the sum of two doubles that is nearest to it; an angle may be in
 * degrees. *value keeps the text. */
const char *kz_scalar_decimal(const kz_node *node, bool is_angle, kz_decimal *value);
/* Writes "0.3" for "0,3" to number [bytes]; false if the text is not a number with one comma. */
bool kz_scalar_with_a_point(const char *text, char *scene_fuzz_number, size_t bytes);
/* A number, or one with a unit ("20 cm"); *value is in `unit`; "" accepts any unit of the table. */
const char *kz_scalar_quantity(const kz_node *node, const char *unit, double *value);
/* True for a velocity per second ("3 rad/s", "170 deg/s"): *value in rad per drive radian of a pivot at pivot_frequency
 * (rad/s; NaN = the scene is not in SI units), *wrong = what is wrong, or NULL. */
bool kz_scalar_per_second(const kz_node *node, double pivot_frequency, double *value, const char **wrong);
const char *kz_scalar_boolean(const kz_node *node, bool *value);
/* A text of at most `most` bytes, with or without quotes, on one line; kz_scalar_text: of at most 500. */
const char *kz_scalar_text_within(const kz_node *node, size_t most, const char *too_long);
const char *kz_scalar_text(const kz_node *node);

/* Unit behind a number already read, or one without a name: of a key in `of`, of an angle ("rad") too. */
kz_written_unit kz_scalar_unit(const kz_node *node, const char *of);
/* The table of units (units.c). kz_unit_is_known: true if other units can be converted to `of`. kz_unit_find: *found =
 * the unit `text`, in units of `of` ("" = any); returns what is wrong, or NULL. kz_unit_names: writes the other units
 * of `of` to `text` [bytes]. */
bool kz_unit_is_known(const char *of);
const char *kz_unit_find(const char *text, const char *of, kz_written_unit *found);
void kz_unit_names(const char *of, char *text, size_t bytes);

/* Bytes of the control character at `c` (UTF-8: C0, DEL, C1, which terminals interpret); 0 if it is none. */
int kz_control_bytes(const char *c);
/* A short returned text, valid in its expression; kz_shortest: shortest decimal that reads back as `value`. */
typedef struct {
  char text[128];
} kz_short_text;
kz_short_text kz_shortest(double value);

/* The field of a key in `scene`. read: reads it from a node; returns what is wrong, or NULL; *culprit = the node,
 * or the item of its list, that is wrong. is_set: true if it is given. print: prints it as YAML flow text. A mapping
 * supports is_set only. */
const char *kz_value_read(const kz_key *key, const kz_node *node, void *scene, const kz_node **culprit);
/* Sets the field to the default of the key, which is read as a user's value is. */
kz_status kz_value_default(const kz_key *key, void *scene);
bool kz_value_is_set(const kz_key *key, const void *scene);
/* Marks a mapping as given; false if a mapping with a field is not. */
void kz_value_give(const kz_key *mapping, void *scene);
bool kz_value_is_given(const kz_key *key, const void *scene);
void kz_value_print(const kz_key *key, const void *scene, FILE *out);

/* A reading in progress: only the first complaint in document order is kept; complaints without a node come last. */
typedef struct {
  const kz_key *keys;
  kz_node *root;
  void *scene;
  int first; /* order of the complaint kept; INT_MAX = none */
  char message[KZ_MESSAGE_BYTES];
} kz_reading;

/* Records a complaint about the key `path` at its value, or at its mapping if the scene does not give it. */
void kz_complain(kz_reading *reading, const char *path, const char *format, ...) __attribute__((format(printf, 3, 4)));
/* Fails at the value of `node`; NULL = a missing key. */
void kz_complain_at(kz_reading *reading, const kz_node *node, const char *path, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Sets every field of `scene` to its default, then reads the tree into it by the table. */
kz_status kz_reading_keys(kz_reading *reading);
/* Checks rules between keys (axes, the pendulum's parameters), and sets values that follow from others. */
void kz_reading_rules(kz_reading *reading);

/* Tree of a text and of --set options ("KEY=VALUE"); its nodes refer to `labels`. The caller frees it in any case. */
typedef char kz_option_label[128];
typedef struct {
  kz_node *root;
  kz_option_label *labels;
} kz_scene_tree;
kz_status kz_scene_tree_read(const char *text, size_t length, const char *file, int n_sets, char *const *sets,
                             kz_scene_tree *tree);
void kz_scene_tree_free(kz_scene_tree *tree);
/* Reads a tree into a scene, which the caller frees; numerics stay unresolved. KZ_REFUSED names the first error. */
kz_status kz_scene_of_tree(kz_node *root, kz_scene *scene);
/* Reads a scene's text and --set options into a scene, which the caller frees. KZ_REFUSED names the first error. */
kz_status kz_scene_read(const char *text, size_t length, const char *file, int n_sets, char *const *sets,
                        kz_scene *scene);
void kz_scene_free(kz_scene *scene);
/* Completes a message "KEY|KEY: what is wrong" of another layer with the place of the first of its keys that the scene
 * gives (else of the last one's mapping). Other messages stay as they are. Returns `status`. */
kz_status kz_scene_locate(kz_status status, const char *text, size_t length, const char *file, int n_sets,
                          char *const *sets);
/* Writes the scene as YAML with all defaults, which reads back the same; flat: "path: value" for each key. */
void kz_scene_write(const kz_key *keys, const void *scene, bool flat, FILE *out);
/* The scene reference (docs/reference/scene.md). */
void kz_scene_reference(const kz_key *keys, FILE *out);

/* KZ_REFUSED unless `path` is a regular file: a device or a pipe could be read without end. */
kz_status kz_scene_check_file(const char *path);
/* Reads a regular scene file, or standard input ("-"), of at most 1 MB. The caller frees *text. */
kz_status kz_scene_load(const char *path, char **text, size_t *length);
