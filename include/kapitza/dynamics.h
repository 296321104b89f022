/* dynamics: the pendulum's attractors, their trapping regions, the search for them, and the map table (ICM) (Fortran;
 * layer 1).
 *
 * Attractors are numbered from 1 in the order of their discovery; kz_dynamics_order gives the order of the file. States
 * are pairs (half-turns, velocity): theta/pi in [-1, 1], and rad per drive radian. */
#pragma once

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

/* Makes the grid for trapping regions, up to the velocity `max_velocity` (rad per drive radian), of `cells` x `cells`
 * (one more if odd) around the circle and along the velocity: integrates its nodes through 8 periods and grows the
 * regions around the known attractors. cells 0: a coarse empty grid, which is enough for a search. */
void kz_dynamics_regions(kz_dynamics *dynamics, int64_t cells, double max_velocity);
/* Adds the ellipses and covers of new attractors to the regions; on a fine grid the regions then grow. */
void kz_dynamics_update(kz_dynamics *dynamics);

/* Searches from n <= 64 states, which leave the catalogue as it is. KZ_FIND_CYCLE: an unknown cycle near a state that
 * returns to itself within `number` rad, until one is found or all states have been tried. KZ_FIND_RUNNING: a running
 * state among them, whose orbits are followed through 8000 periods at most, if damping has had the time to bring them
 * to an attractor in `number` periods. KZ_FIND_CHAOS: a bundle of orbits near the first state; if neighbours separate
 * in the first 2000 periods, it goes on for 60,000: a chaotic attractor if the orbits separate and no region traps
 * them. found [kz_dynamics_find_size], in and out, 0 before the first call: found[0] = number of states tried so far
 * (of cycles); behind it the attractor and its mirror image, for kz_dynamics_adopt, or nothing. */
typedef enum { KZ_FIND_CYCLE, KZ_FIND_RUNNING, KZ_FIND_CHAOS } kz_find;
void kz_dynamics_find(kz_dynamics *dynamics, kz_find what, int64_t n, const double *state, double number,
                      double *found);
int64_t kz_dynamics_find_size(const kz_dynamics *dynamics, kz_find what);
/* Adds the attractors in `found` to the catalogue. */
void kz_dynamics_adopt(kz_dynamics *dynamics, const double *found);

/* The catalogue as doubles, flat [n], for messages between ranks. Returns how many it takes; with a smaller n it writes
 * none. */
int64_t kz_dynamics_pack(const kz_dynamics *dynamics, int64_t n, double *flat);
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
  int32_t averaged;           /* 1: a running state known by orbit averages alone, without a band that traps motions */
  double mean, mean_velocity; /* over time: rad in [-pi, pi], rad per drive radian */
  double amplitude;           /* rad from the centre, over continuous time; 0 for rotations */
  double multiplier_re[2], multiplier_im[2]; /* over the period: larger modulus first, + imaginary first */
  double lyapunov, lyapunov_error;           /* largest exponent per drive period, and its standard error */
} kz_attractor;
static inline bool kz_is_running(const kz_attractor *attractor) {
  return attractor->period == 0 && attractor->winding != 0;
}

int64_t kz_dynamics_count(const kz_dynamics *dynamics);
/* Attractor `number`, from 1 to the count. */
void kz_dynamics_attractor(const kz_dynamics *dynamics, int64_t classes_number, kz_attractor *attractor);
/* Strobe points theta [period] in [-pi, pi), velocity [period], from the lowest velocity on; none if chaotic. */
void kz_dynamics_strobe(const kz_dynamics *dynamics, int64_t number_classes, double *theta, double *velocity);
/* number [count] = the numbers of the attractors in the order of the file. */
void kz_dynamics_order(const kz_dynamics *dynamics, int64_t *number);
