/* One step of an orbit and of its neighbourhood by Taylor series (scaled: coefficients of (t / h)^n). */
#pragma once

#include "number.h"

/* Bits of the neighbourhood's first degree in a jet, and workspace for the series of its higher ones, which are long doubles. */
enum { KZ_TANGENT_BITS = 118, KZ_LONG_ORDERS = 120 };

/* Highest power of time in a ramp. */
enum { KZ_RAMP_POWER = 3 };

/* A whole drive period with the final drive, or a part of a period before the drive has it. Times are in drive periods from the strobe at or
 * before the release. */
typedef struct {
  kz_release release;
  int64_t strobe;         /* the last one before it */
  bool is_whole, changes; /* changes: it is on the ramp */
  kz_number begin, span;  /* of a part */
} kz_stretch;

/* Steps of one length. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_stretch *stretch;
  int64_t n;                            /* steps a stretch; 0 = none yet */
  kz_number h;                          /* rad */
  kz_number damping[KZ_RAMP_POWER + 1]; /* beta h, of the present step: as a polynomial in its time on a ramp */
  int64_t damping_orders;               /* the highest power in it */
  kz_number *scale;                     /* [orders] h^2 h^j / j! */
  kz_number gravity, torque;            /* k h^2, torque h^2 */
  int64_t force_orders;                 /* the drive's series ends there */
} kz_steps;

/* Series of one step: [orders + 1] each. */
typedef struct {
  int64_t orders;                     /* the most that fit */
  kz_number *w, *s, *c;               /* of the orbit: h v, sin theta, cos theta */
  kz_number *along, *across, *torque; /* h^2 a(t), -h^2 b(t), h^2 torque(t); the last two are not set for mirrored pendulums */
  kz_number *gain, *angle[2], *rate[2]; /* of its neighbours: along c - across s; change of theta, and of h v, with x and y */
} kz_series;

/* The orbit at the beginning of a step, and at its end. */
typedef struct {
  kz_number theta, velocity, sine, cosine;
  kz_number angle[2], rate[2]; /* derivatives of theta and v by x and y, */
  int64_t tangent_bits;        /* to so many bits */
  int64_t strobe;              /* drive periods since the strobe at or before the release */
  int64_t turns;               /* net turns that were taken out of theta since the release */
  int columns;                 /* 2, or 1: of x alone */
} kz_orbit_state;

/* The stretch from a strobe on, 0 = from the release, to so many bits. */
void kz_stretch_begin(kz_stretch *stretch, int64_t strobe, int64_t bits);
/* Goes on to the next part of the same period; false at the next strobe. */
bool kz_stretch_next(kz_stretch *stretch, int64_t bits);

static inline int64_t kz_larger(int64_t a, int64_t b) {
  return a > b ? a : b;
}

/* Bits that the next coefficient takes, where the last ones were below 2^size. */
int64_t kz_bits_needed(int64_t bits, int64_t size);
/* x gains coefficient n of a b, or loses it: of the drive's series only the orders that it has. */
void kz_series_add_product(const kz_series *series, const kz_steps *steps, bool minus, const kz_number *a, const kz_number *b,
                           int64_t n, int64_t bits, kz_number *x);
/* x = coefficient n of the damping times a rate. */
void kz_series_damp(const kz_steps *steps, const kz_number *rate, int64_t n, int64_t bits, kz_number *x);
/* Steps of the stretch's n-th part. */
void kz_steps_make(kz_steps *steps, int64_t orders, int64_t bits, int64_t n);
/* The drive's series in step i of the stretch, and the damping on a ramp. */
void kz_drive_expand(kz_series *series, kz_steps *steps, int64_t i, int64_t bits);
/* The series of step i of the stretch, from `place`. Returns its last order, 0 where it does not converge. */
int64_t kz_series_expand(kz_series *series, kz_steps *steps, int64_t i, const kz_orbit_state *state, int64_t bits);
/* The tangent's series, after those of the orbit; returns the last order, 0 where it does not converge. */
int64_t kz_series_expand_tangent(kz_series *series, const kz_steps *steps, const kz_orbit_state *state);
/* Moves `place` to the end of the step; with its derivatives where tangent_orders > 0. */
void kz_series_sum(const kz_series *series, const kz_steps *steps, int64_t orders, int64_t tangent_orders, int64_t bits,
                   kz_orbit_state *state);

/* Moves the first degree alone, in long doubles, with the series of an orbit to so many orders; false where it does not converge. */
bool kz_tangent_advance(const kz_series *series, const kz_steps *steps, int64_t orders, kz_jet *jet);
/* Moves the higher degrees of a neighbourhood through the step. */
void kz_higher_terms_advance(const kz_series *series, const kz_steps *steps, int64_t tangent_orders, int columns, kz_jet *jet);
