/* Numbers with a unit behind them: angles in degrees or parts of pi, lengths in cm, and so on. */
#include <ctype.h>

#include "scene.h"

enum { LONGEST = 64 };

/* The number before a unit as a node of its own; `length` characters of the text. */
static const char *read_number(const kz_node *node, size_t length, double *value) {
  char number[LONGEST];
  while (length > 0 && (node->text[length - 1] == ' ' || node->text[length - 1] == '*')) length--;
  if (length == 0 || length >= sizeof number) return "is not a finite decimal number";
  snprintf(number, sizeof number, "%.*s", (int)length, node->text);
  return kz_text_real(number, value);
}

/* Where the letters of pi stand, or NULL. */
static const char *find_pi(const char *text, size_t *letters) {
  const char *found = strstr(text, "pi"), *greek = strstr(text, "\xcf\x80");
  *letters = 2;
  return found ? found : greek;
}

/* Splits "3 pi/4" into "3", written to multiple [bytes], and divisor 4; false if not a part of pi. */
static bool pi_parts(const char *text, char *multiple, size_t bytes, long *divisor) {
  size_t letters;
  char *end;
  const char *pi = find_pi(text, &letters);
  if (!pi) return false;
  size_t length = (size_t)(pi - text);
  while (length > 0 && (text[length - 1] == ' ' || text[length - 1] == '*')) length--;
  if (length == 0 || (length == 1 && (text[0] == '-' || text[0] == '+')))
    snprintf(multiple, bytes, "%.*s1", (int)length, text);
  else
    snprintf(multiple, bytes, "%.*s", (int)length, text);
  *divisor = 1;
  if (pi[letters] == '\0') return true;
  if (pi[letters] != '/' || !isdigit((unsigned char)pi[letters + 1])) return false;
  *divisor = strtol(pi + letters + 1, &end, 10);
  return *end == '\0' && *divisor > 0;
}

/* 180 degrees and pi are M_PI to the bit. */
const char *kz_scalar_angle(const kz_node *node, double *value) {
  static const char *const degrees[] = {"deg", "\xc2\xb0"};
  char multiple[LONGEST];
  long divisor;
  const size_t length = node->kind == KZ_SCALAR ? strlen(node->text) : 0;
  for (int i = 0; i < 2; i++) {
    const size_t n = strlen(degrees[i]);
    if (length <= n || strcmp(node->text + length - n, degrees[i]) != 0) continue;
    const char *wrong = read_number(node, length - n, value);
    if (!wrong) *value = *value / 180 * M_PI;
    return wrong;
  }
  if (length == 0 || !pi_parts(node->text, multiple, sizeof multiple, &divisor)) return kz_scalar_real(node, value);
  const char *wrong = kz_text_real(multiple, value);
  if (!wrong) *value = *value * M_PI / (double)divisor;
  return wrong;
}

/* The nearest double to an angle that is no decimal number: a part of pi, or one with the sign of degrees. */
static const char *angle_decimal(const kz_node *node, kz_decimal *value) {
  double angle;
  const char *wrong = kz_scalar_angle(node, &angle);
  if (wrong) return wrong;
  kz_short_text number = kz_shortest(angle);
  return kz_scalar_decimal(&(kz_node){.kind = KZ_SCALAR, .text = number.text, .plain = true}, false, value);
}

const char *kz_scalar_decimal(const kz_node *node, bool is_angle, kz_decimal *value) {
  static const char unit[] = " deg";
  char number[KZ_DECIMAL_LENGTH];
  bool whole;
  const char *wrong = kz_scalar_text_within(node, sizeof number - 1, "has more than 1023 characters");
  if (wrong) return wrong;
  if (is_angle && (strstr(node->text, "pi") || strpbrk(node->text, "\xc2\xcf"))) return angle_decimal(node, value);
  const char *tail = is_angle ? strstr(node->text, unit) : NULL;
  const bool degrees = tail && tail[sizeof unit - 1] == '\0';
  snprintf(number, sizeof number, "%.*s", (int)(degrees ? tail - node->text : (long)strlen(node->text)), node->text);
  if (!kz_text_is_decimal(number, &whole)) return "is not a finite decimal number";
  const __float128 quad = kz_decimal_quad(node->text);
  value->high = (double)quad;
  if (!isfinite(value->high)) return "is too large for double precision";
  const size_t mantissa = strcspn(number, "eE");
  if (value->high == 0.0 && strcspn(number, "123456789") < mantissa) return "is too small for double precision";
  value->low = (double)(quad - value->high);
  memcpy(value->text, node->text, strlen(node->text) + 1);
  return NULL;
}

/* Words behind a number. */
static const char *behind_number(const char *text) {
  const char *rest = text + strspn(text, "+-.0123456789"); /* an exponent belongs to the number */
  if ((*rest == 'e' || *rest == 'E') &&
      (isdigit((unsigned char)rest[1]) || ((rest[1] == '-' || rest[1] == '+') && isdigit((unsigned char)rest[2]))))
    rest += 1 + strspn(rest + 1, "+-0123456789");
  return rest;
}

const char *kz_scalar_quantity(const kz_node *node, const char *of, double *value) {
  kz_written_unit unit;
  if (node->kind != KZ_SCALAR) return kz_scalar_real(node, value);
  const char *rest = behind_number(node->text);
  const size_t length = (size_t)(rest - node->text);
  if (*rest == '\0' || length == 0) return kz_scalar_real(node, value);
  const char *wrong = kz_unit_find(rest, of, &unit);
  if (!wrong) wrong = read_number(node, length, value);
  if (!wrong && unit.factor != 1) *value *= unit.factor;
  return wrong;
}

kz_written_unit kz_scalar_unit(const kz_node *node, const char *of) {
  kz_written_unit unit = {.name = ""};
  if (node->kind != KZ_SCALAR) return unit;
  const char *rest = behind_number(node->text);
  rest += strspn(rest, " ");
  if (strcmp(of, "rad") != 0) {
    if (*rest) kz_unit_find(rest, of, &unit);
  } else if (strcmp(rest, "deg") == 0 || strcmp(rest, "\xc2\xb0") == 0) {
    unit.factor = M_PI / 180;
    snprintf(unit.name, sizeof unit.name, "%s", rest);
  }
  return unit;
}

bool kz_scalar_per_second(const kz_node *node, double pivot_frequency, double *value, const char **wrong) {
  double bare, speed;
  if (!kz_scalar_real(node, &bare) || kz_scalar_quantity(node, KZ_VELOCITY_UNIT, &speed)) return false;
  *wrong = isnan(pivot_frequency) ? "is per second, but the scene is not in SI units" : NULL;
  *value = speed / pivot_frequency;
  return true;
}
