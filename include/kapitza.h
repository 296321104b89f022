/* kapitza: basins of attraction of the shaken pendulum, in the process of the caller. Plain C, as cffi reads it.
 *
 *   theta'' + beta theta' + (k - m cos t) sin theta = 0, and every other drive that a scene can describe
 *
 * theta is in rad from the down position, velocity in rad per drive radian, t in drive radians; a drive period is 2 pi, and a strobe is the
 * state at t = 0 mod 2 pi. Arrays are the caller's and have the length that stands beside them.
 *
 * Threads: calls on different pendulums run at the same time, calls on one pendulum one after the other. A process that was forked may use a
 * pendulum unless another thread was using it at that moment (KAPITZA_REFUSED). Nothing is kept outside of a pendulum.
 *
 * Names may change until 1.0; CHANGELOG.md lists each change. */
#ifndef KAPITZA_H
#define KAPITZA_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Status of a call. After any but KAPITZA_OK the results are not set; the next call works as if this one was not
 * made. */
typedef enum {
  KAPITZA_OK = 0,
  KAPITZA_FAILED = 1,    /* failed while computing */
  KAPITZA_REFUSED = 2,   /* the scene or an argument is wrong */
  KAPITZA_NO_MEMORY = 3, /* memory ran out */
  KAPITZA_STOPPED = 75   /* the pause of this thread asked for it */
} kapitza_status;

/* Returns one line: what was wrong in the last call of this thread that did not return KAPITZA_OK. */
const char *kapitza_message(void);
/* "0.5.0". */
const char *kapitza_version(void);

/* Sets what calls of this thread ask about 20 times a second whether to go on: any result but 0 stops the call (KAPITZA_STOPPED). NULL: nothing
 * is asked. It must not use the pendulum of the call. */
typedef int (*kapitza_pause)(void *context);
void kapitza_set_pause(kapitza_pause pause, void *context);

/* ---- the pendulum ---- */

typedef struct kapitza_pendulum kapitza_pendulum;

/* Makes a pendulum from the text of a scene (YAML or JSON; docs/reference/scene.md), for example
 *   "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}"
 * Of the scene it takes the mappings `pendulum`, `numerics` and `basin`: the window, the search for attractors, the phase of release. Without
 * `basin` the window is the whole circle and velocities from -2 to 2. Free it by kapitza_pendulum_free. */
kapitza_status kapitza_pendulum_create(const char *scene, kapitza_pendulum **pendulum);
/* Frees a pendulum that no thread uses; NULL: nothing. */
void kapitza_pendulum_free(kapitza_pendulum *pendulum);

/* The numbers of a pendulum; NaN = not defined. */
typedef struct {
  double k, beta, m;                                       /* k = 1/Omega^2, beta = 1/(Q Omega), m = epsilon */
  double quality_factor, drive_frequency, drive_amplitude; /* Q, Omega, epsilon */
  double pivot_frequency;                                  /* rad/s, of a scene in SI units */
  int32_t mirrored; /* 1: the mirror image (-theta, -velocity) of every motion is a motion, else 0 */
} kapitza_parameters;
kapitza_status kapitza_parameters_of(kapitza_pendulum *pendulum, kapitza_parameters *parameters);

/* Moves n states through drive periods, backwards if periods < 0, with the numerics of all published numbers (error some 1e-12 rad a period).
 * In and out: theta [n], out in [-pi, pi); velocity [n]. turns [n] = net turns, counterclockwise +; NULL = not wanted.
 * tangent [n][2][2] = d(theta, velocity)/d(theta0, velocity0); NULL = not wanted. */
kapitza_status kapitza_map(kapitza_pendulum *pendulum, int64_t n, int64_t periods, double *theta, double *velocity,
                           int64_t *turns, double *tangent);

/* One motion in continuous time, after `transient` periods: theta_out (not wrapped) and velocity_out [periods * samples + 1],
 * `samples` a period, both ends included. */
kapitza_status kapitza_orbit(kapitza_pendulum *pendulum, double theta, double velocity, int64_t transient, int64_t periods,
                             int64_t samples, double *theta_out, double *velocity_out);

/* ---- cycles: attractors, saddles ---- */

/* A periodic motion, or an attractor without a period. */
typedef struct {
  char name[64];                             /* "inverted", "rotation +1/1", ... as in files */
  int32_t period;                            /* drive periods; 0: chaotic, or a running state (winding 1 or -1) */
  int32_t winding;                           /* net turns in a period */
  int32_t centre;                            /* 0 down, 1 inverted, 2 rotating, 3 none of these */
  int32_t symmetric;                         /* 1: it is its own image under the symmetry of the pendulum, else 0 */
  int32_t mirror;                            /* index of the mirror image in the list; its own if symmetric or alone */
  double mean_theta, mean_velocity;          /* over time; not of cycles that do not attract */
  double amplitude;                          /* rad from the centre; 0 for rotations */
  double multiplier_re[2], multiplier_im[2]; /* Floquet multipliers over the period, larger modulus first */
  double lyapunov, lyapunov_error;           /* largest exponent per drive period; its standard error */
  const double *theta, *velocity;            /* [period] strobe points in the order of time */
} kapitza_cycle;

/* A list in one piece of memory: free it by kapitza_free. */
typedef struct {
  int64_t count;
  const kapitza_cycle *cycle; /* [count] */
} kapitza_cycles;
void kapitza_free(void *memory);

/* Lists the known attractors in the order of files; indices are ids. The first call searches; labels may find more. */
kapitza_status kapitza_attractors(kapitza_pendulum *pendulum, kapitza_cycles **list);
/* All cycles of up to max_period periods, attracting or not, with a point in window [4]: least and largest angle, least and largest velocity.
 * *open = number of pairs of period and winding whose indices do not add up to 0: if it is 0 none is missing (docs/explanation/theory.md). */
kapitza_status kapitza_all_cycles(kapitza_pendulum *pendulum, int64_t max_period, const double window[4], kapitza_cycles **list,
                                  int64_t *open);
/* The cycle that Newton's method finds near a state and that closes after `period` <= 64 periods, attracting or not; the first strobe
 * point is that near the state. The list is empty if none lies within `distance` (rad). */
kapitza_status kapitza_cycle_near(kapitza_pendulum *pendulum, int64_t period, double theta, double velocity, double distance,
                                  kapitza_cycles **list);

/* One branch of the stable (stable 1) or unstable (0) manifold of the saddle with this point, along its eigenvector (side 1) or against it (-1).
 * Neighbours are at most `spacing` apart, the branch is `length` long (rad and rad per drive radian together), and parts faster than `fastest`
 * are left out. point [most][4]: theta in [-pi, pi), velocity, arc length, number of the unbroken part. *count = number of points. */
kapitza_status kapitza_manifold(kapitza_pendulum *pendulum, double theta, double velocity, int32_t period, int32_t stable,
                                int32_t side, double spacing, double length, double fastest, int64_t most, double *point,
                                int64_t *count);

/* ---- basins ---- */

/* Evidence of a label, values of `evidence` (docs/reference/file.md); 3 = undecided, `other` is the second
 * candidate. */
enum { KAPITZA_NO_TURNS = -2147483647 - 1 };

/* Labels n starts as basin.method exact does. start_error = bound of the distance of each motion from its start (hypot of rad and rad per drive
 * radian); 0 = the numbers are exact. Arrays [n], each may be NULL: attractor = id, -1 = not settled; other = the second candidate of an
 * undecided start, else -1; settling_time in drive periods; turns = net turns until the end, KAPITZA_NO_TURNS = not known; error = bound of
 * the orbit's error when it was trapped, rad, NaN = not known. *list = the attractors to which the ids refer; NULL = not wanted. */
kapitza_status kapitza_labels(kapitza_pendulum *pendulum, int64_t n, const double *theta, const double *velocity,
                              double start_error, int16_t *attractor, int16_t *other, uint8_t *evidence, int64_t *settling_time,
                              int32_t *turns, double *error, kapitza_cycles **list);

/* Labels of the cells of a window; one piece of memory, freed by kapitza_free. */
typedef struct {
  int64_t columns, rows;
  const double *theta, *velocity;     /* [columns], [rows] centres of the cells */
  const int16_t *attractor, *other;   /* [rows][columns] as of kapitza_labels */
  const uint8_t *evidence;            /* [rows][columns] */
  const float *settling_time, *turns; /* [rows][columns]; NaN = not known */
  const kapitza_cycles *attractors;
} kapitza_basin;
/* Labels the cells of a window by all cores. window: keys of the mapping `basin` of a scene, such as
 *   "theta: {count: 500}, velocity: {min: -2, max: 2, count: 500}" or, at any depth, "theta: {centre: 2.0512, width: 1e-20, count: 500}, ..."
 * Keys that it leaves out are those of the pendulum's scene; NULL: all of them. */
kapitza_status kapitza_basin_of(kapitza_pendulum *pendulum, const char *window, kapitza_basin **basin);

/* ---- scenes ---- */

/* Runs a scene (text) on one rank and writes the result file `output`, which must not exist unless overwrite is 1. *summary = what
 * the program prints, freed by kapitza_free; NULL = not wanted. */
kapitza_status kapitza_run(const char *scene, const char *output, int32_t overwrite, char **summary);

#ifdef __cplusplus
}
#endif
#endif
