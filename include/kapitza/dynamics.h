/* dynamics: attractors of the stroboscopic map, the map table (ICM), trapping regions, labels, measures (Fortran; layer 1).
 *
 * Attractors are numbered from 1 in the order of their discovery; kz_dynamics_order gives the order of the file. States are
 * pairs (half-turns, velocity): theta/pi in [-1, 1], and rad per drive radian. */
#ifndef KAPITZA_DYNAMICS_H
#define KAPITZA_DYNAMICS_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/kernel.h"

typedef struct kz_dynamics kz_dynamics;

/* A window of starts: rad, rad per drive radian. */
typedef struct {
  double theta_min, theta_max, velocity_min, velocity_max;
} kz_window;

/* Free with kz_dynamics_free. Cycles up to max_period are looked for. */
kz_dynamics *kz_dynamics_create(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t max_period);
void kz_dynamics_free(kz_dynamics *dynamics);

/* The same for a pendulum nearby, to be freed too: its attractors are those of `dynamics` that continue, by Newton's method, and its trapping regions
 * what is left of theirs without their outermost cells. So they are only likely to trap: for moving pictures, until
 * kz_dynamics_fine_regions. *lost: attractors that do not continue, mirror images not counted. */
kz_dynamics *kz_dynamics_continue(const kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_numerics *numerics,
                                  int64_t *lost);

/* Starts spread evenly over the window: state [n][2]. The seed moves them. */
void kz_dynamics_starts(const kz_window *window, int64_t seed, int64_t n, double *state);

/* The velocity that a map table of this window must reach: the largest within one period of its starts. */
double kz_dynamics_max_velocity(kz_dynamics *dynamics, const kz_window *window);

/* A coarse open grid for trapping regions up to velocity `max_velocity`: enough for a search. */
void kz_dynamics_coarse_regions(kz_dynamics *dynamics, double max_velocity);
/* In its place a grid of `cells` along the velocity and around the circle (one more where odd), in which the regions are grown
 * outwards around the attractors known so far: its nodes are integrated through 8 periods. */
void kz_dynamics_fine_regions(kz_dynamics *dynamics, int64_t cells, double max_velocity);
/* Draws the ellipses and covers of new attractors into the regions, and lets a fine grid's grow. */
void kz_dynamics_update(kz_dynamics *dynamics);

/* Ways to follow a start: the scene's map, or interpolated cell mapping over 2 or 6 nodes an axis of the map table. */
enum { KZ_FOLLOW_DIRECT = 0, KZ_FOLLOW_LINEAR = 2, KZ_FOLLOW_QUINTIC = 6 };
/* Follows n starts state [n][2] until each is trapped: label [n] = attractor, 0 where it has not settled; periods [n] = first
 * period inside a trapping region, max_periods where none. The states of those that have not settled become where they are then. */
void kz_dynamics_follow(kz_dynamics *dynamics, int32_t stepping, int64_t n, int64_t max_periods, double *state, int32_t *label,
                        int64_t *periods);

/* kz_dynamics_follow in quad precision, by Taylor series (kernel.h) of n_steps steps a period, from start [n][2] in rad and
 * rad per drive radian; low [n][2]: what is to be added to them, below their last places; NULL = nothing. The sums are taken as exact. */
void kz_dynamics_follow_reference(kz_dynamics *dynamics, int32_t n_steps, int64_t n, int64_t max_periods, const double *start,
                                  const double *low, int32_t *label, int64_t *periods);

/* ---- labels with errors ---- */

/* Where an orbit begins. */
typedef struct {
  double theta[2], velocity[2]; /* rad, rad per drive radian: a double, and what is to be added to it below its last place */
  int64_t periods;              /* drive periods that were spent before: its settling time counts them */
  double error
      [3]; /* covariance of an error of its own: theta theta, theta velocity, velocity velocity; the largest, not the mean */
} kz_start;

/* Precision levels at which orbits are followed with their errors, from the cheapest to the finest: the scene's numerics; doubles with
 * more steps, an error of some 3e-15 a period; pairs of doubles, 1e-16, 1e-20, 1e-24 and 3e-29; quad precision, by Taylor series. Beyond them:
 * as many digits as it takes. */
enum {
  KZ_LEVEL_GUESS = -1, /* KZ_LEVEL_DOUBLE, but doubtful orbits are followed on: their labels are those of the states alone */
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
/* The label of an orbit whose error outgrows what a label bears. Any other label, 0 too, is decided: the errors do not change it. */
enum { KZ_DOUBTFUL = -1 };

typedef struct {
  int32_t label;   /* number of an attractor, 0 = not settled, KZ_DOUBTFUL */
  int32_t other;   /* second candidate of a label that no level decides; 0 = none */
  int32_t level;   /* that decided; KZ_LEVELS: none */
  int64_t periods; /* first period inside a trapping region, or those that were followed */
  double error;    /* rad: how far the orbit may be off when it is trapped; of no meaning where it is chaotic or not decided */
} kz_decision;

/* Labels n starts at one level, which takes what level `before` left: decision [n]. The orbits carry their errors; each is followed at that
 * level only until its error reaches what level `before` would add, then there, and so on downwards. What is trapped is decided; the
 * others come back as KZ_DOUBTFUL, or at KZ_LEVEL_GUESS with the label of the state alone, and level KZ_LEVELS. */
void kz_dynamics_label(kz_dynamics *dynamics, int32_t level, int32_t before, int64_t n, const kz_start *start,
                       int64_t max_periods, kz_decision *decision);

/* How starts are released from now on. Its errors are measured when they are first needed, so after the trapping regions are made. */
void kz_dynamics_set_release(kz_dynamics *dynamics, const kz_release *release);
/* Takes n starts from their release to the strobe after which the drive has its final form, as a level needs them, with their errors; an
 * orbit whose error grows beyond 1e-4 rad comes back with a large one, so that no level decides it. Without a release that takes time they
 * stay. */
void kz_dynamics_release(kz_dynamics *dynamics, int32_t level, int64_t n, kz_start *start);

/* Looks for an unknown cycle near n <= 64 states that come back to themselves within `closeness` rad, until one is found or all
 * have been looked at. found [kz_dynamics_cycle_size], in and out: found[0] = states looked at so far (all 0 to begin); from
 * found[1] on what kz_dynamics_adopt takes: the cycle and its mirror image, or nothing. The catalogue itself stays as it is. */
void kz_dynamics_find_cycle(kz_dynamics *dynamics, int64_t n, const double *state, double closeness, double *found);
int64_t kz_dynamics_cycle_size(const kz_dynamics *dynamics);
/* Follows a bundle of orbits from one state through 60,000 periods, where neighbours part in its first 2000. found
 * [kz_dynamics_chaos_size]: what kz_dynamics_adopt takes: a chaotic attractor, where they diverge and are never trapped, or
 * nothing. */
void kz_dynamics_find_chaos(kz_dynamics *dynamics, const double *state, double *found);
int64_t kz_dynamics_chaos_size(void);
/* The attractors that were found join the catalogue. */
void kz_dynamics_adopt(kz_dynamics *dynamics, const double *found);

/* The catalogue as doubles, to travel between ranks. */
int64_t kz_dynamics_packed_size(const kz_dynamics *dynamics);
void kz_dynamics_pack(const kz_dynamics *dynamics, int64_t n, double *flat);
void kz_dynamics_unpack(kz_dynamics *dynamics, int64_t n, const double *flat);

/* The cycle near a state, by Newton's method on the strobe map of `numerics`: n = a period that closes it; returns its smallest
 * period, 0 where none lies within `max_distance` (rad). theta, velocity become its point there; re, im [2] its Floquet
 * multipliers over the smallest period, larger modulus first, + imaginary first. It need not attract. */
int64_t kz_dynamics_close_cycle(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, double max_distance,
                                double *theta, double *velocity, double *re, double *im);

/* The cycles of up to max_period <= 64 periods, attracting or not, with a point in the window (least and largest angle, rad, least and
 * largest velocity, rad per drive radian) that show on a line through n_nodes <= 64 states node [n_nodes][2] (the same units): where
 * an image of the line passes near the line, multiple shooting begins. found [most][2 + 2 max_period]: period, largest speed, each point
 * as half-turns and velocity; right to 1e-8 or so, some more than once. work [2]: starts that were followed, orbits that were closed or
 * not. Returns how many there are. The search ends early with more than most_starts starts, or more cycles than `most`. */
int64_t kz_dynamics_search_line(const kz_pendulum *pendulum, int64_t max_period, int64_t n_nodes, const double *node,
                                const double window[4], int64_t most_starts, int64_t most, double *found, int64_t work[2]);
/* Adds n cycles so found, in the order of periods and speeds, and their mirror images to a catalogue that holds no others, as cycles
 * of the map of published values: their points are right to rounding. It is for reading and ordering alone: it has no trapping
 * regions. */
void kz_dynamics_add_cycles(kz_dynamics *dynamics, int64_t max_period, int64_t n, const double *found);

/* The map table: n_theta nodes around the circle, n_velocity rows from -top to top, `top` a little above `max_velocity`. */
void kz_dynamics_table_create(kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity, double max_velocity);
int64_t kz_dynamics_table_row_size(const kz_dynamics *dynamics);               /* doubles per row */
void kz_dynamics_table_row(kz_dynamics *dynamics, int64_t row, double *shift); /* integrates row 0 .. n_velocity - 1 */
/* Takes all rows, in order. */
void kz_dynamics_table_set(kz_dynamics *dynamics, const double *rows);
/* Share of the cells of the regions' grid that are trapped. */
double kz_dynamics_trapped_share(const kz_dynamics *dynamics);

typedef struct {
  int32_t period, winding, centre, symmetric, mirror;
  double mean, mean_velocity; /* over time: rad in [-pi, pi], rad per drive radian */
  double amplitude;           /* rad from the centre */
  double multiplier_re[2], multiplier_im[2];
  double lyapunov, lyapunov_error;
} kz_attractor;

int64_t kz_dynamics_count(const kz_dynamics *dynamics);
/* Attractor number = 1 .. */
void kz_dynamics_attractor(const kz_dynamics *dynamics, int64_t number, kz_attractor *attractor);
/* Its strobe points theta, velocity [period] from the lowest velocity, theta in [-pi, pi); none of a chaotic one. */
void kz_dynamics_strobe(const kz_dynamics *dynamics, int64_t number, double *theta, double *velocity);
/* number [count]: the attractors in the order of the file. */
void kz_dynamics_order(const kz_dynamics *dynamics, int64_t *number);

/* ---- branches ---- */

/* One cycle of the stroboscopic map carried from parameters to parameters.
 *
 * Angles in rad from the DOWN position, velocities in rad per drive radian. The map is the one of published values (split6, 96
 * steps or more), whatever the scene's numerics. Nothing here is collective. */

/* A cycle at one value of the parameters. */
typedef struct {
  double theta, velocity;                    /* the strobe point that is followed; theta in [-pi, pi] */
  double amplitude;                          /* rad from its centre over continuous time; 0 for rotations */
  double multiplier_re[2], multiplier_im[2]; /* over the period: larger modulus first, + imaginary first */
  double half_re[2], half_im[2]; /* of the half map x -> -F^(n/2)(x) of a symmetric cycle (n = 1: -F); of the map F^n else */
  double halves_distance; /* rad, between strobe points half a period apart, the nearest pair; HUGE_VAL for odd periods */
  double mirror_distance; /* rad, between the cycle and its mirror image: the strobe point's nearest; 0 if symmetric */
  int32_t period, winding, centre, symmetric; /* centre: 0 down, 1 inverted, 2 rotating, 3 none of these */
} kz_branch_point;

/* The cycle of `pendulum` that continues `from` (whose point, period, winding and symmetry count): Newton's method from its
 * strobe point, each step at most half the last one, which keeps it from leaving for another cycle; symmetric cycles are solved
 * on the half map (BSG's flutter: -F(x) = x). Returns 1 where one of the same period, winding and symmetry lies within
 * `max_distance` rad, else 0 and *to is undefined. It need not attract. from == to is allowed. */
int32_t kz_branch_continue(const kz_pendulum *pendulum, const kz_branch_point *from, double max_distance, kz_branch_point *to);

/* Whether a and b are the same cycle at the same parameters: one is among the strobe points of the other. */
int32_t kz_branch_same(const kz_pendulum *pendulum, const kz_branch_point *a, const kz_branch_point *b);

/* ---- charts ---- */

/* Where a motion of one of many pendulums ends. */
typedef struct {
  int32_t period;        /* 0 = chaotic: not settled, and neighbours part; -1 = not settled */
  int32_t winding;       /* net turns per period */
  int32_t centre;        /* 0 down, 1 inverted, 2 rotating, 3 none of these */
  int32_t settling_time; /* drive periods until the motion is within 1e-5 rad of where it was a period of the cycle before */
  double exponent; /* largest Lyapunov exponent, per drive period: of the cycle, or of 1000 periods of a motion without one */
} kz_chart_ending;

/* Ends of the motions of n pendulums from one start (half-turns, velocity), by `steps` steps of split6 a period: followed until
 * they come back within 1e-5 rad after up to max_period periods, then Newton's method. A cycle that does not attract is left to be
 * left; a start that sits on one has not settled. max_periods [n]: 0 = not followed. */
void kz_chart_ends(int32_t steps, int64_t n, const kz_pendulum *pendulum, const double start[2], int32_t max_period,
                   const int64_t *max_periods, kz_chart_ending *endings);

/* ---- manifolds ---- */

/* One branch of the stable or unstable manifold of a saddle of the map of published values. */
typedef struct {
  double theta, velocity;       /* a point of the saddle: rad, rad per drive radian */
  int32_t period, stable, side; /* stable: 0 or 1; side: 1 or -1, along the eigenvector or against it */
  double spacing;               /* farthest that neighbouring points may be apart, rad */
  double length;                /* of the branch, rad and rad per drive radian together */
  double fastest;               /* parts at larger speeds are left out, and do not count */
} kz_branch;

/* Grows it from the saddle on; point [most][4]: theta in [-pi, pi), velocity, arc length, number of the unbroken part. Returns how many
 * points there are: all of them fit, a branch ends where no more do. */
int64_t kz_manifold_grow(const kz_pendulum *pendulum, const kz_branch *branch, int64_t most, double *point);

/* ---- step error ---- */

/* Errors of one drive period, measured on a few thousand states before anything is labelled. Nothing here is collective. */

/* error [n]: an upper estimate of the error of one drive period, by step doubling, for states with speeds from speed[c] to
 * speed[c + 1] (rad per drive radian, speed [n + 1] ascending), whole circle; rad: twice the largest of 512 states. Huge where a
 * state diverges. Double precision at most. */
void kz_step_errors(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *speed, double *error);

/* The largest error of one period of the map table (`points` nodes an axis), rad. Needs the table. */
double kz_dynamics_table_error(kz_dynamics *dynamics, int32_t points);

/* ---- proof ---- */

/* Where starts are proved to end, under the true flow (the enclosures of kernel.h; docs/explanation/proof.md). A region: ellipses that are proved
 * to contract onto a cycle, and a grid of closed cells over the whole circle and velocities from -top to top, whose second half mirrors
 * the first. Cells join by induction: they are proved to reach ellipses, or cells that have joined. Single starts are proved where
 * their set reaches the region. Numbers of attractors are 1 .. KZ_PROOF_MOST; nothing here is collective. */
enum { KZ_PROOF_MOST = 254, KZ_PROOF_LATE = 255 };
typedef struct kz_proof kz_proof;

/* An open grid of even numbers of columns and rows, for starts that are not faster than `fastest`. KZ_REFUSED, without a message, where that
 * or `top` (rad per drive radian) is too fast for enclosures, or the drive is not k - m cos t alone. *proof is to be freed in every case;
 * NULL may be. */
kz_status kz_proof_create(const kz_pendulum *pendulum, int64_t columns, int64_t rows, double top, double fastest,
                          kz_proof **proof);
void kz_proof_free(kz_proof *proof);

/* Around a strobe point: all states point + axes z, |z| <= radius; 0 = none. */
typedef struct {
  double radius, axes[2][2];
} kz_proof_ellipse;
/* Whether the map of `period` drive periods carries the ellipse into itself and contracts it: then all its starts end on one cycle. */
bool kz_proof_traps(const kz_proof *proof, int64_t period, double theta, double velocity, const kz_proof_ellipse *ellipse);
/* The largest ellipse around a strobe point (rad, rad per drive radian) whose starts are proved to end on one cycle of that period. */
kz_proof_ellipse kz_proof_find_ellipse(const kz_proof *proof, int64_t period, double theta, double velocity);
/* The ellipse joins the region as a part of attractor `number`, its mirror image as one of the mirror image `mirror`; so do cells
 * inside them. */
void kz_proof_add(kz_proof *proof, uint8_t number, uint8_t mirror, double theta, double velocity,
                  const kz_proof_ellipse *ellipse);

/* A cycle as it is published: theta, velocity [period] strobe points, and its Floquet multipliers. */
typedef struct {
  int64_t period;
  const double *theta, *velocity, *multiplier_re, *multiplier_im;
} kz_proof_cycle;
/* True where it is proved that there is one attracting cycle within theta [period], velocity [period] of the strobe points, with multipliers
 * within multiplier [2]. */
bool kz_proof_confine(const kz_proof *proof, const kz_proof_cycle *cycle, double *theta, double *velocity,
                      double multiplier[2]);

/* Cells of the first half. */
int64_t kz_proof_own(const kz_proof *proof);
/* label [n] of cells first .. first + n - 1: those that are open are followed through up to 16 periods, until the region
 * of one attractor holds their image. The grid stays as it is. */
void kz_proof_cells(const kz_proof *proof, int64_t first, int64_t n, uint8_t *label);
/* Takes the labels of the first half; mirror [number]: of the mirror image, mirror[0] = 0. Returns how many cells were open before. */
int64_t kz_proof_adopt(kz_proof *proof, const uint8_t *label, const uint8_t mirror[KZ_PROOF_MOST + 1]);
/* A start: high + low, off by at most `radius` in rad and in rad per drive radian. */
typedef struct {
  double theta[2], velocity[2], radius;
} kz_proof_start;
/* Follows n starts in KZ_ENCLOSE_DOUBLES or KZ_ENCLOSE_PAIRS. number [n]: of the attractor on which they are proved to end; 0: none,
 * because the set around it has grown, so that more digits may help; KZ_PROOF_LATE: none within most_periods. */
void kz_proof_follow(const kz_proof *proof, int32_t precision, int64_t n, const kz_proof_start *start, int64_t most_periods,
                     uint8_t *number);

#endif
