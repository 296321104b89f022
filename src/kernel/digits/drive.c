/* The series of the drive in any number of digits over the steps of a stretch, and the ramp of a release. */
#include "step.h"

/* Sets the span, up to the next strobe or the end of the ramp. */
static void set_end(kz_stretch *s, int64_t bits) {
  const double strobe = (double)s->strobe + 1, ramp = s->release.periods;
  s->changes = kz_number_is_less(&s->begin, ramp);
  kz_number_of_double(s->changes && ramp < strobe ? ramp : strobe, &s->span);
  kz_number_subtract(&s->span, &s->span, &s->begin, bits);
}

/* Sets the beginning at the release, in drive periods from the strobe at or before it. */
static void set_release(kz_stretch *s, int64_t bits) {
  KZ_NUMBER(turn);
  kz_number_two_pi(&turn, bits);
  kz_number_of_double(s->release.phase, &s->begin);
  kz_number_divide(&s->begin, &s->begin, &turn, bits);
  kz_number_floor(&turn, &s->begin);
  kz_number_subtract(&s->begin, &s->begin, &turn, bits);
}

void kz_stretch_begin(kz_stretch *s, int64_t strobe, int64_t bits) {
  s->strobe = strobe;
  s->is_whole = strobe >= kz_release_strobes(&s->release);
  s->changes = false;
  if (s->is_whole) return;
  if (strobe == 0)
    set_release(s, bits);
  else
    kz_number_of_double((double)strobe, &s->begin);
  set_end(s, bits);
}

bool kz_stretch_next(kz_stretch *s, int64_t bits) {
  if (!s->changes || s->release.periods >= (double)s->strobe + 1) return false;
  kz_number_of_double(s->release.periods, &s->begin);
  set_end(s, bits);
  return true;
}

static int64_t highest_harmonic(const kz_pendulum *pendulum) {
  return pendulum->harmonics > 1 ? pendulum->harmonics : 1;
}

/* x = a h^2. */
static void times_square(double a, const kz_number *h, int64_t bits, kz_number *x) {
  kz_number_of_double(a, x);
  kz_number_multiply(x, x, h, bits);
  kz_number_multiply(x, x, h, bits);
}

/* An upper bound of the force. */
static double largest_force(const kz_steps *steps) {
  const double all = kz_stiffness(steps->pendulum), drive = fabs(steps->stretch->release.drive);
  return steps->stretch->changes && drive > 1 ? drive * all : all;
}

static void set_scale(kz_steps *steps, int64_t orders, int64_t bits) {
  int64_t more = steps->damping_orders; /* powers by which a ramp multiplies the drive's series */
  KZ_NUMBER(size);
  times_square(1, &steps->h, bits, steps->scale);
  kz_number_of_double(largest_force(steps), &size);
  steps->force_orders = 0;
  for (int64_t j = 0; j < orders; j++) {
    if (kz_number_exponent(steps->scale + j) + kz_number_exponent(&size) <= -bits && more-- <= 0) break;
    kz_number_multiply(steps->scale + j + 1, steps->scale + j, &steps->h, bits);
    kz_number_divide_by(steps->scale + j + 1, steps->scale + j + 1, j + 1, bits);
    kz_number_multiply_by(&size, highest_harmonic(steps->pendulum), 64);
    steps->force_orders = j + 1;
  }
}

void kz_steps_make(kz_steps *steps, int64_t orders, int64_t bits, int64_t n) {
  if (steps->n == n) return;
  KZ_NUMBER(beta);
  steps->n = n;
  kz_number_two_pi(&steps->h, bits);
  if (!steps->stretch->is_whole) kz_number_multiply(&steps->h, &steps->h, &steps->stretch->span, bits);
  kz_number_divide_by(&steps->h, &steps->h, n, bits);
  kz_number_of_double(steps->pendulum->beta, &beta);
  kz_number_multiply(steps->damping, &steps->h, &beta, bits);
  steps->damping_orders = steps->stretch->changes ? KZ_RAMP_POWER : 0;
  times_square(steps->pendulum->k, &steps->h, bits, &steps->gravity);
  times_square(steps->pendulum->torque, &steps->h, bits, &steps->torque);
  set_scale(steps, orders, bits);
}

/* Time of the beginning of step i in drive periods. */
static void time_of(const kz_steps *steps, int64_t i, int64_t bits, kz_number *turn) {
  kz_number_set(turn, &steps->stretch->span);
  kz_number_multiply_by(turn, i, bits);
  kz_number_divide_by(turn, turn, steps->n, bits);
  kz_number_add(turn, turn, &steps->stretch->begin, bits);
}

/* Sine and cosine of harmonic j at the beginning of step i. */
static void sin_cos_at(const kz_steps *steps, int64_t i, int64_t j, int64_t bits, kz_number *sine, kz_number *cosine) {
  if (steps->stretch->is_whole) {
    kz_number_sin_cos_of_turns(i * j, steps->n, sine, cosine, bits);
    return;
  }
  KZ_NUMBER(angle);
  KZ_NUMBER(turn);
  time_of(steps, i, bits, &turn);
  kz_number_multiply_by(&turn, j, bits);
  kz_number_two_pi(&angle, bits);
  kz_number_multiply(&angle, &angle, &turn, bits);
  kz_number_sin_cos(&angle, sine, cosine, bits);
}

/* Adds h^2 (C cos j t + S sin j t), {C, S} the sum of both parts, to a series; clock = {cos j t, sin j t} at the time
 * about which it is expanded. */
static void add_harmonic(const kz_steps *steps, int64_t j, const double part[2][2], const kz_number *const clock[2],
                         int64_t bits, kz_number *series) {
  KZ_NUMBER(even);
  KZ_NUMBER(odd);
  KZ_NUMBER(product);
  KZ_NUMBER(amplitude);
  kz_number *const derivative[2] = {&even, &odd};
  for (int i = 0; i < 2; i++) {
    kz_number_of_double(part[i][0], &amplitude);
    kz_number_multiply(&product, &amplitude, clock[0], bits);
    kz_number_add(&even, &even, &product, bits);
    kz_number_multiply(&product, &amplitude, clock[1], bits);
    kz_number_subtract(&odd, &odd, &product, bits);
    kz_number_of_double(part[i][1], &amplitude);
    kz_number_multiply(&product, &amplitude, clock[1], bits);
    kz_number_add(&even, &even, &product, bits);
    kz_number_multiply(&product, &amplitude, clock[0], bits);
    kz_number_add(&odd, &odd, &product, bits);
  }
  kz_number_multiply_by(&odd, j, bits);
  for (int64_t n = 0; n <= steps->force_orders; n++) {
    kz_number *current = derivative[n % 2];
    kz_number_multiply(&product, steps->scale + n, current, bits);
    kz_number_add(series + n, series + n, &product, bits);
    kz_number_multiply_by(current, -j * j, bits);
  }
}

/* Remaining share of a ramp, 1 .. 0, by powers of the time x of step i: q = r + u x, or 3 q^2 - 2 q^3 if smooth. */
static void ramp_left(const kz_steps *steps, int64_t i, int64_t bits, kz_number *left) {
  const kz_release *release = &steps->stretch->release;
  KZ_NUMBER(s); /* 1 - r */
  KZ_NUMBER(part);
  kz_number *const r = left, *const u = left + 1;
  kz_number_of_double(release->periods, &part);
  kz_number_divide(u, &steps->stretch->span, &part, bits);
  kz_number_divide_by(u, u, -steps->n, bits);
  time_of(steps, i, bits, &s);
  kz_number_divide(&s, &s, &part, bits);
  kz_number_of_double(1, r);
  kz_number_subtract(r, r, &s, bits);
  if (!release->smooth) return;
  kz_number_multiply(left + 2, u, u, bits);
  kz_number_multiply(left + 3, left + 2, u, bits);
  kz_number_multiply_by(left + 3, -2, bits);
  kz_number_subtract(&part, &s, r, bits);
  kz_number_multiply(left + 2, left + 2, &part, bits);
  kz_number_multiply_by(left + 2, 3, bits);
  kz_number_multiply(u, u, r, bits);
  kz_number_multiply(u, u, &s, bits);
  kz_number_multiply_by(u, 6, bits);
  kz_number_of_double(3, &part);
  kz_number_subtract(&part, &part, r, bits);
  kz_number_subtract(&part, &part, r, bits);
  kz_number_multiply(r, r, r, bits);
  kz_number_multiply(r, r, &part, bits);
}

/* series = final + (first - final) left. */
static void interpolate_ramp(double first, double final, const kz_number *left, int64_t bits, kz_number *series) {
  KZ_NUMBER(last);
  KZ_NUMBER(change);
  kz_number_of_double(final, &last);
  kz_number_of_double(first, &change);
  kz_number_subtract(&change, &change, &last, bits);
  for (int j = 0; j <= KZ_RAMP_POWER; j++) kz_number_multiply(series + j, &change, left + j, bits);
  kz_number_add(series, series, &last, bits);
}

/* Multiplies a series by a polynomial. */
static void multiply_series(const kz_steps *steps, const kz_number *polynomial, int64_t bits, kz_number *series) {
  KZ_NUMBER(sum);
  for (int64_t n = steps->force_orders; n >= 0; n--) {
    kz_number_dot(&sum, NULL, false, polynomial, series + n, (n < KZ_RAMP_POWER ? n : KZ_RAMP_POWER) + 1, bits);
    kz_number_set(series + n, &sum);
  }
}

/* Applies the ramp to damping and drive in step i; `along` is without gravity. */
static void put_on_ramp(kz_series *series, kz_steps *steps, int64_t i, int64_t bits) {
  const kz_release *release = &steps->stretch->release;
  kz_number *const all = kz_numbers_make(2 * (KZ_RAMP_POWER + 1)), *const left = all,
                   *const strength = all + KZ_RAMP_POWER + 1;
  ramp_left(steps, i, bits, left);
  interpolate_ramp(release->damping, steps->pendulum->beta, left, bits, steps->damping);
  for (int j = 0; j <= KZ_RAMP_POWER; j++) kz_number_multiply(steps->damping + j, steps->damping + j, &steps->h, bits);
  interpolate_ramp(release->drive, 1, left, bits, strength);
  multiply_series(steps, strength, bits, series->along);
  if (steps->pendulum->unmirrored) multiply_series(steps, strength, bits, series->across);
  kz_numbers_free(all, 2 * (KZ_RAMP_POWER + 1));
}

void kz_drive_expand(kz_series *series, kz_steps *steps, int64_t i, int64_t bits) {
  const kz_pendulum *p = steps->pendulum;
  KZ_NUMBER(cosine);
  KZ_NUMBER(sine);
  const kz_number *const clock[2] = {&cosine, &sine};
  for (int64_t n = 0; n <= steps->force_orders; n++) {
    kz_number_of_double(0, series->along + n);
    kz_number_of_double(0, series->across + n);
    kz_number_of_double(0, series->torque + n);
  }
  for (int64_t j = 1; j <= highest_harmonic(p); j++) {
    const double *up = p->vertical[j - 1], *right = p->horizontal[j - 1];
    const double sine_of_m = j == 1 ? -p->m : 0;
    sin_cos_at(steps, i, j, bits, &sine, &cosine);
    add_harmonic(steps, j, (double[][2]){{sine_of_m, 0}, {-up[0], -up[1]}}, clock, bits, series->along);
    if (!p->unmirrored) continue;
    add_harmonic(steps, j, (double[][2]){{-right[0], -right[1]}, {0, 0}}, clock, bits, series->across);
    if (j > 1) continue;
    add_harmonic(steps, j, (double[][2]){{p->torque_amplitude, 0}, {0, 0}}, clock, bits, series->torque);
  }
  if (steps->stretch->changes) put_on_ramp(series, steps, i, bits);
  kz_number_add(series->along, series->along, &steps->gravity, bits);
  kz_number_add(series->torque, series->torque, &steps->torque, bits);
}
