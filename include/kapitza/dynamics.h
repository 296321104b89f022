/* dynamics: attractors of the stroboscopic map, the map table (ICM), trapping regions, labels, measures (Fortran; layer 1).
 *
 * Attractors are numbered from 1 in the order of their discovery; kz_dynamics_order gives the order of the file. States are
 * pairs (half-turns, velocity): theta/pi in [-1, 1], and rad per drive radian. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/kernel.h"

typedef struct kz_dynamics kz_dynamics;

/* A window of starts: rad, rad per drive radian. */
typedef struct {
  double theta_min, theta_max, velocity_min, velocity_max;
} kz_window;

/* The dynamics of a pendulum, without attractors yet. Several threads may follow, label and release starts at the same time, as long as none
 * changes the attractors or the regions. Searches look for cycles of up to max_period drive periods. Free with
 * kz_dynamics_free. */
kz_dynamics *kz_dynamics_create(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t max_period);
void kz_dynamics_free(kz_dynamics *dynamics);
/* Of a local variable (KZ_FREED_BY). */
static inline void kz_dynamics_freed(kz_dynamics **dynamics) {
  kz_dynamics_free(*dynamics);
}

/* n starts spread evenly over the window: state [n][2]. Another seed gives other starts. */
void kz_dynamics_starts(const kz_window *window, int64_t seed, int64_t n, double *state);

/* The largest velocity (rad per drive radian) within one period of starts in the window, and of starts as fast as a torque drives motions: a map
 * table must reach it. */
double kz_dynamics_max_velocity(kz_dynamics *dynamics, const kz_window *window);
/* The same of a pendulum by numerics. */
double kz_max_velocity(const kz_pendulum *pendulum, const kz_numerics *numerics, const kz_window *window);

/* Makes a coarse empty grid for trapping regions, up to the velocity `max_velocity` (rad per drive radian): enough for a search. */
void kz_dynamics_coarse_regions(kz_dynamics *dynamics, double max_velocity);
/* Replaces it by a grid of `cells` x `cells` (one more if odd) around the circle and along the velocity. Integrates its nodes through 8
 * periods and grows the regions around the known attractors. */
void kz_dynamics_fine_regions(kz_dynamics *dynamics, int64_t cells, double max_velocity);
/* Adds the ellipses and covers of new attractors to the regions; on a fine grid the regions then grow. */
void kz_dynamics_update(kz_dynamics *dynamics);

/* Ways to follow a start: by the scene's map, or by interpolation of the map table with 2 or 6 nodes an axis. SPARSE: by the scene's map, with a
 * look at the trapping regions every few periods only, so that `periods` may be larger by less than that. SINGLE: the same, with the processed
 * splitting in single precision, to some 1e-6 rad a period. */
enum { KZ_FOLLOW_DIRECT = 0, KZ_FOLLOW_SPARSE = 1, KZ_FOLLOW_SINGLE = 3, KZ_FOLLOW_LINEAR = 2, KZ_FOLLOW_QUINTIC = 6 };
/* Follows n starts, state [n][2], until a trapping region holds them, at most max_periods. label [n] = number of the attractor,
 * 0 = not settled. periods [n] = first period inside a trapping region, or max_periods. State [i] of a start that has not settled
 * becomes its last state, that of another one where it was left, in the map's own coordinates. turns [n] = net turns by which the
 * angle on the line is more than that of the state; NULL = not needed. */
void kz_dynamics_follow(kz_dynamics *dynamics, int32_t stepping, int64_t n, int64_t max_periods, double *state, int32_t *label,
                        int64_t *periods, int64_t *turns);

/* kz_dynamics_follow in quad precision, by Taylor series (kernel.h) with n_steps steps a period. A start is start [i] + low [i], in rad and
 * rad per drive radian; low [n][2] holds digits below the last places of start [n][2]; NULL = zeros. The sums count as exact. */
void kz_dynamics_follow_reference(kz_dynamics *dynamics, int32_t n_steps, int64_t n, int64_t max_periods, const double *start,
                                  const double *low, int32_t *label, int64_t *periods);

/* ---- labels with errors ---- */

/* Where an orbit begins. */
typedef struct {
  double theta[2], velocity[2]; /* rad, rad per drive radian: the sum of two doubles, high and low */
  int64_t periods;              /* drive periods before this start; the settling time includes them */
  double error[3]; /* ellipse of the start's own error: entries theta theta, theta velocity, velocity velocity of its matrix */
  double from;     /* rad: angle of the release, where periods > 0; else it is theta */
  int64_t turns;   /* net turns by which the angle on the line from there is more than theta */
} kz_start;

/* Precision levels at which orbits are followed with their errors, from the cheapest to the finest: the scene's numerics; doubles with
 * more steps (error of a period some 3e-15 rad); pairs of doubles (1e-16, 1e-20, 1e-24, 3e-29); quad precision, by Taylor series; and as
 * many digits as needed. */
enum {
  KZ_LEVEL_GUESS =
      -1, /* as KZ_LEVEL_DOUBLE, but a doubtful orbit is followed on and gets the label of its state without its error */
  KZ_LEVEL_DOUBLE = 0,
  KZ_LEVEL_FINE = 1,
  KZ_LEVEL_PAIRS_16 = 2,
  KZ_LEVEL_PAIRS_20 = 3,
  KZ_LEVEL_PAIRS_24 = 4,
  KZ_LEVEL_PAIRS_28 = 5,
  KZ_LEVEL_QUAD = 6,
  KZ_LEVEL_ARBITRARY = 7,
  KZ_LEVELS = 8
};
/* The label of an orbit whose error has become too large for a label. Any other label, also 0, is decided: the errors cannot change it. */
enum { KZ_DOUBTFUL = -1 };

/* Where a start ends, and how that is known: what studies keep of it. */
typedef struct {
  int64_t periods;  /* drive periods from the start until a trapping region holds the orbit, or for which it was followed */
  int16_t label;    /* number of an attractor, 0 = not settled, KZ_DOUBTFUL */
  int16_t other;    /* of a start that no level decides: the second candidate, 0 = none */
  uint8_t evidence; /* 0 = not labelled yet; else how it is known (study/labelling/levels.h), which dynamics does not say */
  uint8_t next;     /* of a doubtful orbit: the lowest level that may decide it, by the growth of its error */
  int32_t turns;    /* of kz_dynamics_count_turns */
} kz_label;

/* A label with the orbit behind it. */
typedef struct {
  kz_label end;
  int32_t level;   /* the level that decided; KZ_LEVELS = none */
  double error;    /* rad: bound of the orbit's error when it was trapped; meaningless for chaotic or undecided orbits */
  int64_t age;     /* drive periods after which the orbit was left */
  double state[2]; /* where it was then, as kz_dynamics_follow leaves states */
  int64_t turns;   /* net turns by which its angle on the line was then more than state[0] */
  double from;     /* rad: angle of its release */
} kz_decision;

/* Labels n starts at one level: decision [n]. `before` is the level at which they were doubtful. Each orbit carries its error. It uses the
 * precision of `level` until its error has reached what level `before` would add, then that of `before`, and so on downwards. A trapped
 * orbit is decided. The others get KZ_DOUBTFUL (at KZ_LEVEL_GUESS the label of the state without its error) and level KZ_LEVELS. */
void kz_dynamics_label(kz_dynamics *dynamics, int32_t level, int32_t before, int64_t n, const kz_start *start,
                       int64_t max_periods, kz_decision *decision);

/* Fills decision [n].end.turns: net turns from the angle of the release to the middle of the cycle (down or inverted, else its mean),
 * rounded. KZ_NO_TURNS of other ends, and if no ellipse of the cycle holds the orbit after max_periods more. */
enum { KZ_NO_TURNS = INT32_MIN };
void kz_dynamics_count_turns(kz_dynamics *dynamics, int64_t n, int64_t max_periods, kz_decision *decision);

/* Sets how starts are released. The errors of a release are measured at its first use, which must come after the trapping regions are made. */
void kz_dynamics_set_release(kz_dynamics *dynamics, const kz_release *release);
/* Moves those of n starts that have spent no periods, with their errors, from their release to the strobe from which on the drive has its
 * final form, in the precision of `level`. An orbit whose error exceeds 1e-4 rad gets a very large error, so that no level decides it. */
void kz_dynamics_release(kz_dynamics *dynamics, int32_t level, int64_t n, kz_start *start);

/* Looks for an unknown cycle near n <= 64 states that return to themselves within `closeness` rad, until it finds one or has tried all
 * states. found [kz_dynamics_cycle_size], in and out, 0 before the first call: found[0] = number of states tried so far; from found[1] on
 * the cycle and its mirror image, for kz_dynamics_adopt, or nothing. The catalogue does not change. */
void kz_dynamics_find_cycle(kz_dynamics *dynamics, int64_t n, const double *state, double closeness, double *found);
int64_t kz_dynamics_cycle_size(const kz_dynamics *dynamics);
/* Follows a bundle of orbits near one state. If neighbours separate in the first 2000 periods, it goes on for 60,000. found
 * [kz_dynamics_chaos_size]: a chaotic attractor, for kz_dynamics_adopt, if the orbits separate and no region traps them; else nothing. */
void kz_dynamics_find_chaos(kz_dynamics *dynamics, const double *state, double *found);
int64_t kz_dynamics_chaos_size(void);
/* Looks for a running state among n <= 64 states, whose orbits it follows through 8000 periods at most, if damping has had the time
 * to bring them to an attractor in `age` periods. found [kz_dynamics_chaos_size]: the motion, for kz_dynamics_adopt, or nothing. */
void kz_dynamics_find_running(kz_dynamics *dynamics, int64_t n, const double *state, int64_t age, double *found);
/* Adds the attractors in `found`, of one of the calls above, to the catalogue. */
void kz_dynamics_adopt(kz_dynamics *dynamics, const double *found);

/* The catalogue as doubles, flat [n], for messages between ranks; n = kz_dynamics_packed_size. */
int64_t kz_dynamics_packed_size(const kz_dynamics *dynamics);
void kz_dynamics_pack(const kz_dynamics *dynamics, int64_t n, double *flat);
void kz_dynamics_unpack(kz_dynamics *dynamics, int64_t n, const double *flat);

/* Makes an empty map table: n_theta nodes around the circle, n_velocity rows from -top to top, with `top` a little above `max_velocity`. */
void kz_dynamics_table_create(kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity, double max_velocity);
/* Number of doubles in a row. */
int64_t kz_dynamics_table_row_size(const kz_dynamics *dynamics);
/* Integrates row 0 .. n_velocity - 1 of the table: shift [row size]. */
void kz_dynamics_table_row(kz_dynamics *dynamics, int64_t row, double *shift);
/* Sets the table from all its rows, in order. */
void kz_dynamics_table_set(kz_dynamics *dynamics, const double *rows);
/* Share of the cells of the regions' grid that belong to a trapping region. */
double kz_dynamics_trapped_share(const kz_dynamics *dynamics);

/* A motion of one pendulum: an attractor, or a cycle on a branch, which need not attract. period: 0 = it never closes: chaotic, or with the winding 1
 * or -1, the sign of its mean velocity, a running state. Of cycles on branches mirror, mean values and exponents are not known. */
typedef struct {
  double theta, velocity; /* the first strobe point of a cycle, else the means: rad in [-pi, pi], rad per drive radian */
  int32_t period, winding, centre, symmetric, mirror; /* centre: 0 down, 1 inverted, 2 rotating, 3 none of these */
  double mean, mean_velocity;                         /* over time: rad in [-pi, pi], rad per drive radian */
  double amplitude;                                   /* rad from the centre, over continuous time; 0 for rotations */
  double multiplier_re[2], multiplier_im[2];          /* over the period: larger modulus first, + imaginary first */
  double lyapunov, lyapunov_error;                    /* largest exponent per drive period, and its standard error */
} kz_attractor;
static inline bool kz_is_running(const kz_attractor *attractor) {
  return attractor->period == 0 && attractor->winding != 0;
}

/* Finds the cycle near a state by Newton's method on the strobe map of `numerics`; n = a period after which it closes. The cycle need not
 * attract. cycle->period = its smallest period, or 0 if none lies within `max_distance` (rad). theta (rad) and velocity [n], in: the first is
 * the state; out: the cycle's strobe points, that near the state first. Of *cycle all is known but symmetry, mirror image and exponent. */
void kz_dynamics_close_cycle(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, double max_distance,
                             double *theta, double *velocity, kz_attractor *cycle);

int64_t kz_dynamics_count(const kz_dynamics *dynamics);
/* Attractor `number`, from 1 to the count. */
void kz_dynamics_attractor(const kz_dynamics *dynamics, int64_t number, kz_attractor *attractor);
/* 1 if averages along orbits alone show that it is an attractor, a running state round which no band was found that traps motions; else 0. */
int32_t kz_dynamics_is_averaged(const kz_dynamics *dynamics, int64_t number);
/* Its strobe points theta [period] in [-pi, pi) and velocity [period], from that with the lowest velocity on; a chaotic one has none. */
void kz_dynamics_strobe(const kz_dynamics *dynamics, int64_t number, double *theta, double *velocity);
/* number [count] = the numbers of the attractors in the order of the file. */
void kz_dynamics_order(const kz_dynamics *dynamics, int64_t *number);

/* ---- branches ---- */

/* One cycle of the stroboscopic map, attracting or not; kapitza/dynamics_curves.h follows it from one pendulum to another.
 *
 * Angles in rad from the DOWN position, velocities in rad per drive radian. The map is the one of published values (split6, 96
 * steps or more), whatever the scene's numerics. Nothing here is collective. */

/* The maps of n >= 1 pendulums, of which the oldest go: their tables cost more than a short cycle. One thread uses them. */
typedef struct kz_fine_maps kz_fine_maps;
kz_fine_maps *kz_fine_maps_create(int64_t n);
void kz_fine_maps_free(kz_fine_maps *maps);

/* Sets everything of a cycle from its period and symmetry, and n strobe points, state [n][2], equally far apart in the order of time (a part of its period, 64 at
 * most): the more there are, the faster it goes. maps: where maps are kept; NULL = each is made anew. */
void kz_branch_describe(kz_fine_maps *maps, const kz_pendulum *pendulum, int64_t n, const double *state, kz_attractor *point);

/* Whether a and b are the same cycle at the same parameters: one is among the strobe points of the other. maps: as above. */
int32_t kz_branch_same(kz_fine_maps *maps, const kz_pendulum *pendulum, const kz_attractor *a, const kz_attractor *b);

/* The centre of a motion (KZ_ABOUT_DOWN ...) from samples of its angle, theta [n] (rad, not wrapped), and whether it rotates: down or inverted where it stays within
 * pi of it and its mean within pi/4. *origin = the copy of this position, rad; 0 for other motions. */
int32_t kz_centre_of(int32_t rotates, int64_t n, const double *theta, double *origin);

/* ---- ends over a plane ---- */

/* Where a motion of one of many pendulums ends. */
typedef struct {
  int32_t period;        /* 0 = chaotic: not settled, and neighbours separate; -1 = not settled */
  int32_t winding;       /* net turns per period */
  int32_t centre;        /* 0 down, 1 inverted, 2 rotating, 3 none of these */
  int32_t settling_time; /* drive periods until the motion is within 1e-5 rad of its state one period of the cycle before */
  double exponent;       /* largest Lyapunov exponent per drive period: of the cycle, else of 1000 periods of the motion */
} kz_plane_ending;

/* Ends of the motions of n pendulums from one start (half-turns, velocity), with `steps` steps of split6 a period. A motion is followed
 * until it returns within 1e-5 rad after up to max_period periods; then Newton's method finds the cycle. Near a cycle that does not
 * attract, the motion is followed on; a start exactly on such a cycle does not settle. max_periods [n]: 0 = do not follow this one. */
void kz_ends_follow(int32_t steps, int64_t n, const kz_pendulum *pendulum, const double start[2], int32_t max_period,
                    const int64_t *max_periods, kz_plane_ending *endings);

/* ---- step error ---- */

/* Errors of one drive period, measured on a few thousand states before cells are labelled. Nothing here is collective. */

/* error [n] = upper estimate of the error of one drive period, in rad: error[c] for states of the whole circle with speeds from speed[c] to
 * speed[c + 1] (rad per drive radian; speed [n + 1] ascends). It is twice the largest difference that doubling the steps makes on 512
 * states; very large if a state diverges. */
void kz_step_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *speed, double *error);

/* The largest error of one period by the map table, with interpolation over `points` nodes an axis, in rad. Needs a complete table. */
double kz_dynamics_table_error(kz_dynamics *dynamics, int32_t points);
