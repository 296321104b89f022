/* One start followed in as many digits as decide where it ends. */
#include "window.h"

/* Each further try has a third more bits: twice as many take five times as long, and are seldom needed. */
enum {
  FEWEST_BITS = 160,  /* Bits of the first try */
  BESIDE_WIDTH = 112, /* Bits beyond the size of the window that the start is in */
  MOST_BITS = 12288,
  TRY_EVERY = 8,  /* Periods between two looks whether doubles decide the rest */
  LOOK_EVERY = 64 /* Periods between two looks at whether orbits end anywhere */
};

const kz_level kz_own_orbit_level = {
    .word = "arbitrary", .stage = "arbitrary", .evidence = 8, .tile = 1, .in_pairs = true};

/* rad: the orbit is followed in many digits as long as its error is below that of a state in quad precision. */
static const double tolerable = 1e-31;

/* The error of an orbit as an ellipse, in units of the error of a period: it grows far beyond the range of doubles. */
typedef struct {
  long double xx, xy, yy;
} ellipse;

/* Carries the ellipse through a period with the tangent map, and adds that of the period's own error `own`, whatever
 * their directions: the sum holds both (the sum of the axes, not of their squares). */
static void own_orbit_carry(const kz_jet *tangent, long double own, ellipse *e) {
  const long double a = (long double)tangent->linear[0][0], b = (long double)tangent->linear[0][1],
                    c = (long double)tangent->linear[1][0], d = (long double)tangent->linear[1][1];
  const ellipse s = {a * a * e->xx + 2 * a * b * e->xy + b * b * e->yy,
                     a * c * e->xx + (a * d + b * c) * e->xy + b * d * e->yy,
                     c * c * e->xx + 2 * c * d * e->xy + d * d * e->yy};
  const long double ratio = sqrtl((s.xx + s.yy) / 2) / own, old = 1 + 1 / ratio, new = (1 + ratio) * own * own;
  *e = (ellipse){old * s.xx + new, old * s.xy, old * s.yy + new};
}

/* The orbit and what is known of it. */
typedef struct {
  kz_arbitrary *orbit;
  int64_t bits, periods, released; /* released: periods after which the drive has its final form */
  double from;                     /* angle of the release, rad */
  ellipse error;
} path;

static long double unit_of(const path *p) {
  return exp2l((long double)(4 - p->bits));
}

static bool is_lost(const path *p) {
  return !(unit_of(p) * sqrtl(p->error.xx + p->error.yy) < tolerable);
}

/* A period: in no more bits than the error so far leaves of use. */
static kz_status own_orbit_advance(path *p) {
  enum { FINER = 10 }; /* bits below the error */
  const int64_t spent = (int64_t)floorl(log2l(p->error.xx + p->error.yy) / 2) - FINER;
  const int64_t bits = p->bits - spent < KZ_FEWEST_BITS ? KZ_FEWEST_BITS : p->bits - spent;
  const int64_t taken = kz_smaller(bits, p->bits);
  kz_jet tangent = {.linear = {{1, 0}, {0, 1}}};
  KZ_TRY(kz_arbitrary_advance(p->orbit, taken, 1, &tangent));
  own_orbit_carry(&tangent, exp2l((long double)(p->bits - taken)), &p->error);
  return KZ_OK;
}

/* Where the orbit is, with its error. */
static kz_start start_of(const path *p) {
  const long double unit = unit_of(p) * unit_of(p);
  kz_start start = {.periods = p->periods,
                    .error = {(double)(unit * p->error.xx), (double)(unit * p->error.xy), (double)(unit * p->error.yy)},
                    .from = p->from,
                    .turns = kz_arbitrary_turns(p->orbit)};
  kz_arbitrary_read(p->orbit, start.theta, start.velocity);
  return start;
}

/* If doubles, without regard to errors, end nowhere known, more digits would not find an attractor that the catalogue
 * lacks. Until it is decided, or quad precision has as many digits as the orbit has left and goes on:
 * decision->end.label is KZ_DOUBTFUL if that does not decide it. */
static kz_status own_orbit_follow(path *p, kz_dynamics *dynamics, int64_t max_periods, kz_decision *decision) {
  decision->end.label = KZ_DOUBTFUL;
  for (; !is_lost(p); p->periods++) {
    if (p->periods >= p->released && (p->periods % TRY_EVERY == 0 || p->periods >= max_periods)) {
      const kz_start start = start_of(p);
      kz_decide_in_doubles(dynamics, &start, max_periods, p->periods % LOOK_EVERY == 0, decision);
      if (decision->end.label != KZ_DOUBTFUL || p->periods >= max_periods) return KZ_OK;
    }
    KZ_TRY(own_orbit_advance(p));
  }
  if (p->periods < p->released) return KZ_OK;
  const kz_start start = start_of(p);
  kz_decide_in_quads(dynamics, &start, max_periods, decision);
  return KZ_OK;
}

static int64_t first_bits(const kz_coordinate start[2]) {
  long double bits = FEWEST_BITS;
  for (int i = 0; i < 2; i++)
    if (start[i].width) bits = fmaxl(bits, BESIDE_WIDTH - log2l(strtold(start[i].width, NULL)));
  return (int64_t)bits;
}

kz_status kz_own_orbit_decide(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate start[2],
                              int64_t max_periods, kz_decision *decision) {
  kz_status status = KZ_OK;
  kz_release release;
  kz_dynamics_get_release(dynamics, &release);
  *decision = (kz_decision){.end.label = KZ_DOUBTFUL, .error = NAN};
  for (int64_t bits = first_bits(start); status == KZ_OK && decision->end.label == KZ_DOUBTFUL; bits += bits / 3) {
    path p = {.bits = kz_smaller(bits, MOST_BITS), .released = kz_release_strobes(&release), .error = {1, 0, 1}};
    p.orbit = kz_arbitrary_create(pendulum, start, p.bits);
    kz_arbitrary_release(p.orbit, &release);
    p.from = start_of(&p).theta[0];
    status = own_orbit_follow(&p, dynamics, max_periods, decision);
    kz_arbitrary_free(p.orbit);
    if (bits >= MOST_BITS) break;
  }
  return status;
}
