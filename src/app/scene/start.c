/* Starts that a caller of the library gives as texts. */
#include <ctype.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

#include "kapitza/app.h"
#include "scene.h"

/* Whether a number has more digits than are needed to distinguish doubles. */
static bool is_long(const char *text) {
  const char *c = text + strspn(text, "+-0.");
  int digits = 0;
  for (; isdigit((unsigned char)*c) || *c == '.'; c++) digits += *c != '.';
  return digits > DBL_DECIMAL_DIG;
}

/* Whether a text is digits alone, maybe with " deg" behind them. */
static bool is_digits(const char *text) {
  const size_t digits = strspn(text, "+-.0123456789eE");
  return text[digits] == '\0' || strcmp(text + digits, " deg") == 0;
}

static kz_status read_number(const char *text, bool is_angle, int64_t i, double pivot_frequency,
                             kz_coordinate *coordinate) {
  const double most = is_angle ? 1e6 : KZ_MOST_SPEED; /* as of the windows of a scene */
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)text, .plain = true};
  kz_decimal value = {0};
  const char *wrong = NULL;
  char number[64], hint[96] = "";
  if (is_angle || !kz_scalar_per_second(&node, pivot_frequency, &value.high, &wrong))
    wrong = kz_scalar_decimal(&node, is_angle, &value);
  if (!wrong && (value.high < -most || value.high > most)) wrong = "is out of range";
  *coordinate = (kz_coordinate){.high = value.high, .low = value.low};
  if (!wrong) return KZ_OK;
  if (kz_scalar_with_a_point(text, number, sizeof number))
    snprintf(hint, sizeof hint, " (with a decimal point: %s)", number);
  return kz_fail(KZ_REFUSED, "start %lld: %s: \"%.60s\" %s%s; it must be a number from %g to %g in %s",
                 (long long)i + 1, is_angle ? "THETA" : "VELOCITY", text, wrong, hint, -most, most,
                 is_angle ? "rad, or in degrees such as 90 deg, or a part of pi such as pi/2" : KZ_VELOCITY_UNIT);
}

kz_status kz_start_read(const char *theta, const char *velocity, int64_t i, double pivot_frequency, bool all,
                        kz_coordinate start[2]) {
  const char *const text[2] = {theta, velocity};
  const bool digits = all || is_long(theta) || is_long(velocity);
  for (int k = 0; k < 2; k++) {
    KZ_TRY(read_number(text[k], k == 0, i, pivot_frequency, start + k));
    if (digits && is_digits(text[k]))
      start[k].centre = text[k];
    else
      start[k].low = 0;
  }
  return KZ_OK;
}
