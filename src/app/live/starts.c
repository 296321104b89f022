/* Starts that the command where asks about: two operands, or a table on standard input. */
#include <ctype.h>

#include "where.h"

enum { MOST_STARTS = 100000 };

/* Largest angle and velocity, as for the windows of a scene. */
static const double MOST[2] = {1e6, KZ_MOST_SPEED};
static const char *const NAMES[2] = {"THETA", "VELOCITY"};

/* Whether a number has more digits than are needed to distinguish doubles. */
static bool is_long(const char *text) {
  const char *c = text + strspn(text, "+-0.");
  int digits = 0;
  for (; isdigit((unsigned char)*c) || *c == '.'; c++) digits += *c != '.';
  return digits > DBL_DECIMAL_DIG;
}

/* One number of start i; `place` names it. */
static kz_status read_number(const char *text, int which, const char *place, kz_starts *starts, int64_t i) {
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)text, .plain = true};
  kz_decimal value = {0};
  const char *wrong = NULL;
  char number[64];
  if (which == 0 || !kz_scalar_per_second(&node, starts->pivot_frequency, &value.high, &wrong))
    wrong = kz_scalar_decimal(&node, which == 0, &value);
  if (!wrong && (value.high < -MOST[which] || value.high > MOST[which])) wrong = "is out of range";
  starts->start[i][which] = (kz_coordinate){.high = value.high, .low = value.low};
  if (!wrong) return KZ_OK;
  char hint[96] = "";
  if (kz_scalar_with_a_point(text, number, sizeof number))
    snprintf(hint, sizeof hint, " (with a decimal point: %s)", number);
  return kz_fail(KZ_REFUSED, "%s: %s: \"%.60s\" %s%s; it must be a number from %g to %g in %s", place, NAMES[which],
                 text, wrong, hint, -MOST[which], MOST[which],
                 which == 0 ? "rad, or in degrees such as 90 deg, or a part of pi such as pi/2" : KZ_VELOCITY_UNIT);
}

/* Whether a text is digits alone, maybe with " deg" behind them. */
static bool is_digits(const char *text) {
  const size_t digits = strspn(text, "+-.0123456789eE");
  return text[digits] == '\0' || strcmp(text + digits, " deg") == 0;
}

/* Of a start without a long number the nearest doubles are taken: cells of a file keep their labels. */
static void take_digits(const char *const text[2], kz_coordinate start[2]) {
  const bool all = is_long(text[0]) || is_long(text[1]);
  for (int i = 0; i < 2; i++) {
    if (all && is_digits(text[i]))
      start[i].centre = kz_strdup(text[i]);
    else
      start[i].low = 0;
  }
}

static kz_status read_start(const char *const text[2], const char *place, kz_starts *starts) {
  for (int i = 0; i < 2; i++) KZ_TRY(read_number(text[i], i, place, starts, starts->n));
  take_digits(text, starts->start[starts->n++]);
  return KZ_OK;
}

/* Cuts blanks from both ends, in place. */
static char *starts_trimmed(char *text) {
  text += strspn(text, " \t");
  for (size_t n = strlen(text); n > 0 && strchr(" \t\r\n", text[n - 1]); n--) text[n - 1] = '\0';
  return text;
}

static kz_status read_row(char *line, int64_t number, kz_starts *starts) {
  char place[64];
  snprintf(place, sizeof place, "standard input:%lld", (long long)number);
  char *comma = strchr(line, ',');
  if (!comma || strchr(comma + 1, ','))
    return kz_fail(KZ_REFUSED, "%s: \"%.60s\" is not a start; write theta,velocity", place, starts_trimmed(line));
  *comma = '\0';
  const char *const text[2] = {starts_trimmed(line), starts_trimmed(comma + 1)};
  return read_start(text, place, starts);
}

/* A first line of names, and empty lines, are no starts. */
static bool is_start(const char *line, int64_t number) {
  return line[strspn(line, " \t\r\n")] != '\0' && !(number == 1 && strncmp(line, "theta", 5) == 0);
}

static kz_status read_table(kz_starts *starts) {
  char *line = NULL;
  size_t bytes = 0;
  kz_status status = KZ_OK;
  for (int64_t number = 1; status == KZ_OK && getline(&line, &bytes, stdin) >= 0; number++) {
    if (!is_start(line, number)) continue;
    status = starts->n < MOST_STARTS ? read_row(line, number, starts)
                                     : kz_fail(KZ_REFUSED, "standard input:%lld: one start too many (at most %d)",
                                               (long long)number, MOST_STARTS);
  }
  free(line);
  if (status == KZ_OK && ferror(stdin)) return kz_fail(KZ_FAILED, "standard input cannot be read");
  if (status == KZ_OK && starts->n == 0)
    return kz_fail(KZ_REFUSED, "standard input: holds no start; write lines theta,velocity");
  return status;
}

static kz_status read_operands(const kz_options *options, kz_starts *starts) {
  static const char *const place[] = {"where", "where, the second start"};
  for (int i = 1; i < options->n_operands; i += 2) KZ_TRY(read_start(options->operands + i, place[i / 2], starts));
  return KZ_OK;
}

static kz_status read_starts(const kz_options *options, kz_starts *starts) {
  const int64_t digits = ((const kz_where_options *)options->own)->boundary;
  const char *const *operands = options->operands;
  if (digits > 0 && options->n_operands != 5)
    return kz_fail(KZ_REFUSED,
                   "--boundary: takes two starts; kapitza where SCENE THETA VELOCITY THETA VELOCITY --boundary DIGITS");
  if (options->n_operands == 2) {
    if (strcmp(operands[1], "-") != 0)
      return kz_fail(KZ_REFUSED,
                     "VELOCITY: is missing; kapitza where SCENE THETA VELOCITY, or - for starts on standard input");
    if (strcmp(options->scene, "-") == 0)
      return kz_fail(KZ_REFUSED, "-: the scene and the starts cannot both come from standard input; give a scene file");
    return read_table(starts);
  }
  if (digits == 0 && options->n_operands > 3)
    return kz_fail(KZ_REFUSED, "%.80s: one argument too many; two starts go with --boundary alone", operands[3]);
  return read_operands(options, starts);
}

kz_status kz_starts_read(const kz_options *options, double pivot_frequency, kz_starts *starts) {
  *starts = (kz_starts){.start = kz_malloc(MOST_STARTS * sizeof *starts->start), .pivot_frequency = pivot_frequency};
  return read_starts(options, starts);
}

void kz_starts_free(kz_starts *starts) {
  for (int64_t i = 0; i < 2 * starts->n; i++) free((char *)starts->start[i / 2][i % 2].centre);
  free(starts->start);
}
