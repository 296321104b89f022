/* Pairs of doubles: the operations against quad precision, a period against the reference, mirror images, lanes. */
#include "../../tools/reference.h"
#include "../../tools/test.h"

#include "../../tools/part.h"
#include "kapitza/kernel.h"
#include "vector/pairs_arithmetic.h"

#include <float.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* tests/unit/pairs.f90. Tables whose error of a period is at most `tolerance`, for speeds up to `fastest`; *error: the
 * measured one. */
void *kz_test_pairs_create(const kz_pendulum *pendulum, double tolerance, double fastest, double *error);
/* Steps of the table for slow states; 0 = there is none. */
int32_t kz_test_pairs_steps(const void *pairs);
void kz_test_pairs_free(void *pairs);
/* half_turns [n][2], velocity [n][2]: high and low; turns [n] gains the net number of turns. */
void kz_test_pairs_advance(const void *pairs, int64_t n, int64_t periods, double *half_turns, double *velocity,
                           int64_t *turns);
/* The largest error of rough Taylor series, beside which doubles are measured. */
double kz_test_rough_error(const kz_pendulum *pendulum, double fastest);

/* pair_products.c */
void kz_pair_product(int64_t rows, int64_t inner, int64_t columns, const double *left, const double *right,
                     double *product);
void kz_pair_bracket(int64_t n, int64_t top_f, int64_t top_g, int64_t top, const double *f, const double *f_slope,
                     const double *g, const double *g_slope, double *bracket);
void kz_pairs_split(int64_t n, const int64_t *x, double *high, double *low);
void kz_pairs_join(int64_t n, const double *high, const double *low, int64_t *x);

typedef __float128 quad;

static const kz_pendulum PENDULUM = {1.0 / 121, 1.0 / 55, 0.3};
static const double UNIT = 0x1p-104;
#define PI_QUAD 3.14159265358979323846264338327950288Q

/* Uniform in [-1, 1], 53 random bits. */
static double pairs_number(void) {
  static uint64_t state = 20240607;
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return (double)(int64_t)state * 0x1p-63;
}

static double pairs_size(quad x) {
  return fabs((double)x);
}

/* A random pair in lane 0, of sizes from 2^-8 to 2^8. */
static pair pairs_any(void) {
  const double high = ldexp(pairs_number(), rand() % 17 - 8);
  return (pair){broadcast_value(high), broadcast_value(high * 0x1p-53 * pairs_number())};
}

static quad pairs_value(pair x) {
  return (quad)x.high[0] + x.low[0];
}

static bool pairs_normal(pair x) {
  return x.high[0] + x.low[0] == x.high[0];
}

/* Each operation errs by a few units of 2^-104 of its operands at most, and gives pairs that do not overlap. */
TEST(operations_are_right_to_31_digits) {
  for (int i = 0; i < 200000; i++) {
    const pair x = pairs_any(), y = pairs_any(), z = pairs_any();
    const quad a = pairs_value(x), b = pairs_value(y), c = pairs_value(z);
    const double coefficients[2] = {z.high[0], z.low[0]};
    const pair exact = two_sum(x.high, y.high), total = add_pairs(x, y), product = multiply_pairs(x, y),
               step = horner_step(x, y, coefficients);
    assert_true((quad)exact.high[0] + exact.low[0] == (quad)x.high[0] + y.high[0]);
    assert_true(pairs_size(pairs_value(total) - (a + b)) <= 2 * UNIT * (pairs_size(a) + pairs_size(b)) &&
                pairs_normal(total));
    assert_true(pairs_size(pairs_value(subtract_pairs(x, y)) - (a - b)) <= 2 * UNIT * (pairs_size(a) + pairs_size(b)));
    assert_true(pairs_size(pairs_value(product) - a * b) <= 4 * UNIT * pairs_size(a * b) && pairs_normal(product));
    assert_true(pairs_size(pairs_value(step) - (a * b + c)) <= 4 * UNIT * (pairs_size(a * b) + pairs_size(c)));
    vector even;
    const pair rest = reduce_half_turns(x, &even);
    assert_true(fmod(even[0], 2) == 0 && fabs(rest.high[0]) <= 1);
    assert_true(pairs_size(pairs_value(rest) + even[0] - a) <= UNIT * pairs_size(a)); /* a quad has 113 binary digits */
  }
}

TEST(polynomials_end_in_doubles) {
  for (int i = 0; i < 20000; i++) {
    double c[8][2];
    for (int j = 0; j < 8; j++) c[j][0] = pairs_number(), c[j][1] = c[j][0] * 0x1p-54 * pairs_number();
    const pair x = {broadcast_value(pairs_number()), broadcast_value(0x1p-56 * pairs_number())};
    quad all = 0, tail = 0;
    for (int j = 7; j >= 0; j--) all = all * pairs_value(x) + ((quad)c[j][0] + (j < 5 ? c[j][1] : 0));
    for (int j = 7; j >= 5; j--) tail = tail * pairs_value(x) + c[j][0];
    const quad power = pairs_value(x) * pairs_value(x) * pairs_value(x) * pairs_value(x) * pairs_value(x);
    assert_true(pairs_size(pairs_value(evaluate_pairs(8, 5, c[0], x)) - all) <=
                64 * UNIT + 4 * DBL_EPSILON * pairs_size(power) * (1 + pairs_size(tail)));
  }
}

enum { N = 150 };

typedef struct {
  double half_turns[N][2], velocity[N][2];
  int64_t turns[N];
} states;

static void pairs_starts(double fastest, states *s) {
  for (int i = 0; i < N; i++) {
    s->half_turns[i][0] = pairs_number(), s->velocity[i][0] = fastest * pairs_number();
    s->half_turns[i][1] = 0x1p-56 * pairs_number(), s->velocity[i][1] = 0x1p-56 * pairs_number();
    s->turns[i] = 0;
  }
}

static void pairs_advance(const void *pairs, int64_t n, int64_t periods, states *s) {
  kz_test_pairs_advance(pairs, n, periods, s->half_turns[0], s->velocity[0], s->turns);
}

/* The largest error of three periods against the Taylor series. */
static double error_of(const void *pairs, const kz_pendulum *pendulum, double fastest) {
  static const double zero[N];
  states s;
  kz_reference_state reference[N];
  quad state[2];
  double largest = 0;
  pairs_starts(fastest, &s);
  kz_reference_start(N, zero, zero, NULL, reference);
  for (int i = 0; i < N; i++) {
    state[0] = PI_QUAD * ((quad)s.half_turns[i][0] + s.half_turns[i][1]),
    state[1] = (quad)s.velocity[i][0] + s.velocity[i][1];
    memcpy(reference[i].quads, state, sizeof state);
  }
  kz_reference_advance(pendulum, KZ_REFERENCE_STEPS, N, 3, reference);
  pairs_advance(pairs, N, 3, &s);
  for (int i = 0; i < N; i++) {
    memcpy(state, reference[i].quads, sizeof state);
    assert_int_equal(s.turns[i], reference[i].turns);
    const double d_theta = pairs_size(PI_QUAD * ((quad)s.half_turns[i][0] + s.half_turns[i][1]) - state[0]);
    const double d_velocity = pairs_size((quad)s.velocity[i][0] + s.velocity[i][1] - state[1]);
    largest = fmax(largest, hypot(d_theta, d_velocity));
  }
  return largest;
}

/* Errors of fresh states stay within the tolerance (times what three periods make of them), and more steps are better:
 * the error is that of the splitting, not of its arithmetic. Starts faster than the tables, and a pendulum without any,
 * too. */
TEST(periods_are_right) {
  static const struct {
    kz_pendulum pendulum;
    double tolerance, fastest;
  } cases[] = {{{1.0 / 121, 1.0 / 55, 0.3}, 1e-20, 6},
               {{1.0 / 121, 1.0 / 55, 0.3}, 1e-28, 2},
               {{-1, 0.1, 0.6}, 1e-24, 2},
               {{0.1, 3, 0.5}, 1e-20, 2},
               {{0.05, 0.1, 0.4, 0.1, 0.15, {{0, 0.05}, {0.2, -0.1}}, {{0.1, 0.07}}, 2, 1}, 1e-28, 2},
               {{.k = 0.05, .beta = 0.1, .m = 0.4, .vertical = {{0}, {0}, {-0.15, 0.1}}, .harmonics = 3}, 1e-24, 2}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i += PART > 1 ? 2 : 1) {
    double measured;
    void *pairs = kz_test_pairs_create(&cases[i].pendulum, cases[i].tolerance, cases[i].fastest, &measured);
    assert_non_null(pairs);
    assert_true(measured > 0 && measured <= cases[i].tolerance);
    const double error = error_of(pairs, &cases[i].pendulum, 1.5 * cases[i].fastest);
    assert_true(error <= 300 * measured);
    assert_true(error > 0.01 * measured || measured < 1e-29);
    kz_test_pairs_free(pairs);
  }
}

/* The image of the mirror image is the mirror image, to the bit; a state goes alone as in company, and rest stays. */
TEST(mirror_images_and_lanes) {
  double measured;
  void *pairs = kz_test_pairs_create(&PENDULUM, 1e-20, 3, &measured);
  states s, other, alone;
  pairs_starts(6, &s);
  s.half_turns[0][0] = 1, s.half_turns[0][1] = s.velocity[0][0] = s.velocity[0][1] = 0;
  memset(s.half_turns[1], 0, sizeof s.half_turns[1]), memset(s.velocity[1], 0, sizeof s.velocity[1]);
  other = s, alone = s;
  for (int i = 0; i < N; i++)
    for (int part = 0; part < 2; part++) {
      other.half_turns[i][part] = -s.half_turns[i][part];
      other.velocity[i][part] = -s.velocity[i][part];
    }
  pairs_advance(pairs, N, 6, &s);
  pairs_advance(pairs, N, 6, &other);
  for (int i = 0; i < N; i++) {
    for (int part = 0; part < 2; part++) {
      assert_true(s.half_turns[i][part] == -other.half_turns[i][part]);
      assert_true(s.velocity[i][part] == -other.velocity[i][part]);
    }
    assert_int_equal(s.turns[i], -other.turns[i]);
    assert_true(s.half_turns[i][0] + s.half_turns[i][1] == s.half_turns[i][0]);
  }
  kz_test_pairs_advance(pairs, 1, 6, alone.half_turns[77], alone.velocity[77], alone.turns + 77);
  assert_memory_equal(alone.half_turns[77], s.half_turns[77], sizeof *s.half_turns);
  assert_memory_equal(alone.velocity[77], s.velocity[77], sizeof *s.velocity);
  assert_true(s.half_turns[0][0] == 1 && s.velocity[0][0] == 0 && s.half_turns[1][0] == 0 && s.velocity[1][0] == 0);
  kz_test_pairs_free(pairs);
}

/* Images beside which doubles are measured are right to 1e-19 at gentle and at fast speeds, and strong drives; they are
 * no exact ones. */
TEST(rough_series) {
  const kz_pendulum cases[] = {PENDULUM, {0.1, 0.1, 1.5}, {1, 0.05, 20}};
  const double fastest[] = {2.5, 8, 40};
  for (int i = 0; i < 3; i++) {
    const double error = kz_test_rough_error(cases + i, fastest[i]);
    assert_true(error > 1e-30 && error < 1e-19 * (1 + fastest[i]));
  }
}

/* Tables serve a square wave of four harmonics at the finest error, too: with fewer grades in quad precision none
 * did. */
TEST(tables_of_a_square_wave) {
  kz_pendulum square = {1.0 / 121, 1.0 / 55, 0.3, .harmonics = 7};
  for (int j = 1; j <= 7; j += 2)
    square.vertical[j - 1][0] = 0.3 * (4 / (double)PI_QUAD / j * (j % 4 == 1 ? 1 : -1) - (j == 1));
  double error;
  void *pairs = kz_test_pairs_create(&square, 3e-29, 2.5, &error);
  assert_true(kz_test_pairs_steps(pairs) > 0 && kz_test_pairs_steps(pairs) <= 1200);
  assert_true(error <= 3e-29);
  kz_test_pairs_free(pairs);
}

enum { ROWS = 3, INNER = 60, COLUMNS = 16 };

/* Random pairs [n]: high parts, then low ones. */
static void pairs_fill(int64_t n, double *numbers) {
  for (int64_t i = 0; i < n; i++) {
    const pair x = pairs_any();
    numbers[i] = x.high[0], numbers[n + i] = x.low[0];
  }
}

/* Products of matrices err by some 2^-104 of the sum of the moduli of their terms, wherever a number stands; half of
 * the terms cancel. */
TEST(products_of_matrices_are_right_to_31_digits) {
  static double left[ROWS][2][INNER], right[INNER][2][COLUMNS], product[ROWS][2][COLUMNS];
  for (int i = 0; i < ROWS; i++) pairs_fill(INNER, left[i][0]);
  for (int k = 0; k < INNER; k++) pairs_fill(COLUMNS, right[k][0]);
  for (int k = INNER / 2; k < INNER; k++) { /* the first half with the other sign, but for a tiny part */
    for (int i = 0; i < ROWS; i++)
      for (int part = 0; part < 2; part++) left[i][part][k] = -left[i][part][k - INNER / 2];
    for (int j = 0; j < COLUMNS; j++) {
      right[k][0][j] = right[k - INNER / 2][0][j];
      right[k][1][j] = right[k - INNER / 2][1][j] * (1 + 0x1p-10 * pairs_number());
    }
  }
  kz_pair_product(ROWS, INNER, COLUMNS, left[0][0], right[0][0], product[0][0]);
  for (int i = 0; i < ROWS; i++)
    for (int j = 0; j < COLUMNS; j++) {
      quad exact = 0;
      double moduli = 0;
      for (int k = 0; k < INNER; k++) {
        const quad term = ((quad)left[i][0][k] + left[i][1][k]) * ((quad)right[k][0][j] + right[k][1][j]);
        exact += term;
        moduli += pairs_size(term);
      }
      assert_true(pairs_size((quad)product[i][0][j] + product[i][1][j] - exact) <= 4 * UNIT * moduli);
    }
}

/* Brackets f_v g_theta - f_theta g_v of polynomials of different degrees in v. */
TEST(brackets_are_right_to_31_digits) {
  enum { TOP_F = 2, TOP_G = 4, TOP = TOP_F + TOP_G - 1 };
  static double f[2][TOP_F + 1][2][COLUMNS], g[2][TOP_G + 1][2][COLUMNS], bracket[TOP + 1][2][COLUMNS];
  for (int slope = 0; slope < 2; slope++) {
    for (int a = 0; a <= TOP_F; a++) pairs_fill(COLUMNS, f[slope][a][0]);
    for (int b = 0; b <= TOP_G; b++) pairs_fill(COLUMNS, g[slope][b][0]);
  }
  kz_pair_bracket(COLUMNS, TOP_F, TOP_G, TOP, f[0][0][0], f[1][0][0], g[0][0][0], g[1][0][0], bracket[0][0]);
  for (int j = 0; j < COLUMNS; j++)
    for (int c = 0; c <= TOP; c++) {
      quad exact = 0;
      double moduli = 0;
      for (int a = 0; a <= TOP_F; a++) {
        const int b = c + 1 - a;
        if (b < 0 || b > TOP_G) continue;
        const quad x = a * ((quad)f[0][a][0][j] + f[0][a][1][j]) * ((quad)g[1][b][0][j] + g[1][b][1][j]),
                   y = b * ((quad)f[1][a][0][j] + f[1][a][1][j]) * ((quad)g[0][b][0][j] + g[0][b][1][j]);
        exact += x - y;
        moduli += pairs_size(x) + pairs_size(y);
      }
      assert_true(pairs_size((quad)bracket[c][0][j] + bracket[c][1][j] - exact) <= 4 * UNIT * moduli);
    }
}

static void pairs_split(quad x, double *high, double *low) {
  int64_t bits[2];
  memcpy(bits, &x, sizeof bits);
  kz_pairs_split(1, bits, high, low);
}

static quad pairs_joined(double high, double low) {
  int64_t bits[2];
  quad x;
  kz_pairs_join(1, &high, &low, bits);
  memcpy(&x, bits, sizeof x);
  return x;
}

/* Quads become pairs and pairs quads, of either sign and any size, powers of two and what is just below them too. */
TEST(quads_are_split_and_joined) {
  for (int i = 0; i < 200000; i++) {
    const double scale = ldexp(1, rand() % 1600 - 800), first = i % 3 ? pairs_number() : ldexp(1, i % 50);
    const quad x = scale * ((quad)first + first * 0x1p-53 * (quad)pairs_number() * (i % 5));
    double high, low, again[2];
    pairs_split(x, &high, &low);
    assert_true(high + low == high);
    assert_true(pairs_size((quad)high + low - x) <= 0x1p-105 * pairs_size(x));
    const quad back = pairs_joined(high, low);
    assert_true(pairs_size(back - ((quad)high + low)) <= 0x1p-111 * pairs_size(x));
    pairs_split(back, again, again + 1);
    assert_true(pairs_size(pairs_joined(again[0], again[1]) - back) <= 0x1p-105 * pairs_size(x));
  }
  double high, low;
  pairs_split(0, &high, &low);
  assert_true(high == 0 && low == 0 && pairs_joined(high, low) == 0);
  pairs_split(0x1p-1000Q, &high, &low);
  assert_true(high == 0);
  pairs_split(0x1p1100Q, &high, &low);
  assert_true(isinf(high) && isinf((double)pairs_joined(high, low)));
}
