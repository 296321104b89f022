#include "scene.h"

void kz_tree_free(kz_node *root) {
  while (root) {
    kz_node *next = root->next;
    kz_tree_free(root->first);
    free(root->name);
    free(root->text);
    free(root);
    root = next;
  }
}

static kz_node *child_named(const kz_node *mapping, const char *name, size_t length) {
  if (!mapping || mapping->kind != KZ_MAPPING) return NULL;
  for (kz_node *child = mapping->first; child; child = child->next)
    if (strlen(child->name) == length && strncmp(child->name, name, length) == 0) return child;
  return NULL;
}

kz_node *kz_tree_child(const kz_node *mapping, const char *name) {
  return child_named(mapping, name, strlen(name));
}

kz_node *kz_tree_find(const kz_node *root, const char *path) {
  const size_t length = strcspn(path, ".");
  kz_node *child = child_named(root, path, length);
  return path[length] == '.' && child ? kz_tree_find(child, path + length + 1) : child;
}

static void tree_append(kz_node *mapping, kz_node *child) {
  kz_node **end = &mapping->first;
  while (*end) end = &(*end)->next;
  *end = child;
}

/* Puts the content of `value` in the place of `node`. */
static void tree_replace(kz_node *node, kz_node *value) {
  value->next = node->next;
  node->next = NULL;
  const kz_node content = *value;
  *value = *node;
  *node = content;
  kz_tree_free(value);
}

/* An empty mapping called `name` [length], created by the option that brought `value`. */
static kz_node *new_mapping(const char *name, size_t length, const kz_node *value) {
  kz_node *node = kz_calloc(1, sizeof *node);
  node->kind = KZ_MAPPING;
  node->source = value->source;
  node->name = kz_strndup(name, length);
  return node;
}

static void set_here(kz_node *mapping, const char *name, kz_node *value) {
  free(value->name);
  value->name = kz_strdup(name);
  kz_node *old = kz_tree_child(mapping, name);
  if (old)
    tree_replace(old, value);
  else
    tree_append(mapping, value);
}

kz_status kz_tree_set(kz_node *root, const char *path, kz_node *value) {
  const size_t length = strcspn(path, ".");
  if (path[length] == '\0') {
    set_here(root, path, value);
    return KZ_OK;
  }
  kz_node *child = child_named(root, path, length);
  if (!child) {
    child = new_mapping(path, length, value);
    tree_append(root, child);
  }
  if (child->kind == KZ_MAPPING) return kz_tree_set(child, path + length + 1, value);
  const char *source = value->source;
  kz_tree_free(value);
  return kz_fail(KZ_REFUSED, "%s: %.*s: is not a mapping in the scene; make it one, or --set all of it", source,
                 (int)length, path);
}

static void set_text(char **text, const char *value) {
  free(*text);
  *text = kz_strdup(value);
}

/* Gives the value of `key` the name of `meant` if it is that key's symbol, and the name is one of its words. */
static void name_value(const kz_key *key, const kz_key *meant, kz_node *root) {
  kz_node *node = key->type == KZ_KEY_WORD ? kz_tree_find(root, key->path) : NULL;
  if (node && node->text && strcmp(node->text, meant->symbol) == 0 &&
      kz_word_find(kz_key_words(key), kz_key_name(meant)) >= 0)
    set_text(&node->text, kz_key_name(meant));
}

/* Takes the name of the mapping from before a key of the pendulum. */
static void name_parameter(const kz_key *key, kz_node *root) {
  kz_node *node = kz_key_is_parameter(key) ? kz_tree_find(root, key->path) : NULL;
  if (!node || !node->text || strncmp(node->text, KZ_OF_PENDULUM, strlen(KZ_OF_PENDULUM)) != 0) return;
  char *name = kz_strdup(node->text + strlen(KZ_OF_PENDULUM));
  free(node->text);
  node->text = name;
}

void kz_tree_name_symbols(const kz_key *keys, kz_node *root) {
  for (const kz_key *key = keys; key->path; key++) name_parameter(key, root);
  for (const kz_key *key = keys; key->path; key++) {
    if (!key->symbol) continue;
    char path[256];
    snprintf(path, sizeof path, "%.*s%s", (int)(kz_key_name(key) - key->path), key->path, key->symbol);
    kz_node *node = kz_tree_find(root, path);
    if (node) set_text(&node->name, kz_key_name(key));
    for (const kz_key *other = keys; other->path; other++) name_value(other, key, root);
  }
}

kz_node *kz_tree_take(kz_node *root, const char *path) {
  const size_t length = strcspn(path, ".");
  kz_node *child = child_named(root, path, length);
  if (child && path[length] == '.') return kz_tree_take(child, path + length + 1);
  if (!child) return NULL;
  kz_node **place = &root->first;
  while (*place != child) place = &(*place)->next;
  *place = child->next;
  child->next = NULL;
  return child;
}

char *kz_node_text(const char *text, size_t length) {
  char *copy = kz_malloc(length + 1);
  for (size_t i = 0; i < length; i++) copy[i] = text[i] ? text[i] : '\1';
  copy[length] = '\0';
  return copy;
}
