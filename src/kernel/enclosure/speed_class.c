/* The step of a class of speeds, and its bounds (B3) .. (B6) of docs/explanation/bounds.md: Taylor's remainder by
 * majorants, rounding of the tangent map by the recurrences on bounds of sizes (centre: rounding.c). */
#include "rounding.h"

static const real MAJORANT_MARGIN = 1e-9L; /* Relative margin far above the rounding of the bounds */

/* (B0) For complex time t + z, |z| <= R, the motion from a real state is compared with the solution of
 *   w' = beta w + a(r) cosh y, y' = w, y(0) = 0, w(0) = fastest
 * along the ray r = |z|: |theta'| <= w(r), |Im theta| <= y(r), since kz_force_majorant a(r) bounds the force and |sin
 * theta|, |cos theta| <= cosh y. Its neighbours obey this with a(r) cosh(y) times their distance. */

/* Implicit Euler step of the majorant, whose slopes grow, by fixed-point iteration and a check; false if it fails. */
static bool step_majorant(const kz_pendulum *p, real dr, majorant *current) {
  const real r = current->r + dr, torque = kz_force_majorant(p, r);
  majorant to = *current;
  to.r = r;
  bool holds = false;
  for (int i = 0; i < 60 && !holds && to.y < 25; i++) {
    const real w = current->w + dr * (p->beta * to.w + torque * coshl(to.y)), y = current->y + dr * to.w;
    if (w * (1 + MAJORANT_MARGIN / 8) <= to.w && y * (1 + MAJORANT_MARGIN / 8) <= to.y) {
      holds = true;
    } else {
      to.w = w * (1 + MAJORANT_MARGIN);
      to.y = (current->y + dr * to.w) * (1 + MAJORANT_MARGIN);
    }
  }
  if (!holds) return false;
  const real stiffness = torque * coshl(to.y), remainder = 1 - dr * p->beta - dr * dr * stiffness;
  if (!(remainder > 0.5L)) return false;
  for (int c = 0; c < 2; c++) { /* linear: slope = old + dr (beta slope + stiffness (a + dr slope)) */
    to.slope[c] = (current->slope[c] + dr * stiffness * current->a[c]) / remainder * (1 + MAJORANT_MARGIN);
    to.a[c] = (current->a[c] + dr * to.slope[c]) * (1 + MAJORANT_MARGIN);
  }
  *current = to;
  return true;
}

/* Lists the majorants of a motion of at most `fastest` at a real time, by ascending r; returns their number. */
static int find_majorants(const kz_pendulum *pendulum, double fastest, majorant *list) {
  const double scale = fmax(fmax(1, fastest), sqrt(kz_stiffness(pendulum)));
  majorant current = {.w = fastest, .a = {1, 0}, .slope = {0, 1}};
  int n = 0;
  while (n < MAJORANTS && step_majorant(pendulum, 6.0L / MAJORANTS / scale, &current)) list[n++] = current;
  return n;
}

enum { MOST_STEPS = 4096, ORDERS = KZ_ORDER_JACOBIAN, MOTION = -1 };

static void set_sizes(kz_step_bounds *b) {
  kz_force_sizes(b->pendulum, b->h, b->order, b->torque);
  for (int n = 0; n < b->order; n++) {
    b->torque[n] *= KZ_MARGIN;
    b->velocity[n] = b->sine[n] = HUGE_VALL;
  }
  for (int i = 0; i < b->n_majorants; i++) {
    const majorant *current = &b->majorant[i];
    const real ratio = b->h / current->r * KZ_MARGIN;
    real power = KZ_MARGIN;
    for (int n = 0; n < b->order; n++, power *= ratio) {
      b->velocity[n] = fminl(b->velocity[n], current->w * power);
      b->sine[n] = fminl(b->sine[n], coshl(current->y) * power);
    }
  }
}

/* (B0) Taylor's remainder after `order` terms of the velocity of the motion or of a column of the tangent map. */
static real taylor_remainder(const kz_step_bounds *b, int order, int column) {
  real remainder = HUGE_VALL;
  for (int i = 0; i < b->n_majorants; i++) {
    const majorant *current = &b->majorant[i];
    const real ratio = b->h / current->r * KZ_MARGIN;
    if (ratio < 0.99L)
      remainder =
          fminl(remainder, (column == MOTION ? current->w : current->slope[column]) * powl(ratio, order) / (1 - ratio));
  }
  return remainder;
}

/* (B3) Errors of a step of the centre: coefficients, rounding of their sums, Taylor's remainder. */
static void bound_centre(const kz_step_bounds *b, double fastest, kz_speed_class *speed) {
  real error[2] = {0};
  kz_add_rounding(b, fastest, error);
  const real remainder = taylor_remainder(b, b->order, MOTION);
  speed->velocity_error = (double)((error[1] + remainder) * KZ_MARGIN + KZ_TINY);
  speed->theta_error = (double)((error[0] + remainder * b->h / (b->order + 1)) * KZ_MARGIN + KZ_TINY);
}

/* Rounding in doubles of angle and velocity, at the end of the step, of a column that begins with a = 1 or v = 1. */
static void column_rounding(const kz_step_bounds *b, int T, const real stiffness[ORDERS],
                            const real stiffness_error[ORDERS], int c, real error[2]) {
  real a[ORDERS + 1] = {c == 0}, v[ORDERS + 1] = {c == 1}, a_error[ORDERS + 1] = {0}, v_error[ORDERS + 1] = {0};
  const real h = b->h * KZ_MARGIN, damping = h * b->pendulum->beta;
  error[0] = 4 * KZ_UNIT * h * v[0];
  error[1] = 0;
  for (int n = 0; n < T; n++) {
    const real summed = (n + 6) * KZ_UNIT * b->factor->higher;
    real size = damping * v[n], off = damping * (v_error[n] + summed * (v[n] + v_error[n]));
    for (int j = 0; j <= n; j++) {
      const real angle = a[n - j] + a_error[n - j];
      size += stiffness[j] * a[n - j];
      off += stiffness[j] * a_error[n - j] + stiffness_error[j] * angle +
             summed * (stiffness[j] + stiffness_error[j]) * angle;
    }
    a[n + 1] = v[n] * h / (n + 1);
    a_error[n + 1] = (v_error[n] + 4 * KZ_UNIT * (v[n] + v_error[n])) * h / (n + 1) + KZ_TINY;
    v[n + 1] = size / (n + 1);
    v_error[n + 1] = off / (n + 1) + KZ_TINY;
    error[0] += a_error[n + 1];
    if (n + 1 < T) error[1] += v_error[n + 1];
  }
  for (int n = 0; n <= T; n++) { /* T + 2 sums of at most these */
    error[0] += (T + 2) * KZ_UNIT * b->factor->higher * (a[n] + a_error[n]);
    if (n < T) error[1] += (T + 2) * KZ_UNIT * b->factor->higher * (v[n] + v_error[n]);
  }
}

/* (B4) Of the tangent map in doubles, to order T: rounding, and the rest of its polynomials. */
static void bound_tangent(const kz_step_bounds *b, int T, double tangent_error[2][2]) {
  real stiffness[ORDERS], stiffness_error[ORDERS];
  for (int n = 0; n < T; n++) {
    stiffness[n] = stiffness_error[n] = 0;
    for (int j = 0; j <= n; j++) {
      const real cosine = b->sine[n - j], off = b->sine_error[n - j] + KZ_UNIT * (cosine + b->sine_error[n - j]);
      stiffness[n] += b->torque[j] * cosine;
      stiffness_error[n] +=
          b->torque[j] * (off + (kz_products_of(b, n) + 2) * KZ_UNIT * b->factor->higher * (cosine + off));
    }
  }
  for (int c = 0; c < 2; c++) {
    real rounding[2];
    column_rounding(b, T, stiffness, stiffness_error, c, rounding);
    const real remainder = taylor_remainder(b, T, c);
    tangent_error[0][c] = (double)((rounding[0] + remainder * b->h / (T + 1)) * KZ_MARGIN);
    tangent_error[1][c] = (double)((rounding[1] + remainder) * KZ_MARGIN);
  }
}

/* (B5), (B6) Neighbours against y'' = beta y' + Q y, Q >= |a(t)|, whose solutions grow as exp(rate t) at most. */
static void bound_neighbours(const kz_step_bounds *b, kz_speed_class *speed) {
  const real stiffness = kz_stiffness(b->pendulum) * KZ_MARGIN, beta = b->pendulum->beta, h = b->h;
  const real rate = (beta + sqrtl(beta * beta + 4 * stiffness)) / 2, growth = expl(rate * h) * KZ_MARGIN;
  speed->neighbour_angle[0] = (double)((1 + stiffness * h * h / 2 * growth) * KZ_MARGIN);
  speed->neighbour_angle[1] = (double)(h * growth * KZ_MARGIN);
  speed->nonlinear[0] = (double)(h * h / 2 * growth * KZ_MARGIN);
  speed->nonlinear[1] = (double)(h * growth * KZ_MARGIN);
  speed->max_turn = (double)(stiffness * h * h / 2 * KZ_MARGIN);
  for (int j = 0; j < b->pendulum->harmonics; j++)
    speed->max_across += hypot(b->pendulum->horizontal[j][0], b->pendulum->horizontal[j][1]) * (double)KZ_MARGIN;
  for (int32_t i = 0; i < speed->n_steps; i++)
    speed->max_torque[i] = (double)(kz_force_largest(b->pendulum, i, h) + stiffness * 1e-6L);
}

/* Number of steps at which the last coefficient is small beside rounding; 0 if that takes too many. */
static int32_t choose_steps(const kz_step_bounds *b) {
  static const real targets[] = {1e-16L, 1e-31L, 1e-46L};
  const real target = targets[b->precision];
  real longest = 0;
  for (int i = 0; i < b->n_majorants; i++)
    longest = fmaxl(longest, b->majorant[i].r * powl(target / b->majorant[i].w, 1.0L / b->order));
  return longest * MOST_STEPS > 2 * M_PI ? (int32_t)(2 * M_PI / (double)longest) + 1 : 0;
}

/* Number of steps of a frame: it is renewed before damping aligns the columns of its matrix. */
static int32_t steps_of_frame(const kz_pendulum *pendulum, int32_t n_steps) {
  const double frames = fmin(ceil(2 * M_PI * pendulum->beta), n_steps);
  return frames > 1 ? (int32_t)(n_steps / frames) : n_steps;
}

static kz_speed_class *create_class(kz_step_bounds *b, double fastest, int32_t wanted) {
  b->n_majorants = find_majorants(b->pendulum, fastest, b->majorant);
  const int32_t n_steps = wanted > 0 ? wanted : choose_steps(b);
  if (n_steps == 0) return NULL;
  kz_speed_class *created = kz_calloc(1, sizeof *created + 3 * (size_t)(n_steps * b->order) * sizeof *created->along +
                                             (size_t)n_steps * sizeof *created->max_torque);
  created->across = created->along + n_steps * b->order;
  created->torque = created->across + n_steps * b->order;
  created->max_torque = (double *)(created->torque + n_steps * b->order);
  created->has_across = b->pendulum->unmirrored;
  created->n_steps = n_steps;
  created->order = b->order;
  created->fastest = fastest;
  created->frame_steps = steps_of_frame(b->pendulum, n_steps);
  kz_speed_class_set_constants(b->pendulum, created);
  b->h = 2 * (real)M_PI / n_steps * KZ_MARGIN;
  set_sizes(b);
  kz_set_errors(b, fastest);
  if (b->precision == KZ_ENCLOSE_TRIPLES && !b->fits) {
    free(created);
    return NULL;
  }
  bound_centre(b, fastest, created);
  bound_tangent(b, KZ_ORDER_TANGENT, created->tangent_error[false]);
  bound_tangent(b, KZ_ORDER_JACOBIAN, created->tangent_error[true]);
  bound_neighbours(b, created);
  return created;
}

kz_speed_class *kz_speed_class_create(const kz_pendulum *pendulum, int32_t precision, double fastest, int32_t n_steps) {
  kz_step_bounds *b = kz_calloc(1, sizeof *b);
  b->pendulum = pendulum;
  b->factor = &kz_rounding;
  b->precision = precision;
  b->fits = true;
  b->order = precision == KZ_ENCLOSE_DOUBLES ? KZ_ORDER_DOUBLES : KZ_ORDER_PAIRS;
  kz_speed_class *speed = create_class(b, fastest, n_steps);
  free(b);
  return speed;
}
