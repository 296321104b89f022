/* dynamics: the pendulum's attractors, their trapping regions, the search for them, and the map table (ICM) (Fortran;
 * layer 1).
 *
 * Attractors are numbered from 1 in the order of their discovery; kz_dynamics_order gives the order of the file. States
 * are pairs (half-turns, velocity): theta/pi in [-1, 1], and rad per drive radian. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/kernel.h"

typedef struct kz_dynamics kz_dynamics;

/* A window of starts: rad, rad per drive radian. */
typedef struct {
  double theta_min, theta_max, velocity_min, velocity_max;
} kz_window;

/* The dynamics of a pendulum, without attractors yet. Several threads may follow, label and release starts at the same
 * time, as long as none changes the attractors or the regions. Searches look for cycles of up to max_period drive
 * periods. Free with kz_dynamics_free. */
kz_dynamics *kz_dynamics_create(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t max_period);
void kz_dynamics_free(kz_dynamics *dynamics);
/* Frees a local variable at the end of its scope (KZ_AUTOFREE_BY). */
static inline void kz_dynamics_freed(kz_dynamics **dynamics) {
  kz_dynamics_free(*dynamics);
}

/* n starts spread evenly over the window: state [n][2]. Another seed gives other starts. */
void kz_dynamics_starts(const kz_window *cells_window, int64_t seed, int64_t n, double *state);

/* The largest velocity (rad per drive radian) within one period of starts in the window, and of starts as fast as a
 * torque drives motions: a map table must reach it. */
double kz_dynamics_max_velocity(kz_dynamics *dynamics, const kz_window *window);
/* Returns the largest velocity (rad per drive radian) that a pendulum with these numerics reaches from the window. */
double kz_max_velocity(const kz_pendulum *pendulum, const kz_numerics *numerics, const kz_window *window);

/* Makes a coarse empty grid for trapping regions, up to `max_velocity` (rad per drive radian): enough for a search. */
void kz_dynamics_coarse_regions(kz_dynamics *dynamics, double max_velocity);
/* Replaces it by a grid of `cells` x `cells` (one more if odd) around the circle and along the velocity. Integrates its
 * nodes through 8 periods and grows the regions around the known attractors. */
void kz_dynamics_fine_regions(kz_dynamics *dynamics, int64_t cells, double max_velocity);
/* Adds the ellipses and covers of new attractors to the regions; on a fine grid the regions then grow. */
void kz_dynamics_update(kz_dynamics *dynamics);

/* Looks for an unknown cycle near n <= 64 states that return to themselves within `closeness` rad, until it finds one
 * or has tried all states. found [kz_dynamics_cycle_size], in and out, 0 before the first call: found[0] = number of
 * states tried so far; from found[1] on the cycle and its mirror image, for kz_dynamics_adopt, or nothing. The
 * catalogue does not change. */
void kz_dynamics_find_cycle(kz_dynamics *dynamics, int64_t n, const double *state, double closeness, double *found);
int64_t kz_dynamics_cycle_size(const kz_dynamics *dynamics);
/* Follows a bundle of orbits near one state. If neighbours separate in the first 2000 periods, it goes on for 60,000.
 * found [kz_dynamics_chaos_size]: a chaotic attractor, for kz_dynamics_adopt, if the orbits separate and no region
 * traps them; else nothing. */
void kz_dynamics_find_chaos(kz_dynamics *dynamics, const double *state, double *found);
int64_t kz_dynamics_chaos_size(void);
/* Looks for a running state among n <= 64 states, whose orbits it follows through 8000 periods at most, if damping has
 * had the time to bring them to an attractor in `age` periods. found [kz_dynamics_chaos_size]: the motion, for
 * kz_dynamics_adopt, or nothing. */
void kz_dynamics_find_running(kz_dynamics *dynamics, int64_t n, const double *state, int64_t age, double *found);
/* Adds the attractors in `found`, of one of the calls above, to the catalogue. */
void kz_dynamics_adopt(kz_dynamics *dynamics, const double *found);

/* The catalogue as doubles, flat [n], for messages between ranks; n = kz_dynamics_packed_size. */
int64_t kz_dynamics_packed_size(const kz_dynamics *dynamics);
void kz_dynamics_pack(const kz_dynamics *dynamics, int64_t n, double *flat);
void kz_dynamics_unpack(kz_dynamics *dynamics, int64_t n, const double *flat);

/* Makes an empty map table: n_theta nodes on the circle, n_velocity rows to +-top, just above `max_velocity`. */
void kz_dynamics_table_create(kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity, double max_velocity);
/* Number of doubles in a row. */
int64_t kz_dynamics_table_row_size(const kz_dynamics *dynamics);
/* Integrates row 0 .. n_velocity - 1 of the table: shift [row size]. */
void kz_dynamics_table_row(kz_dynamics *dynamics, int64_t row, double *shift);
/* Sets the table from all its rows, in order. */
void kz_dynamics_table_set(kz_dynamics *dynamics, const double *rows);
/* Share of the cells of the regions' grid that belong to a trapping region. */
double kz_dynamics_trapped_share(const kz_dynamics *dynamics);

/* A motion of one pendulum: an attractor, or a cycle on a branch, which need not attract. period: 0 = it never closes:
 * chaotic, or with the winding 1 or -1, the sign of its mean velocity, a running state. Of cycles on branches mirror,
 * mean values and exponents are not known. */
typedef struct {
  double theta, velocity; /* first strobe point of a cycle, else means: rad in [-pi, pi], rad per drive radian */
  int32_t period, winding, centre, symmetric, mirror; /* centre: 0 down, 1 inverted, 2 rotating, 3 none of these */
  double mean, mean_velocity;                         /* over time: rad in [-pi, pi], rad per drive radian */
  double amplitude;                                   /* rad from the centre, over continuous time; 0 for rotations */
  double multiplier_re[2], multiplier_im[2];          /* over the period: larger modulus first, + imaginary first */
  double lyapunov, lyapunov_error;                    /* largest exponent per drive period, and its standard error */
} kz_attractor;
static inline bool kz_is_running(const kz_attractor *attractor) {
  return attractor->period == 0 && attractor->winding != 0;
}

int64_t kz_dynamics_count(const kz_dynamics *dynamics);
/* Attractor `number`, from 1 to the count. */
void kz_dynamics_attractor(const kz_dynamics *dynamics, int64_t classes_number, kz_attractor *attractor);
/* Returns 1 for a running state known by orbit averages alone (no band was found that traps motions), else 0. */
int32_t kz_dynamics_is_averaged(const kz_dynamics *dynamics, int64_t classes_number);
/* Strobe points theta [period] in [-pi, pi), velocity [period], from the lowest velocity on; none if chaotic. */
void kz_dynamics_strobe(const kz_dynamics *dynamics, int64_t number_classes, double *theta, double *velocity);
/* number [count] = the numbers of the attractors in the order of the file. */
void kz_dynamics_order(const kz_dynamics *dynamics, int64_t *number);
