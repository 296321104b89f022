/* A scene: file and options -> tree -> kz_scene. */
#include "scene.h"
#include "kapitza/app.h"

#include <errno.h>
#include <limits.h>
#include <sys/stat.h>

enum { MAX_BYTES = 1000000 };

kz_status kz_scene_check_file(const char *path) {
  struct stat facts;
  if (stat(path, &facts) != 0)
    return kz_fail(KZ_REFUSED, "%s: cannot be opened: %s; give the name of a scene file", path, strerror(errno));
  if (S_ISDIR(facts.st_mode)) return kz_fail(KZ_REFUSED, "%s: is a folder; give the name of a scene file", path);
  if (!S_ISREG(facts.st_mode))
    return kz_fail(KZ_REFUSED, "%s: is not a regular file; give the name of a scene file", path);
  return KZ_OK;
}

static kz_status open_scene(const char *path, FILE **file) {
  *file = stdin;
  if (strcmp(path, "-") == 0) return KZ_OK;
  KZ_TRY(kz_scene_check_file(path));
  *file = fopen(path, "rb");
  if (*file) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: cannot be opened: %s; give a readable scene file", path, strerror(errno));
}

/* The first bytes of an HDF5 file. */
static bool is_result(const char *text, size_t length) {
  static const char signature[] = "\211HDF\r\n\032\n";
  return length >= sizeof signature - 1 && memcmp(text, signature, sizeof signature - 1) == 0;
}

/* Why these bytes cannot be a scene, as the end of a message; NULL if they can. */
static const char *not_a_scene(size_t length, FILE *file) {
  if (ferror(file)) return strerror(errno);
  return length > MAX_BYTES ? "has more than 1000000 bytes; a scene has at most that many" : NULL;
}

kz_status kz_scene_load(const char *path, char **text, size_t *length) {
  FILE *file;
  KZ_TRY(open_scene(path, &file));
  *text = kz_malloc(MAX_BYTES + 2);
  *length = fread(*text, 1, MAX_BYTES + 1, file);
  const char *wrong = not_a_scene(*length, file);
  (*text)[*length] = '\0';
  if (file != stdin) fclose(file);
  const bool result = !wrong && is_result(*text, *length);
  if (!wrong && !result) return KZ_OK;
  free(*text);
  *text = NULL;
  if (wrong) return kz_fail(KZ_REFUSED, "%s: %s", path, wrong);
  return kz_fail(KZ_REFUSED, "%s: is a result, not a scene; kapitza view %s shows it, kapitza plot basin %s draws it",
                 path, path, path);
}

/* Refuses an option whose key is not in the table, naming the nearest one of its mapping. */
static kz_status refuse_key(const kz_key *keys, const char *label, const char *path) {
  char parent[256], prefix[260], wrong[1200];
  const char *dot = strrchr(path, '.'), *name = dot ? dot + 1 : path;
  snprintf(parent, sizeof parent, "%.*s", dot ? (int)(dot - path) : 0, path);
  snprintf(prefix, sizeof prefix, "%.*s", (int)(name - path), path);
  const kz_key *holder = kz_key_find(keys, parent);
  if (dot && (!holder || holder->type != KZ_KEY_MAPPING)) return refuse_key(keys, label, parent);
  kz_key_unknown(keys, parent, name, prefix, wrong, sizeof wrong);
  return kz_fail(KZ_REFUSED, "%s: %s: %s", label, path, wrong);
}

/* One option, "KEY=VALUE"; label = the source that its errors name. */
static kz_status apply_set(const kz_key *keys, kz_node *root, const char *option, const char *label) {
  const char *equals = strchr(option, '=');
  char path[256];
  if (!equals || equals == option || equals - option >= (long)sizeof path)
    return kz_fail(KZ_REFUSED, "%s: is not KEY=VALUE; write for example --set basin.theta.count=200", label);
  snprintf(path, sizeof path, "%.*s", (int)(equals - option), option);
  const kz_key *key = kz_key_find(keys, path);
  if (!key) return refuse_key(keys, label, path);
  kz_node *value;
  KZ_TRY(kz_tree_read(equals + 1, strlen(equals + 1), label, true, &value));
  KZ_TRY(kz_tree_set(root, key->path, value));
  kz_tree_name_symbols(keys, root);
  return KZ_OK;
}

/* "--set KEY=VALUE", cut where it would bury the message. */
static void print_label(const char *option, char *label) {
  const bool whole = strlen(option) < 100;
  snprintf(label, sizeof(kz_option_label), "--set %.*s%s", whole ? 100 : 96, option, whole ? "" : "...");
}

kz_status kz_scene_tree_read(const char *text, size_t length, const char *file, int n_sets, char *const *sets,
                             kz_scene_tree *tree) {
  *tree = (kz_scene_tree){.labels = kz_calloc((size_t)n_sets + 1, sizeof(kz_option_label))};
  KZ_TRY(kz_tree_read(text, length, file, false, &tree->root));
  kz_tree_name_symbols(kz_scene_keys(), tree->root);
  for (int i = 0; tree->root->kind == KZ_MAPPING && i < n_sets; i++) {
    print_label(sets[i], tree->labels[i]);
    KZ_TRY(apply_set(kz_scene_keys(), tree->root, sets[i], tree->labels[i]));
  }
  return KZ_OK;
}

void kz_scene_tree_free(kz_scene_tree *tree) {
  kz_tree_free(tree->root);
  free(tree->labels);
}

static kz_status read_tree(kz_node *root, kz_scene *scene) {
  kz_reading reading = {.keys = kz_scene_keys(), .root = root, .scene = scene};
  KZ_TRY(kz_reading_keys(&reading));
  if (root->kind == KZ_MAPPING) kz_reading_rules(&reading);
  if (reading.message[0]) return kz_fail(KZ_REFUSED, "%s", reading.message);
  if (!scene->title) scene->title = kz_strdup("");
  return KZ_OK;
}

kz_status kz_scene_of_tree(kz_node *root, kz_scene *scene) {
  *scene = (kz_scene){.series = kz_kept_series_create()};
  kz_plans_create(scene);
  kz_tree_name_symbols(kz_scene_keys(), root); /* symbols of a request */
  const kz_status status = read_tree(root, scene);
  if (status != KZ_OK) kz_scene_free(scene);
  return status;
}

kz_status kz_scene_read(const char *text, size_t length, const char *file, int n_sets, char *const *sets,
                        kz_scene *scene) {
  kz_scene_tree tree;
  memset(scene, 0, sizeof *scene);
  kz_status status = kz_scene_tree_read(text, length, file, n_sets, sets, &tree);
  if (status == KZ_OK) status = kz_scene_of_tree(tree.root, scene);
  if (status == KZ_OK) kz_numerics_resolve(scene);
  kz_scene_tree_free(&tree);
  return status;
}

/* Complains about the first of `keys` ("KEY|KEY") in the tree, or at the mapping that lacks the last one. */
static void complain_first(kz_reading *reading, char *keys, const char *wrong) {
  char *rest = keys;
  for (char *key; (key = strsep(&rest, "|"));) {
    if (!kz_tree_find(reading->root, key) && rest) continue;
    kz_complain(reading, key, "%s", wrong);
    return;
  }
}

/* Whether `keys` are keys of a scene, or the scene itself. */
static bool are_keys(const char *keys) {
  char key[256];
  int length;
  if (!keys[0]) return false;
  for (const char *next; (next = kz_words_next(&keys, &length));) {
    snprintf(key, sizeof key, "%.*s", length, next);
    if (!kz_key_find(kz_scene_keys(), key) && strcmp(key, "scene") != 0) return false;
  }
  return true;
}

kz_status kz_scene_locate(kz_status status, const char *text, size_t length, const char *file, int n_sets,
                          char *const *sets) {
  char message[KZ_MESSAGE_BYTES];
  snprintf(message, sizeof message, "%s", kz_message());
  char *end = strstr(message, ": ");
  if ((status != KZ_REFUSED && status != KZ_FAILED) || !end) return status;
  *end = '\0';
  if (!are_keys(message)) return status;
  kz_scene_tree tree;
  kz_reading reading = {.keys = kz_scene_keys(), .first = INT_MAX};
  if (kz_scene_tree_read(text, length, file, n_sets, sets, &tree) == KZ_OK) {
    reading.root = tree.root;
    complain_first(&reading, message, end + 2);
    kz_message_clear();
    kz_fail(status, "%s", reading.message);
  }
  kz_scene_tree_free(&tree);
  return status;
}

void kz_scene_free(kz_scene *scene) {
  free(scene->title);
  kz_plans_free(scene);
  kz_kept_series_free(scene->series);
  memset(scene, 0, sizeof *scene);
}

/* ---- scenes of the library ---- */

/* The mappings that a pendulum of the library takes of its scene. */
static bool is_taken(const char *name) {
  return strcmp(name, "pendulum") == 0 || strcmp(name, "numerics") == 0 || strcmp(name, "basin") == 0;
}

static void drop_others(kz_node *root) {
  for (kz_node *node = root->first, *next; node; node = next) {
    next = node->next;
    if (!is_taken(node->name) && kz_key_find(kz_scene_keys(), node->name)) kz_tree_free(kz_tree_take(root, node->name));
  }
  kz_tree_free(kz_tree_take(root, "basin.accuracy"));
}

static kz_status set_flow(kz_node *root, const char *path, const char *text, const char *source) {
  kz_node *node;
  KZ_TRY(kz_tree_read(text, strlen(text), source, true, &node));
  return kz_tree_set(root, path, node);
}

/* Whether an axis of the change has a number of cells alone. */
static bool is_count(const kz_node *axis) {
  return axis->kind == KZ_MAPPING && axis->first && !axis->first->next && strcmp(axis->first->name, "count") == 0;
}

/* Puts the children of a mapping of the change into that of the scene. */
static kz_status put_children(kz_node *root, kz_node *mapping) {
  while (mapping->first) {
    char path[256];
    kz_node *child = kz_tree_take(mapping, mapping->first->name);
    const bool count = is_count(child);
    snprintf(path, sizeof path, "%.120s.%.120s%s", mapping->name, child->name, count ? ".count" : "");
    if (!count) {
      KZ_TRY(kz_tree_set(root, path, child));
      continue;
    }
    const kz_status status = kz_tree_set(root, path, kz_tree_take(child, "count"));
    kz_tree_free(child);
    KZ_TRY(status);
  }
  return KZ_OK;
}

/* Keys of a mapping `basin` replace those of the scene one by one, and counts of cells alone; other mappings as a
 * whole. */
static kz_status put_change(kz_node *root, kz_node *change) {
  if (change->kind != KZ_MAPPING) return kz_fail(KZ_REFUSED, "change: is not a list of mappings of a scene");
  for (kz_node *node; (node = change->first);) {
    char name[256];
    snprintf(name, sizeof name, "%.250s", node->name);
    if (strcmp(name, "basin") == 0 && node->kind == KZ_MAPPING) {
      KZ_TRY(put_children(root, node));
      kz_tree_free(kz_tree_take(change, name));
    } else {
      KZ_TRY(kz_tree_set(root, name, kz_tree_take(change, name)));
    }
  }
  return KZ_OK;
}

static kz_status take_change(kz_node *root, const char *change) {
  const size_t bytes = strlen(change) + 3;
  KZ_AUTOFREE char *flow = kz_malloc(bytes);
  kz_node *mappings;
  snprintf(flow, bytes, "{%s}", change);
  KZ_TRY(kz_tree_read(flow, strlen(flow), "change", true, &mappings));
  const kz_status status = put_change(root, mappings);
  kz_tree_free(mappings);
  return status;
}

static kz_status complete_basin(kz_node *root, const char *change) {
  if (!kz_tree_find(root, "basin"))
    KZ_TRY(set_flow(root, "basin", "{theta: {count: 400}, velocity: {min: -2, max: 2, count: 400}}", "basin"));
  if (change) KZ_TRY(take_change(root, change));
  return set_flow(root, "basin.method", "exact", "basin");
}

kz_status kz_scene_open(const kz_scene_source *given, const char *change, kz_scene *scene) {
  kz_scene_tree tree;
  memset(scene, 0, sizeof *scene);
  kz_status status =
      kz_scene_tree_read(given->text, strlen(given->text), given->name, given->n_sets, given->sets, &tree);
  if (status == KZ_OK && tree.root->kind == KZ_MAPPING) {
    drop_others(tree.root);
    status = complete_basin(tree.root, change);
  }
  if (status == KZ_OK) status = kz_scene_of_tree(tree.root, scene);
  kz_scene_tree_free(&tree);
  return status;
}

kz_status kz_scene_ask(const kz_scene_source *given, kz_status (*answer)(const kz_scene *scene, void *context),
                       void *context) {
  const size_t length = strlen(given->text);
  kz_scene scene;
  KZ_TRY(kz_scene_read(given->text, length, given->name, given->n_sets, given->sets, &scene));
  kz_status status = kz_studies_check(&scene);
  if (status == KZ_OK) status = answer(&scene, context);
  status = kz_scene_locate(status, given->text, length, given->name, given->n_sets, given->sets);
  kz_scene_free(&scene);
  return status;
}

kz_status kz_tables_make(void) {
  enum { TABLES_BYTES = 1 << 20 };
  if (!kz_memory_is_there(TABLES_BYTES)) return kz_fail(KZ_FAILED, "memory ran out");
  kz_scene_keys();
  return KZ_OK;
}
