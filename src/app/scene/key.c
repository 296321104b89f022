/* Functions on a row of the table of keys. */
#include "scene.h"

enum { LONGEST_WORD = 63 };

const char *kz_key_words(const kz_key *key) {
  if (key->words) return key->words;
  return key->words_from ? key->words_from() : "";
}

int64_t kz_word_find(const char *words, const char *word) {
  const char *next;
  int length;
  for (int64_t index = 0; (next = kz_words_next(&words, &length)); index++)
    if (strlen(word) == (size_t)length && strncmp(next, word, (size_t)length) == 0) return index;
  return -1;
}

double kz_key_most_bare(const kz_key *key) {
  if (strcmp(key->unit, "m") != 0) return INFINITY;
  return strstr(key->path, "amplitude") ? 1 : 10;
}

bool kz_key_is_parameter(const kz_key *key) {
  return key->words_from == kz_sweep_words || key->words_from == kz_motion_words;
}

bool kz_key_is_angle(const kz_key *key) {
  return strcmp(key->unit, "rad") == 0;
}

const char *kz_key_name(const kz_key *key) {
  const char *dot = strrchr(key->path, '.');
  return dot ? dot + 1 : key->path;
}

/* Whether `path` is that of the key with its symbol in place of its name. */
static bool is_by_symbol(const kz_key *key, const char *path) {
  const size_t above = (size_t)(kz_key_name(key) - key->path);
  return key->symbol && strncmp(key->path, path, above) == 0 && strcmp(path + above, key->symbol) == 0;
}

const kz_key *kz_key_find(const kz_key *keys, const char *path) {
  for (; keys->path; keys++)
    if (strcmp(keys->path, path) == 0 || is_by_symbol(keys, path)) return keys;
  return NULL;
}

/* True where `path` is a key of the mapping `parent` ("" = the scene itself), not deeper. */
static bool is_child(const char *path, const char *parent) {
  const size_t length = strlen(parent);
  if (length == 0) return strchr(path, '.') == NULL;
  return strncmp(path, parent, length) == 0 && path[length] == '.' && strchr(path + length + 1, '.') == NULL;
}

/* "from 1 to 512", "above 0", "of at least 0", or nothing where any value does. */
static void print_range(const kz_key *key, char *text, size_t bytes) {
  const kz_short_text low = kz_shortest(key->low), high = kz_shortest(key->high);
  const bool bounded = key->high < DBL_MAX;
  if (key->low <= -DBL_MAX)
    snprintf(text, bytes, "%s", "");
  else if (key->low == KZ_ABOVE_ZERO)
    snprintf(text, bytes, bounded ? " above 0 and up to %s" : " above 0", high.text);
  else if (bounded)
    snprintf(text, bytes, " from %s to %s", low.text, high.text);
  else
    snprintf(text, bytes, " of at least %s", low.text);
}

void kz_key_list(const char *words, char *text, size_t bytes) {
  size_t at = 0;
  for (; *words && at + 3 < bytes; words++) {
    text[at++] = *words == '|' ? ',' : *words;
    if (*words == '|') text[at++] = ' ';
  }
  text[at] = '\0';
}

/* The names of the keys of mapping `parent`, joined by '|', written to `text` [bytes]. */
static void key_children(const kz_key *keys, const char *parent, char *text, size_t bytes) {
  const size_t skip = parent[0] ? strlen(parent) + 1 : 0;
  text[0] = '\0';
  for (; keys->path; keys++)
    if (is_child(keys->path, parent)) kz_words_add(text, bytes, keys->path + skip);
}

void kz_key_unit_words(const kz_key *key, char *text, size_t bytes) {
  char others[128] = "";
  kz_unit_names(key->unit, others, sizeof others);
  snprintf(text, bytes, "%s%s%s%s%s", key->unit[0] ? " in " : "", key->unit, others[0] ? ", or with its unit: " : "",
           others, kz_key_is_angle(key) ? ", or in degrees such as 90 deg, or a part of pi such as pi/2" : "");
}

void kz_key_accepts_with(const kz_key *keys, const kz_key *key, const char *noun, const char *unit, char *text,
                         size_t bytes) {
  char names[512] = "", detail[512] = "";
  if (key->type == KZ_KEY_MAPPING)
    key_children(keys, key->path, names, sizeof names);
  else
    snprintf(names, sizeof names, "%s", kz_key_words(key));
  kz_key_list(names, detail, sizeof detail);
  if (key->high > key->low) print_range(key, detail, sizeof detail);
  const bool word_too = key->type == KZ_KEY_COUNT && names[0];
  snprintf(text, bytes, "%s%s%s%s%s", noun, detail, unit, word_too ? ", or " : "", word_too ? names : "");
}

void kz_key_accepts(const kz_key *keys, const kz_key *key, char *text, size_t bytes) {
  static const char *const nouns[] = {
      [KZ_KEY_MAPPING] = "a mapping of ",
      [KZ_KEY_TEXT] = "one line of text",
      [KZ_KEY_WORD] = "one of ",
      [KZ_KEY_BOOLEAN] = "true or false",
      [KZ_KEY_INTEGER] = "an integer",
      [KZ_KEY_COUNT] = "an integer",
      [KZ_KEY_REAL] = "a number",
      [KZ_KEY_DECIMAL] = "a number",
      [KZ_KEY_WORDS] = "a list out of ",
      [KZ_KEY_INTEGERS] = "a list of integers",
      [KZ_KEY_REALS] = "a list of numbers",
      [KZ_KEY_HARMONICS] = "a list of {order: 1 to " KZ_STRINGIFY(KZ_HARMONICS) ", amplitude, phase}",
  };
  char unit[256];
  kz_key_unit_words(key, unit, sizeof unit);
  kz_key_accepts_with(keys, key, nouns[key->type], unit, text, bytes);
}

static size_t key_least(size_t a, size_t b) {
  return a < b ? a : b;
}

/* Edit distance with swapped neighbours counted once (Damerau 1964, optimal string alignment). */
static size_t key_distance(const char *a, const char *b) {
  size_t d[LONGEST_WORD + 1][LONGEST_WORD + 1];
  const size_t n = strlen(a), m = strlen(b);
  if (n > LONGEST_WORD || m > LONGEST_WORD) return SIZE_MAX;
  for (size_t i = 0; i <= n; i++)
    for (size_t j = 0; j <= m; j++) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const size_t change = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = key_least(change, key_least(d[i - 1][j], d[i][j - 1]) + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = key_least(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

/* Writes what stands for `word` in a list "word=meaning|word=meaning" to `now`; false if it is not there. */
static bool find_meaning(const char *pairs, const char *word, char *now, size_t bytes) {
  const size_t length = strlen(word);
  for (const char *pair = pairs; pair; pair = strchr(pair, '|') ? strchr(pair, '|') + 1 : NULL) {
    if (strncmp(pair, word, length) != 0 || pair[length] != '=') continue;
    pair += length + 1;
    snprintf(now, bytes, "%.*s", (int)strcspn(pair, "|"), pair);
    return true;
  }
  return false;
}

bool kz_key_renamed(const kz_key *key, const char *word, char *now, size_t bytes) {
  return find_meaning(key->former, word, now, bytes);
}

bool kz_key_suggest(const char *word, const char *words, char *nearest, size_t bytes) {
  size_t best = strlen(word) / 3 + 1; /* a larger distance is no similarity */
  if (best > 3) best = 3;
  bool found = false;
  int length;
  for (const char *next; (next = kz_words_next(&words, &length));) {
    char candidate[LONGEST_WORD + 1];
    snprintf(candidate, sizeof candidate, "%.*s", length, next);
    const size_t d = key_distance(word, candidate);
    if (d < best || (d == best && !found)) {
      best = d;
      found = true;
      snprintf(nearest, bytes, "%s", candidate);
    }
  }
  return found;
}

/* The key of the pendulum with this name, else the only key of any mapping with it; NULL if there is none. */
static const kz_key *find_elsewhere(const kz_key *keys, const char *name) {
  const kz_key *found = NULL;
  int n = 0;
  for (; keys->path; keys++) {
    const char *dot = strrchr(keys->path, '.');
    if (!dot || strcmp(dot + 1, name) != 0) continue;
    if (strncmp(keys->path, "pendulum.", 9) == 0) return keys;
    found = keys;
    n++;
  }
  return n == 1 ? found : NULL;
}

/* Refuses the former name of a study: the row of a study lists its former names. */
static bool was_a_study(const kz_key *keys, const char *name, char *now, size_t bytes) {
  for (; keys->path; keys++)
    if (keys->type == KZ_KEY_MAPPING && !strchr(keys->path, '.') && kz_key_renamed(keys, name, now, bytes)) return true;
  return false;
}

const char *kz_key_missing_power(const char *path) {
  static const char *const missing[][2] = {
#define MISSING(name, power) {#name, #power},
      KZ_MISSING_STUDIES(MISSING){NULL, NULL}};
  for (size_t i = 0; missing[i][0]; i++)
    if (strcmp(missing[i][0], path) == 0) return missing[i][1];
  return NULL;
}

void kz_key_unknown(const kz_key *keys, const char *parent, const char *name, const char *prefix, char *text,
                    size_t bytes) {
  char path[256];
  snprintf(path, sizeof path, "%s%s%s", parent, parent[0] ? "." : "", name);
  const char *power = kz_key_missing_power(path);
  if (power) {
    snprintf(text, bytes, KZ_MISSING_POWER, power);
    return;
  }
  char names[1024], list[1024], nearest[64];
  const kz_key *mapping = kz_key_find(keys, parent), *elsewhere = find_elsewhere(keys, name);
  key_children(keys, parent, names, sizeof names);
  kz_key_list(names, list, sizeof list);
  if (mapping ? kz_key_renamed(mapping, name, nearest, sizeof nearest)
              : was_a_study(keys, name, nearest, sizeof nearest))
    snprintf(text, bytes, "is no longer a key; use %s", nearest);
  else if (mapping && find_meaning(mapping->words, name, nearest, sizeof nearest))
    snprintf(text, bytes, "unknown key; the program calls it %s", nearest);
  else if (kz_key_suggest(name, names, nearest, sizeof nearest))
    snprintf(text, bytes, "unknown key; did you mean %s%s?", prefix, nearest);
  else if (elsewhere)
    snprintf(text, bytes, "unknown key; did you mean %s?", elsewhere->path);
  else
    snprintf(text, bytes, "unknown key; the keys are %s", list);
}
