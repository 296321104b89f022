/* Types of numbers in docs/reference/scene.md: each defined once, linked from the rows of keys. */
#include "scene.h"

typedef struct {
  const char *unit, *path; /* Unit of its keys, and a part of their path that distinguishes two types of one unit */
  const char *article, *name, *note;
} type;

static const type types[] = {
    {"rad", "", "an", "angle",
     "A degree sign may stand for the word: 90°. Angles are counted from the down position, counterclockwise."},
    {KZ_VELOCITY_UNIT, "", "a", "velocity",
     "Units are for scenes in SI units whose studies do not change the frequency of the pivot. A velocity of 1 is one "
     "turn "
     "in a drive period."},
    {"Hz", "", "a", "frequency", "A frequency is a number of periods a second: 1 rad/s is 1/(2 pi) Hz."},
    {"rad s-1", "", "an", "angular frequency", "1 Hz is 2 pi rad/s."},
    {"m", "amplitude", "an", "amplitude", "It is half of the pivot's stroke. Without a unit it is at most 1 m."},
    {"m", "", "a", "length", "Without a unit it is at most 10 m."},
    {"s", "", "a", "time", ""},
    {"m s-2", "", "an", "acceleration", ""},
    {"kg", "", "a", "mass", ""},
    {"kg m2", "", "a", "moment of inertia", ""},
    {"kg m2 s-1", "", "a", "friction", "It is a torque divided by an angular velocity."},
    {"N m", "", "a", "torque", ""},
    {KZ_OWN_UNIT, "", "a", "value",
     "Any unit of the parameter may stand behind it; an angle is in rad, in degrees or a part of pi."},
};
enum { TYPES = sizeof types / sizeof types[0] };

static const type *type_of(const kz_key *key) {
  for (int i = 0; i < TYPES; i++)
    if (strcmp(types[i].unit, key->unit) == 0 && strstr(key->path, types[i].path)) return types + i;
  return NULL;
}

void kz_type_accepts(const kz_key *keys, const kz_key *key, char *text, size_t bytes) {
  char noun[128], anchor[64];
  const type *found = type_of(key);
  if (!found) {
    kz_key_accepts(keys, key, text, bytes);
    return;
  }
  snprintf(anchor, sizeof anchor, "%s", found->name);
  for (char *blank = anchor; (blank = strchr(blank, ' '));) *blank = '-';
  const bool list = key->type == KZ_KEY_REALS;
  snprintf(noun, sizeof noun, "%s%s [%s](#%s)", list ? "a list of numbers, each " : "", found->article, found->name,
           anchor);
  kz_key_accepts_with(keys, key, noun, "", text, bytes);
}

void kz_types_write(const kz_key *keys, FILE *out) {
  fputs("\n## Types of numbers\n\nWhat stands behind a number is its unit; a blank between them may be left out.\n",
        out);
  for (int i = 0; i < TYPES; i++) {
    const kz_key *key = keys;
    while (key->path && type_of(key) != types + i) key++;
    if (!key->path) continue;
    char unit[256];
    kz_key_unit_words(key, unit, sizeof unit);
    fprintf(out, "\n### %s\n\nA number%s.%s%s\n", types[i].name, unit, types[i].note[0] ? " " : "", types[i].note);
  }
}
