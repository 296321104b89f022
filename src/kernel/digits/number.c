/* Functions of numbers of any precision outside the inner loops. */
#include "number.h"

static const char degrees[] = " deg";

kz_number *kz_numbers_make(int64_t n) {
  kz_number *numbers = kz_malloc((size_t)n * sizeof *numbers);
  for (int64_t i = 0; numbers && i < n; i++) arb_init(numbers + i);
  return numbers;
}

void kz_numbers_free(kz_number *numbers, int64_t n) {
  for (int64_t i = 0; numbers && i < n; i++) arb_clear(numbers + i);
  free(numbers);
}

static void forget_radius(kz_number *x) {
  mag_zero(arb_radref(x));
}

void kz_number_two_pi(kz_number *x, int64_t bits) {
  arb_const_pi(x, bits);
  arb_mul_2exp_si(x, x, 1);
  forget_radius(x);
}

void kz_number_sin_cos(const kz_number *x, kz_number *sine, kz_number *cosine, int64_t bits) {
  arb_sin_cos(sine, cosine, x, bits);
  forget_radius(sine);
  forget_radius(cosine);
}

void kz_number_sin_cos_of_turns(int64_t i, int64_t n, kz_number *sine, kz_number *cosine, int64_t bits) {
  fmpq_t half_turns;
  fmpq_init(half_turns);
  fmpq_set_si(half_turns, 2 * i, (ulong)n);
  arb_sin_cos_pi_fmpq(sine, cosine, half_turns, bits);
  fmpq_clear(half_turns);
  forget_radius(sine);
  forget_radius(cosine);
}

/* Reads a decimal number, maybe with " deg" behind it. */
static void parse_number(const char *text, kz_number *x, int64_t bits) {
  const size_t length = strlen(text), tail = sizeof degrees - 1;
  const bool turned = length > tail && strcmp(text + length - tail, degrees) == 0;
  char *number = kz_strndup(text, turned ? length - tail : length);
  arb_set_str(x, number ? number : "nan", bits);
  forget_radius(x);
  free(number);
  if (!turned) return;
  KZ_NUMBER(factor);
  kz_number_two_pi(&factor, bits);
  kz_number_divide_by(&factor, &factor, 360, bits);
  kz_number_multiply(x, x, &factor, bits);
}

void kz_number_of_quad(__float128 value, kz_number *x) {
  int binary;
  __float128 rest = frexpf128(value, &binary);
  arf_t part;
  fmpz_t exponent;
  arf_init(part);
  fmpz_init_set_si(exponent, binary);
  arf_zero(arb_midref(x));
  for (int i = 0; i < 3; i++) {
    const double head = (double)rest;
    arf_set_d(part, head);
    arf_add(arb_midref(x), arb_midref(x), part, ARF_PREC_EXACT, ARF_RND_DOWN);
    rest -= head;
  }
  arf_mul_2exp_fmpz(arb_midref(x), arb_midref(x), exponent);
  arf_clear(part);
  fmpz_clear(exponent);
}

/* Splits x = (head [0] + head [1] + ...) 2^exponent into n heads, |sum| < 1; returns the exponent. */
static int64_t split_number(const kz_number *x, int n, double *head) {
  arf_t rest, part;
  fmpz_t exponent;
  arf_init(rest);
  arf_init(part);
  fmpz_init(exponent);
  arf_frexp(rest, exponent, arb_midref(x));
  for (int i = 0; i < n; i++) {
    head[i] = arf_get_d(rest, ARF_RND_DOWN);
    arf_set_d(part, head[i]);
    arf_sub(rest, rest, part, ARF_PREC_EXACT, ARF_RND_DOWN);
  }
  const int64_t binary = fmpz_get_si(exponent);
  arf_clear(rest);
  arf_clear(part);
  fmpz_clear(exponent);
  return binary;
}

/* Exponent below which a number is 0 in quads and long doubles. */
enum { MIN_EXPONENT = -16500 };

__float128 kz_number_quad(const kz_number *x) {
  double head[3];
  const int64_t exponent = split_number(x, 3, head);
  return exponent < MIN_EXPONENT ? 0 : ldexpf128(((__float128)head[2] + head[1]) + head[0], (int)exponent);
}

long double kz_number_long(const kz_number *x) {
  double head[2];
  const int64_t exponent = split_number(x, 2, head);
  return exponent < MIN_EXPONENT ? 0 : ldexpl((long double)head[1] + head[0], (int)exponent);
}

bool kz_number_write(const kz_number *x, char *text, size_t size) {
  char *whole = arb_dump_str(x);
  const bool fits = whole && strlen(whole) < size;
  if (fits) strcpy(text, whole);
  flint_free(whole);
  return fits;
}

bool kz_number_read(const char *text, kz_number *x) {
  return arb_load_str(x, text) == 0;
}

/* Prints x with `digits` significant digits. */
static bool print_number(const kz_number *x, int64_t digits, char *text, size_t size) {
  char *whole = arb_get_str(x, digits, ARB_STR_NO_RADIUS);
  const bool fits = whole && strlen(whole) < size;
  if (fits) strcpy(text, whole);
  flint_free(whole);
  return fits;
}

void kz_number_of(const kz_coordinate *coordinate, kz_number *x, int64_t bits) {
  const int64_t digits = bits + 64; /* centres and widths have up to 30 bits before the point */
  KZ_NUMBER(part);
  KZ_NUMBER(other);
  kz_number_of_double(coordinate->high, &part);
  kz_number_of_double(coordinate->low, &other);
  if (coordinate->centre)
    parse_number(coordinate->centre, x, digits);
  else
    kz_number_add(x, &part, &other, digits);
  if (coordinate->width && coordinate->share != 0) {
    parse_number(coordinate->width, &part, digits);
    kz_number_of_double(coordinate->share, &other);
    kz_number_multiply(&part, &part, &other, digits);
    kz_number_add(x, x, &part, digits);
  }
  kz_number_round(x, digits);
}

__float128 kz_coordinate_difference(const kz_coordinate *a, const kz_coordinate *b, int64_t bits) {
  KZ_NUMBER(x);
  KZ_NUMBER(y);
  kz_number_of(a, &x, bits);
  kz_number_of(b, &y, bits);
  kz_number_subtract(&x, &x, &y, bits + 64);
  return kz_number_quad(&x);
}

kz_status kz_coordinate_text(const kz_coordinate *coordinate, int64_t digits, char *text, size_t size) {
  const int64_t bits = (int64_t)((double)(digits + 1) / log10(2)) + 1;
  KZ_NUMBER(x);
  kz_number_of(coordinate, &x, bits);
  const int64_t power = kz_number_exponent(&x), before = power > 0 ? (int64_t)ceil((double)power * log10(2)) : 0;
  return print_number(&x, digits + before, text, size)
             ? KZ_OK
             : kz_fail(KZ_FAILED, "a number of %lld digits is too long", (long long)digits);
}
