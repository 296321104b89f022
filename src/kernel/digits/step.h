/* One step of an orbit and of its neighbourhood by Taylor series (scaled: coefficients of (t / h)^n). */
#pragma once

#include "number.h"

/* Bits of the first degree of a jet; largest number of orders of its higher degrees, in long doubles. */
enum { KZ_TANGENT_BITS = 118, KZ_LONG_ORDERS = 120 };

/* Highest power of time in a ramp. */
enum { KZ_RAMP_POWER = 3 };

/* A whole period of the final drive, or part of an earlier one; times in drive periods from the strobe before. */
typedef struct {
  kz_release release;
  int64_t strobe;         /* Last strobe before it */
  bool is_whole, changes; /* changes: on the ramp */
  kz_number begin, span;  /* Beginning and length of a part */
} kz_stretch;

/* Steps of one length. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_stretch *stretch;
  int64_t n;                            /* Steps per stretch; 0 = none yet */
  kz_number h;                          /* rad */
  kz_number damping[KZ_RAMP_POWER + 1]; /* beta h in the present step, on a ramp a polynomial in its time */
  int64_t damping_orders;               /* Highest power of that polynomial */
  kz_number *scale;                     /* [orders] h^2 h^j / j! */
  kz_number gravity, torque;            /* k h^2, torque h^2 */
  int64_t force_orders;                 /* Last order of the drive's series */
} kz_steps;

/* Series of one step: [orders + 1] each. */
typedef struct {
  int64_t orders;                       /* Highest order that fits */
  kz_number *w, *s, *c;                 /* Orbit: h v, sin theta, cos theta */
  kz_number *along, *across, *torque;   /* h^2 a(t), -h^2 b(t), h^2 torque(t); mirrored pendulums have only the first */
  kz_number *gain, *angle[2], *rate[2]; /* Neighbours: along c - across s; derivatives of theta and of h v by x and y */
} kz_series;

/* The orbit at the beginning of a step, and at its end. */
typedef struct {
  kz_number theta, velocity, sine, cosine;
  kz_number angle[2], rate[2]; /* Derivatives of theta and v by x and y */
  int64_t tangent_bits;        /* Bits of these derivatives */
  int64_t strobe;              /* Drive periods since the strobe at or before the release */
  int64_t turns;               /* Net turns taken out of theta since the release */
  int columns;                 /* 2, or 1 for x alone */
} kz_orbit_state;

/* Sets the stretch from a strobe, or from the release if strobe = 0, to `bits` bits. */
void kz_stretch_begin(kz_stretch *stretch, int64_t strobe, int64_t bits);
/* Goes on to the next part of the same period; false at the next strobe. */
bool kz_stretch_next(kz_stretch *stretch, int64_t bits);

/* Bits that the next coefficient needs after coefficients below 2^size. */
int64_t kz_bits_needed(int64_t bits, int64_t size);
/* Adds coefficient n of a b to x, or subtracts it if `minus`; the drive's series end at force_orders. */
void kz_series_add_product(const kz_series *series, const kz_steps *steps, bool minus, const kz_number *a,
                           const kz_number *b, int64_t n, int64_t bits, kz_number *x);
/* x = coefficient n of damping times rate. */
void kz_series_damp(const kz_steps *steps, const kz_number *rate, int64_t n, int64_t bits, kz_number *x);
/* Makes steps of the n-th part of the stretch. */
void kz_steps_make(kz_steps *steps, int64_t orders, int64_t bits, int64_t n);
/* Expands the drive, and on a ramp the damping, in step i of the stretch. */
void kz_drive_expand(kz_series *series, kz_steps *steps, int64_t i, int64_t bits);
/* Expands the orbit in step i of the stretch, from `place`. Returns the last order, 0 if it does not converge. */
int64_t kz_series_expand(kz_series *series, kz_steps *steps, int64_t i, const kz_orbit_state *state, int64_t bits);
/* Expands the tangent, after the orbit. Returns the last order, 0 if it does not converge. */
int64_t kz_series_expand_tangent(kz_series *series, const kz_steps *steps, const kz_orbit_state *state);
/* Moves `place` to the end of the step, with its derivatives if tangent_orders > 0. */
void kz_series_sum(const kz_series *series, const kz_steps *steps, int64_t orders, int64_t tangent_orders, int64_t bits,
                   kz_orbit_state *state);

/* Advances the first degree alone in long doubles, with `orders` orders of the orbit; false if it diverges. */
bool kz_tangent_advance(const kz_series *series, const kz_steps *steps, int64_t orders, kz_jet *jet);
/* Advances the higher degrees of a neighbourhood through the step. */
void kz_higher_terms_advance(const kz_series *series, const kz_steps *steps, int64_t orders, int columns, kz_jet *jet);
