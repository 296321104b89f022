/* Units that a value may be written in: a small table, each row with the unit of the keys that take it. */
#include "scene.h"

typedef struct {
  const char *of, *name; /* unit of the key; how it is written, without ^ and with one blank between factors */
  double factor;         /* to the unit of the key */
} unit;

static const unit units[] = {
    {"m", "m", 1},
    {"m", "cm", 1e-2},
    {"m", "mm", 1e-3},
    {"m", "um", 1e-6},
    {"m", "in", 0.0254},
    {"kg", "kg", 1},
    {"kg", "g", 1e-3},
    {"kg", "mg", 1e-6},
    {"s", "s", 1},
    {"s", "ms", 1e-3},
    {"s", "min", 60},
    {"Hz", "Hz", 1},
    {"Hz", "kHz", 1e3},
    {"Hz", "rpm", 1.0 / 60},
    {"Hz", "1/min", 1.0 / 60},
    {"Hz", "1/s", 1},
    {"Hz", "rad/s", 1 / (2 * M_PI)},
    {"rad s-1", "rad/s", 1},
    {"rad s-1", "Hz", 2 * M_PI},
    {"rad s-1", "rpm", 2 * M_PI / 60},
    {KZ_VELOCITY_UNIT, "rad/s", 1}, /* per second: what a drive radian is depends on the scene (quantity.c) */
    {KZ_VELOCITY_UNIT, "deg/s", M_PI / 180},
    {KZ_VELOCITY_UNIT, "\xc2\xb0/s", M_PI / 180},
    {"m s-2", "m/s2", 1},
    {"m s-2", "cm/s2", 1e-2},
    {"kg m2", "kg m2", 1},
    {"kg m2", "kg cm2", 1e-4},
    {"kg m2", "g m2", 1e-3},
    {"kg m2", "g cm2", 1e-7},
    {"kg m2 s-1", "kg m2/s", 1},
    {"kg m2 s-1", "g cm2/s", 1e-7},
    {"kg m2 s-1", "N m s", 1},
    {"N m", "N m", 1},
    {"N m", "mN m", 1e-3},
    {"N m", "uN m", 1e-6},
};
enum { UNITS = sizeof units / sizeof units[0] };

/* The text without ^, with blanks for * and one blank at most in a row. */
static void units_normalize(const char *text, char *name, size_t bytes) {
  size_t n = 0;
  for (const char *c = text; *c && n + 1 < bytes; c++) {
    const char letter = *c == '*' ? ' ' : *c;
    if (letter == '^' || (letter == ' ' && (n == 0 || name[n - 1] == ' '))) continue;
    name[n++] = letter;
  }
  while (n > 0 && name[n - 1] == ' ') n--;
  name[n] = '\0';
}

bool kz_unit_is_known(const char *of) {
  for (int i = 0; i < UNITS; i++)
    if (strcmp(units[i].of, of) == 0) return true;
  return false;
}

const char *kz_unit_find(const char *text, const char *of, kz_written_unit *found) {
  char name[32];
  units_normalize(text, name, sizeof name);
  const char *other = NULL;
  for (int i = 0; i < UNITS; i++) {
    if (strcmp(units[i].name, name) != 0) continue;
    other = units[i].of;
    if (of[0] && strcmp(other, of) != 0) continue;
    *found = (kz_written_unit){.factor = units[i].factor};
    snprintf(found->name, sizeof found->name, "%s", name);
    return NULL;
  }
  return other ? "is in a unit of another quantity" : "is not a finite decimal number";
}

void kz_unit_names(const char *of, char *text, size_t bytes) {
  text[0] = '\0';
  for (int i = 0; i < UNITS; i++)
    if (strcmp(units[i].of, of) == 0 && strcmp(units[i].name, of) != 0)
      snprintf(text + strlen(text), bytes - strlen(text), "%s%s", text[0] ? ", " : "", units[i].name);
}
