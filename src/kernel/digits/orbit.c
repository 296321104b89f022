/* Orbits of any precision: memory of the series, steps halved until every series converges, whole periods. */
#include "step.h"

enum { FEWEST_STEPS = 14, HALVINGS = 10, SERIES = 11, COUNTS = 48 /* Characters of two integers */ };

struct kz_arbitrary {
  kz_pendulum pendulum;
  int64_t bits; /* Largest number of bits */
  kz_steps steps;
  kz_stretch stretch; /* Last stretch that it went through */
  kz_series series;
  kz_number *workspace; /* Memory of all series */
  kz_orbit_state state; /* State at the beginning of a period */
  kz_orbit_state mark;  /* State of an orbit on a line at the beginning of an earlier period */
  int64_t tangent_bits; /* Bits of the tangent that an orbit on a line keeps; 0 = jets hold it */
};

/* Number of orders of a step of the first length for a gentle motion; steps that need more are halved. */
static int64_t orders_for(int64_t bits) {
  return (int64_t)(0.62 * (double)bits) + 20;
}

static void each_of_state(kz_orbit_state *p, void (*action)(kz_number *)) {
  kz_number *const all[] = {&p->theta,    &p->velocity, &p->sine,    &p->cosine,
                            &p->angle[0], &p->angle[1], &p->rate[0], &p->rate[1]};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) action(all[i]);
}

static void each_number(kz_arbitrary *o, void (*action)(kz_number *)) {
  each_of_state(&o->state, action);
  each_of_state(&o->mark, action);
  action(&o->steps.h);
  for (int j = 0; j <= KZ_RAMP_POWER; j++) action(&o->steps.damping[j]);
  action(&o->stretch.begin);
  action(&o->stretch.span);
  action(&o->steps.gravity);
  action(&o->steps.torque);
}

static int64_t numbers_of(const kz_arbitrary *o) {
  return (SERIES + 1) * (o->series.orders + 2);
}

static void share_memory(kz_arbitrary *o) {
  kz_series *s = &o->series;
  kz_number **const all[SERIES + 1] = {&s->w,    &s->s,        &s->c,        &s->along,   &s->across,  &s->torque,
                                       &s->gain, &s->angle[0], &s->angle[1], &s->rate[0], &s->rate[1], &o->steps.scale};
  for (int i = 0; i <= SERIES; i++) *all[i] = o->workspace + i * (s->orders + 2);
}

static kz_arbitrary *allocate_orbit(const kz_pendulum *pendulum, int64_t bits) {
  kz_arbitrary *o = kz_calloc(1, sizeof *o);
  o->pendulum = *pendulum;
  o->steps.pendulum = &o->pendulum;
  o->steps.stretch = &o->stretch;
  o->bits = kz_larger(bits, KZ_FEWEST_BITS);
  o->series.orders = orders_for(o->bits);
  o->workspace = kz_numbers_make(numbers_of(o));
  share_memory(o);
  each_number(o, kz_number_init);
  return o;
}

kz_arbitrary *kz_arbitrary_create(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits) {
  kz_arbitrary *o = allocate_orbit(pendulum, bits);
  kz_number_of(&start[0], &o->state.theta, o->bits);
  kz_number_of(&start[1], &o->state.velocity, o->bits);
  return o;
}

void kz_arbitrary_release(kz_arbitrary *o, const kz_release *release) {
  o->stretch.release = *release;
}

void kz_arbitrary_free(kz_arbitrary *o) {
  if (!o) return;
  each_number(o, kz_number_clear);
  kz_numbers_free(o->workspace, numbers_of(o));
  free(o);
}

static void copy_state(const kz_orbit_state *from, kz_orbit_state *to) {
  to->strobe = from->strobe;
  to->turns = from->turns;
  kz_number_set(&to->theta, &from->theta);
  kz_number_set(&to->velocity, &from->velocity);
  for (int axis = 0; axis < 2; axis++) {
    kz_number_set(to->angle + axis, from->angle + axis);
    kz_number_set(to->rate + axis, from->rate + axis);
  }
}

/* Advances through one stretch in the present steps; false if a series does not converge. */
static bool advance_in_steps(kz_arbitrary *o, int64_t bits, int degree, kz_jet *jet) {
  kz_number_sin_cos(&o->state.theta, &o->state.sine, &o->state.cosine, bits + 8);
  for (int64_t i = 0; i < o->steps.n; i++) {
    int64_t tangent = 0;
    const int64_t orders = kz_series_expand(&o->series, &o->steps, i, &o->state, bits);
    if (orders == 0) return false;
    if (degree == 1 && !kz_tangent_advance(&o->series, &o->steps, orders, jet)) return false;
    if (degree > 1) {
      tangent = kz_series_expand_tangent(&o->series, &o->steps, &o->state);
      if (tangent == 0) return false;
      kz_higher_terms_advance(&o->series, &o->steps, tangent, o->state.columns, jet);
    }
    kz_series_sum(&o->series, &o->steps, orders, tangent, bits, &o->state);
  }
  return true;
}

static void wrap_angle(kz_arbitrary *o, int64_t bits) {
  const double turns = rint(kz_number_double(&o->state.theta) / (2 * M_PI));
  if (turns == 0) return;
  o->state.turns += (int64_t)turns;
  KZ_NUMBER(angle);
  KZ_NUMBER(factor);
  kz_number_two_pi(&angle, o->bits + 40);
  kz_number_of_double(turns, &factor);
  kz_number_multiply(&angle, &angle, &factor, o->bits + 40);
  kz_number_subtract(&o->state.theta, &o->state.theta, &angle, bits + 40);
}

/* Sets the tangent and its bits: those of jets, or those that the orbit keeps, at most its own. */
static void begin_tangent(kz_arbitrary *o, int64_t bits, const kz_jet *jet) {
  const int64_t kept = kz_smaller(o->tangent_bits, bits);
  o->state.tangent_bits = kz_larger(kept, KZ_TANGENT_BITS);
  o->state.columns = o->tangent_bits > 0 ? 1 : 2;
  if (o->tangent_bits > 0) return;
  for (int axis = 0; axis < 2; axis++) {
    kz_number_of_quad(jet ? jet->linear[0][axis] : 0, o->state.angle + axis);
    kz_number_of_quad(jet ? jet->linear[1][axis] : 0, o->state.rate + axis);
  }
}

static void get_tangent(const kz_orbit_state *state, kz_jet *jet) {
  for (int axis = 0; axis < 2; axis++) {
    jet->linear[0][axis] = kz_number_quad(state->angle + axis);
    jet->linear[1][axis] = kz_number_quad(state->rate + axis);
  }
}

/* Steps of a stretch, at the rate of FEWEST_STEPS per period. */
static int64_t fewest_steps(const kz_stretch *stretch) {
  return stretch->is_whole ? FEWEST_STEPS : 1 + (int64_t)(FEWEST_STEPS * kz_number_double(&stretch->span));
}

/* Advances through the present stretch, in steps that are halved until every series converges. */
static kz_status advance_stretch(kz_arbitrary *o, int64_t fine, int degree, kz_jet *jet) {
  kz_orbit_state before = {0};
  kz_jet higher_terms = {.higher_terms = {{0}}};
  bool done = false;
  copy_state(&o->state, &before);
  for (int64_t halvings = 0; !done && halvings <= HALVINGS; halvings++) {
    kz_steps_make(&o->steps, o->series.orders, o->bits + 32, fewest_steps(&o->stretch) << halvings);
    copy_state(&before, &o->state);
    if (degree > 0) higher_terms = *jet;
    done = advance_in_steps(o, fine, degree, &higher_terms);
  }
  each_of_state(&before, kz_number_clear);
  if (!done) return kz_fail(KZ_FAILED, "a motion is too fast for an orbit of %lld bits", (long long)fine);
  if (degree > 0) *jet = higher_terms;
  return KZ_OK;
}

kz_status kz_arbitrary_advance(kz_arbitrary *o, int64_t bits, int degree, kz_jet *jet) {
  const int64_t fine = kz_smaller(bits, o->bits), finest = o->bits + 32;
  const bool was_whole = o->stretch.is_whole;
  wrap_angle(o, o->bits);
  begin_tangent(o, fine, degree > 1 ? jet : NULL);
  kz_stretch_begin(&o->stretch, o->state.strobe, finest);
  if (!was_whole) o->steps.n = 0; /* The steps belong to another stretch */
  KZ_TRY(advance_stretch(o, fine, degree, jet));
  while (!o->stretch.is_whole && kz_stretch_next(&o->stretch, finest)) {
    o->steps.n = 0;
    KZ_TRY(advance_stretch(o, fine, degree, jet));
  }
  o->state.strobe++;
  wrap_angle(o, fine);
  if (degree > 1) get_tangent(&o->state, jet);
  return KZ_OK;
}

static void read_pair(const kz_number *x, double pair[2]) {
  KZ_NUMBER(rest);
  pair[0] = kz_number_double(x);
  kz_number_of_double(pair[0], &rest);
  kz_number_subtract(&rest, x, &rest, 64);
  pair[1] = kz_number_double(&rest);
}

void kz_arbitrary_read(const kz_arbitrary *o, double theta[2], double velocity[2]) {
  read_pair(&o->state.theta, theta);
  read_pair(&o->state.velocity, velocity);
}

int64_t kz_arbitrary_turns(const kz_arbitrary *o) {
  return o->state.turns;
}

size_t kz_arbitrary_size(const kz_arbitrary *o) {
  enum { REST = 128 }; /* exponents, signs, blanks */
  return 2 * ((size_t)(o->bits + 64) / 4 + REST + COUNTS);
}

void kz_arbitrary_write(const kz_arbitrary *o, char *text) {
  const size_t half = kz_arbitrary_size(o) / 2;
  memset(text, 0, 2 * half);
  kz_number_write(&o->state.theta, text, half);
  kz_number_write(&o->state.velocity, text + half, half - COUNTS);
  snprintf(text + 2 * half - COUNTS, COUNTS, "%lld %lld", (long long)o->state.strobe, (long long)o->state.turns);
}

kz_status kz_arbitrary_restore(kz_arbitrary *o, const char *text) {
  const size_t half = kz_arbitrary_size(o) / 2;
  if (!kz_number_read(text, &o->state.theta) || !kz_number_read(text + half, &o->state.velocity))
    return kz_fail(KZ_FAILED, "the state of an orbit that was kept cannot be read");
  char *second;
  o->state.strobe = strtoll(text + 2 * half - COUNTS, &second, 10);
  o->state.turns = strtoll(second, NULL, 10);
  return KZ_OK;
}

kz_arbitrary *kz_arbitrary_on_line(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits,
                                   int64_t tangent_bits, kz_jet *jet) {
  kz_arbitrary *o = kz_arbitrary_create(pendulum, start, bits);
  const kz_coordinate unit[2] = {{.centre = start[0].width}, {.centre = start[1].width}};
  o->tangent_bits = tangent_bits;
  kz_number_of(&unit[0], o->state.angle, tangent_bits);
  kz_number_of(&unit[1], o->state.rate, tangent_bits);
  *jet = (kz_jet){.higher_terms = {{0}}};
  get_tangent(&o->state, jet);
  kz_arbitrary_mark(o);
  return o;
}

void kz_arbitrary_mark(kz_arbitrary *o) {
  copy_state(&o->state, &o->mark);
}

/* Moves x along its polynomial to `share`; slope becomes the derivative there, in units of 2^exponent. */
static void move_along(kz_number *x, kz_number *slope, const long double *higher_terms, __float128 share, int exponent,
                       int64_t bits) {
  KZ_NUMBER(part);
  KZ_NUMBER(by);
  kz_number_of_quad(share, &by);
  kz_number_multiply(&part, slope, &by, bits);
  kz_number_add(x, x, &part, bits);
  kz_number_of_quad((higher_terms[0] + higher_terms[3] * share) * share * share, &part);
  kz_number_add(x, x, &part, bits);
  kz_number_of_quad((2 * higher_terms[0] + 3 * higher_terms[3] * share) * share, &part);
  kz_number_add(slope, slope, &part, bits);
  kz_number_of_double(ldexp(1, exponent), &by);
  kz_number_multiply(slope, slope, &by, bits);
}

kz_arbitrary *kz_arbitrary_beside(const kz_arbitrary *parent, const kz_jet *at_mark, __float128 share, int exponent,
                                  int64_t bits, int64_t tangent_bits, kz_jet *jet) {
  kz_arbitrary *o = allocate_orbit(&parent->pendulum, bits);
  kz_arbitrary_release(o, &parent->stretch.release);
  o->tangent_bits = tangent_bits;
  copy_state(&parent->mark, &o->state);
  move_along(&o->state.theta, o->state.angle, at_mark->higher_terms[0], share, exponent, o->bits);
  move_along(&o->state.velocity, o->state.rate, at_mark->higher_terms[1], share, exponent, o->bits);
  *jet = (kz_jet){.higher_terms = {{0}}};
  get_tangent(&o->state, jet);
  for (int axis = 0; axis < 2; axis++) {
    const long double third = at_mark->higher_terms[axis][3];
    jet->higher_terms[axis][0] = ldexpl(at_mark->higher_terms[axis][0] + 3 * third * (long double)share, 2 * exponent);
    jet->higher_terms[axis][3] = ldexpl(third, 3 * exponent);
  }
  kz_arbitrary_mark(o);
  return o;
}
