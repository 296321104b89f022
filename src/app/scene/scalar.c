/* Strict scalars: decimal numbers only, no octal look, no nan, nothing quoted but numbers of many digits. */
#include <ctype.h>
#include <errno.h>

#include "scene.h"

static const char *skip_digits(const char *c) {
  while (isdigit((unsigned char)*c)) c++;
  return c;
}

bool kz_text_is_decimal(const char *text, bool *whole) {
  const char *start = text + (*text == '-' || *text == '+');
  const char *c = skip_digits(start);
  long digits = c - start;
  if (digits > 1 && *start == '0') return false;
  *whole = *c == '\0';
  if (*c == '.') {
    const char *end = skip_digits(c + 1);
    digits += end - c - 1;
    c = end;
  }
  if (digits == 0) return false;
  if (*c == 'e' || *c == 'E') {
    const char *exponent = c + 1 + (c[1] == '-' || c[1] == '+');
    c = skip_digits(exponent);
    if (c == exponent) return false;
  }
  return *c == '\0';
}

/* Returns why a node is no unquoted scalar, or NULL. */
static const char *not_plain(const kz_node *node) {
  if (node->kind == KZ_SEQUENCE) return "is a list";
  if (node->kind == KZ_MAPPING) return "is a mapping";
  if (!node->plain) return "stands in quotes";
  return node->text[0] ? NULL : "is empty";
}

const char *kz_scalar_integer(const kz_node *node, int64_t *value) {
  bool whole;
  const char *wrong = not_plain(node);
  if (wrong) return wrong;
  if (!kz_text_is_decimal(node->text, &whole)) return "is not a decimal number";
  if (!whole) return "is not an integer";
  errno = 0;
  *value = strtoll(node->text, NULL, 10);
  return errno ? "is out of range" : NULL;
}

const char *kz_scalar_real(const kz_node *node, double *value) {
  bool whole;
  const char *wrong = not_plain(node);
  if (wrong) return wrong;
  if (!kz_text_is_decimal(node->text, &whole)) return "is not a finite decimal number";
  *value = strtod(node->text, NULL);
  if (!isfinite(*value)) return "is too large for double precision";
  const size_t mantissa = strcspn(node->text, "eE");
  if (*value == 0.0 && strcspn(node->text, "123456789") < mantissa) return "is too small for double precision";
  return NULL;
}

const char *kz_text_real(const char *text, double *value) {
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)text, .plain = true};
  return kz_scalar_real(&node, value);
}

const char *kz_scalar_text_within(const kz_node *node, size_t most, const char *too_long) {
  if (node->kind == KZ_SEQUENCE) return "is a list";
  if (node->kind == KZ_MAPPING) return "is a mapping";
  if (node->plain && node->text[0] == '\0') return "is empty";
  for (const char *c = node->text; *c; c++)
    if (kz_control_bytes(c)) return "holds a line break or a control character";
  return strlen(node->text) > most ? too_long : NULL;
}

const char *kz_scalar_boolean(const kz_node *node, bool *value) {
  const char *wrong = not_plain(node);
  if (wrong) return wrong;
  *value = strcmp(node->text, "true") == 0;
  return *value || strcmp(node->text, "false") == 0 ? NULL : "is neither true nor false";
}

int kz_control_bytes(const char *c) {
  const unsigned char first = (unsigned char)c[0], last = c[0] && c[1] ? (unsigned char)c[2] : 0;
  /* U+200E, U+200F, U+202A to U+202E and U+2066 to U+2069 turn the direction of a terminal's text. */
  const bool turns = last == 0x8e || last == 0x8f || (last >= 0xaa && last <= 0xae);
  if (first == 0xe2 && (unsigned char)c[1] == 0x80) return turns ? 3 : 0;
  if (first == 0xe2 && (unsigned char)c[1] == 0x81) return last >= 0xa6 && last <= 0xa9 ? 3 : 0;
  if (first == 0xc2) return (unsigned char)c[1] >= 0x80 && (unsigned char)c[1] <= 0x9f ? 2 : 0;
  return (first > 0 && first < 0x20) || first == 0x7f;
}

const char *kz_scalar_text(const kz_node *node) {
  return kz_scalar_text_within(node, 500, "is longer than 500 bytes");
}

kz_short_text kz_shortest(double value) {
  kz_short_text number;
  int digits = 15;
  do snprintf(number.text, sizeof number.text, "%.*g", digits, value);
  while (strtod(number.text, NULL) != value && ++digits <= 17);
  return number;
}

bool kz_scalar_with_a_point(const char *text, char *number, size_t bytes) {
  const size_t before = strspn(text, "+-0123456789");
  if (before == 0 || text[before] != ',') return false;
  const size_t after = strspn(text + before + 1, "0123456789");
  if (after == 0 || text[before + 1 + after] != '\0') return false;
  snprintf(number, bytes, "%.*s.%s", (int)before, text, text + before + 1);
  return true;
}
