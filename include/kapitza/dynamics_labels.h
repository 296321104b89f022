/* dynamics, labels: where starts end, at every precision level, with errors of their orbits (Fortran; layer 1). */
#pragma once

#include "kapitza/dynamics.h"

/* Ways to follow a start: by the scene's map, or by interpolation of the map table with 2 or 6 nodes an axis. SPARSE:
 * by the scene's map, with a look at the trapping regions every few periods only, so that `periods` may be larger by
 * less than that. SINGLE: the same, with the processed splitting in single precision, to some 1e-6 rad a period. */
typedef enum { KZ_FOLLOW_DIRECT, KZ_FOLLOW_SPARSE, KZ_FOLLOW_SINGLE, KZ_FOLLOW_LINEAR, KZ_FOLLOW_QUINTIC } kz_stepper;
/* Follows n starts, state [n][2], until a trapping region holds them, at most max_periods. label [n] = number of the
 * attractor, 0 = not settled. periods [n] = first period inside a trapping region, or max_periods. State [i] of a start
 * that has not settled becomes its last state, that of another one where it was left, in the map's own coordinates.
 * turns [n] = net turns by which the angle on the line is more than that of the state; NULL = not needed. */
void kz_dynamics_follow(kz_dynamics *dynamics, kz_stepper stepper, int64_t n, int64_t max_periods, double *state,
                        int32_t *frame_label, int64_t *periods, int64_t *turns);

/* Where an orbit begins. */
typedef struct {
  double theta[2], velocity[2]; /* rad, rad per drive radian: the sum of two doubles, high and low */
  int64_t periods;              /* drive periods before this start; the settling time includes them */
  double error[3]; /* covariance of the start's own error: theta theta, theta velocity, velocity velocity */
  double from;     /* rad: angle of the release, where periods > 0; else it is theta */
  int64_t turns;   /* net turns by which the angle on the line from there is more than theta */
} kz_start;

/* Precision levels at which orbits are followed with their errors, from the cheapest to the finest: the scene's
 * numerics; doubles with more steps (error of a period some 3e-15 rad); pairs of doubles (1e-16, 1e-20, 1e-24, 3e-29);
 * quad precision, by Taylor series. */
typedef enum {
  KZ_LEVEL_DOUBLE,
  KZ_LEVEL_FINE,
  KZ_LEVEL_PAIRS_16,
  KZ_LEVEL_PAIRS_20,
  KZ_LEVEL_PAIRS_24,
  KZ_LEVEL_PAIRS_28,
  KZ_LEVEL_QUAD
} kz_precision;
enum { KZ_LEVELS = KZ_LEVEL_QUAD + 1 };
/* Label of an orbit whose error is too large. Any other label, also 0, is decided: the errors cannot change it. */
enum { KZ_DOUBTFUL = -1 };

/* Where a start ends, and how that is known: what studies keep of it. */
typedef struct {
  int64_t periods;  /* drive periods until a trapping region holds the orbit, or for which it was followed */
  int16_t label;    /* number of an attractor, 0 = not settled, KZ_DOUBTFUL */
  int16_t other;    /* second candidate of a start that no level decides, 0 = none */
  uint8_t evidence; /* how the label is known (study/labelling/levels.h), 0 = not labelled; dynamics leaves it alone */
  uint8_t next;     /* lowest level that may decide a doubtful orbit, by its error growth; KZ_LEVELS = none of these */
  int16_t zero;     /* it and `zeros` are 0: tiles are squeezed, and bytes between members would be anything */
  int32_t turns;    /* net turns, see kz_dynamics_count_turns */
  int32_t zeros;
} kz_label;

/* A label with the orbit behind it. */
typedef struct {
  kz_label end;
  bool decided;    /* no error changes the label */
  double error;    /* bound of the orbit's error when trapped, rad; meaningless if chaotic or undecided */
  int64_t age;     /* drive periods after which the orbit was left */
  double state[2]; /* where it was then, as kz_dynamics_follow leaves states */
  int64_t turns;   /* net turns by which its angle on the line was then more than state[0] */
  double from;     /* rad: angle of its release */
} kz_decision;

/* In what precision orbits are followed with their errors. */
typedef struct {
  kz_precision level, before; /* level at which they begin; level at which they were doubtful */
  bool guess;           /* a doubtful orbit is followed on and labelled by its state without error, not KZ_DOUBTFUL */
  int32_t series_steps; /* above 0: quad precision throughout, by so many steps a period, as if it had no errors */
} kz_label_precision;
/* Labels n starts: decision [n]. Each orbit uses the precision of `level` until its error has reached what level
 * `before` would add, then that of `before`, and so on downwards. A trapped orbit is decided. */
void kz_dynamics_label(kz_dynamics *dynamics, const kz_label_precision *precision, int64_t n, const kz_start *start,
                       int64_t max_periods, kz_decision *decision);

/* Fills decision [n].end.turns: net turns from the angle of the release to the middle of the cycle (down or inverted,
 * else its mean), rounded. KZ_NO_TURNS of other ends, and if no ellipse of the cycle holds the orbit after max_periods
 * more. */
enum { KZ_NO_TURNS = INT32_MIN };
void kz_dynamics_count_turns(kz_dynamics *dynamics, int64_t n, int64_t max_periods, kz_decision *decision);

/* Moves those of n starts that have spent no periods, with their errors, to the strobe from which on the drive has its
 * final form, in the precision of `level`, where a power lets motions begin before it. An orbit whose error exceeds
 * 1e-4 rad gets a very large error, so that no level decides it. */
void kz_dynamics_begin(kz_dynamics *dynamics, kz_precision level, int64_t n, kz_start *start);
