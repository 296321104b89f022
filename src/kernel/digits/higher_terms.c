/* The second and third degree of a neighbourhood over one step, in long doubles, whose exponents hold cubes of the
 * narrowest windows.
 *
 * With P1, P2, P3 the parts of a neighbour's angle by degree, g = along cos theta - across sin theta (series.c), and
 * w = along sin theta + across cos theta, the force, whose second derivative is -w:
 *   P2'' = -beta P2' - g P2 + w P1^2 / 2,   P3'' = -beta P3' - g P3 + w P1 P2 + g P1^3 / 6. */
#include "step.h"

typedef long double long_series[KZ_LONG_ORDERS];

static void read_series(const kz_number *from, int64_t last, int64_t n, long_series to) {
  for (int64_t j = 0; j < n; j++) to[j] = j <= last ? kz_number_long(from + j) : 0;
}

/* Adds factor a b to out. */
static void add_product(int64_t n, long double factor, const long_series a, const long_series b, long_series out) {
  for (int64_t i = 0; i < n; i++) {
    long double sum = 0;
    for (int64_t j = 0; j <= i; j++) sum += a[j] * b[i - j];
    out[i] += factor * sum;
  }
}

typedef long double ramp[KZ_RAMP_POWER + 1];

#define KZ_NEXT next_order
#define KZ_ARGUMENTS const ramp damping, const long_series gain, const long_series source, long_series x, long_series y
#define KZ_SUM(sum) long double sum = 0
#define KZ_DAMP(sum) \
  for (int64_t i = 0; i <= n && i <= KZ_RAMP_POWER; i++) sum += damping[i] * y[n - i]
#define KZ_PUSH(sum) sum -= source[n]
#define KZ_TERMS for (int64_t i = 0; i <= n; i++)
#define KZ_GAIN(sum) sum += gain[i] * x[n - i]
#define KZ_MOVE x[n + 1] = y[n] / (long double)(n + 1)
#define KZ_SET(sum) y[n + 1] = -sum / (long double)(n + 1)
#include "taylor/tangent.inc"

/* Solves x'' = -damping x' - gain x + source from x[0] and *rate; *rate becomes the rate at the end. */
static void solve_neighbour(int64_t n, const ramp damping, const long_series gain, const long_series source,
                            long_series x, long double *rate) {
  long_series y;
  y[0] = *rate;
  for (int64_t i = 0; i + 1 < n; i++) {
    next_order(damping, gain, source, x, y, i);
    *rate += y[i + 1];
  }
}

static long double sum_of(int64_t n, const long_series x) {
  long double sum = 0;
  for (int64_t i = n - 1; i >= 0; i--) sum += x[i];
  return sum;
}

/* The series from which the polynomials of a step are made. */
typedef struct {
  int64_t n;   /* Number of orders */
  int columns; /* 2, or 1 without y */
  long double h;
  ramp damping;
  long_series gain, force; /* g, w */
  long_series x[2];        /* P1 of x and of y */
  long_series square[3];   /* P1^2 / 2: xx, xy, yy */
  long_series second[3];   /* P2 */
} step_series;

/* Advances coefficient `place` of the jet; `path` takes its series unless NULL. */
static void move_coefficient(const step_series *p, const long_series source, kz_jet *jet, int state,
                             long double *coefficients) {
  long_series x;
  long double rate = jet->higher_terms[1][state] * p->h;
  x[0] = jet->higher_terms[0][state];
  solve_neighbour(p->n, p->damping, p->gain, source, x, &rate);
  jet->higher_terms[0][state] = sum_of(p->n, x);
  jet->higher_terms[1][state] = rate / p->h;
  if (coefficients) memcpy(coefficients, x, sizeof x);
}

static void move_second(step_series *p, kz_jet *jet) {
  static const int factor[3][2] = {{0, 0}, {0, 1}, {1, 1}};
  for (int i = 0; i < (p->columns > 1 ? 3 : 1); i++) {
    long_series source = {0};
    memset(p->square[i], 0, sizeof p->square[i]);
    add_product(p->n, i == 1 ? 1 : 0.5L, p->x[factor[i][0]], p->x[factor[i][1]], p->square[i]);
    add_product(p->n, 1, p->force, p->square[i], source);
    move_coefficient(p, source, jet, i, p->second[i]);
  }
}

/* Advances the third degree, whose source is P1 (w P2 + g (P1^2 / 2) / 3); coefficient i has i factors of y. */
static void move_third(const step_series *p, kz_jet *jet) {
  long_series pull[3] = {0};
  const int quadratic = p->columns > 1 ? 3 : 1, cubic = p->columns > 1 ? 4 : 1;
  for (int i = 0; i < quadratic; i++) {
    add_product(p->n, 1, p->force, p->second[i], pull[i]);
    add_product(p->n, 1.0L / 3, p->gain, p->square[i], pull[i]);
  }
  for (int i = 0; i < cubic; i++) {
    long_series source = {0};
    if (i < 3) add_product(p->n, 1, p->x[0], pull[i], source);
    if (i > 0) add_product(p->n, 1, p->x[1], pull[i - 1], source);
    move_coefficient(p, source, jet, 3 + i, NULL);
  }
}

/* Number of orders above the precision of long doubles. */
static int64_t orders_of(const kz_series *s, int64_t tangent_orders, int columns) {
  enum { BITS = 72, MORE = 8 };
  int64_t whole[2], n = tangent_orders;
  bool is_small = true;
  for (int axis = 0; axis < columns; axis++)
    whole[axis] = kz_larger(kz_number_exponent(s->angle[axis]), kz_number_exponent(s->rate[axis]));
  for (; n > 1 && is_small; n--) {
    is_small = kz_number_exponent(s->gain + n - 1) < -BITS;
    for (int axis = 0; axis < columns; axis++)
      is_small = is_small && kz_number_exponent(s->angle[axis] + n - 1) < whole[axis] - BITS;
  }
  return n + MORE < KZ_LONG_ORDERS ? n + MORE : KZ_LONG_ORDERS;
}

/* Adds along by[0] + sign across by[1] to out. */
static void add_force(const kz_series *series, const kz_steps *steps, int64_t orders, int64_t n, int sign,
                      const kz_number *const by[2], long_series out) {
  long_series force = {0}, factor = {0};
  read_series(series->along, steps->force_orders, n, force);
  read_series(by[0], orders, n, factor);
  add_product(n, 1, force, factor, out);
  if (!steps->pendulum->unmirrored) return;
  read_series(series->across, steps->force_orders, n, force);
  read_series(by[1], orders, n, factor);
  add_product(n, sign, force, factor, out);
}

/* Reads the unit of time and the damping. */
static void read_steps(const kz_steps *steps, step_series *p) {
  p->h = kz_number_long(&steps->h);
  for (int64_t j = 0; j <= steps->damping_orders; j++) p->damping[j] = kz_number_long(steps->damping + j);
}

void kz_higher_terms_advance(const kz_series *series, const kz_steps *steps, int64_t orders, int columns, kz_jet *jet) {
  step_series p = {.n = orders_of(series, orders, columns), .columns = columns};
  read_steps(steps, &p);
  read_series(series->gain, orders - 1, p.n, p.gain);
  add_force(series, steps, orders, p.n, 1, (const kz_number *[]){series->s, series->c}, p.force);
  for (int axis = 0; axis < columns; axis++) read_series(series->angle[axis], orders, p.n, p.x[axis]);
  move_second(&p, jet);
  move_third(&p, jet);
}

/* Last order of a series above the precision of long doubles. */
static int64_t last_order(const kz_number *series, int64_t last) {
  enum { BITS = 76 };
  while (last > 0 && kz_number_exponent(series + last) < -BITS) last--;
  return last;
}

bool kz_tangent_advance(const kz_series *series, const kz_steps *steps, int64_t orders, kz_jet *jet) {
  enum { FEWEST = 24, MORE = 8 };
  const int64_t n = kz_larger(FEWEST, kz_larger(last_order(series->c, orders), last_order(series->w, orders))) + MORE;
  step_series p = {.n = kz_smaller(n, KZ_LONG_ORDERS)};
  long_series none = {0}, x;
  read_steps(steps, &p);
  add_force(series, steps, orders, p.n, -1, (const kz_number *[]){series->c, series->s}, p.gain);
  for (int axis = 0; axis < 2; axis++) {
    long double rate = (long double)jet->linear[1][axis] * p.h;
    x[0] = (long double)jet->linear[0][axis];
    const long double size = fabsl(x[0]) + fabsl(rate);
    solve_neighbour(p.n, p.damping, p.gain, none, x, &rate);
    if (!(fabsl(x[p.n - 1]) + fabsl(x[p.n - 2]) <= 0x1p-60L * size)) return false;
    jet->linear[0][axis] = sum_of(p.n, x);
    jet->linear[1][axis] = rate / p.h;
  }
  return true;
}
