/* Windows of any depth: their images under the map, their cells as starts. Only kz_images_run is collective. */
#pragma once

#include "kapitza/dynamics_release.h"
#include "kapitza/study_release.h"
#include "kapitza/kernel_digits.h"
#include "cells/cell_starts.h"

/* ---- images: all cells of a small window move together at first. The program follows one orbit, that of the centre,
 * in as many digits as the depth needs, and beside it the window as a polynomial of degree 3. After n periods this
 * gives the start of every cell. ---- */

/* The window after n periods: centre, and a polynomial in shares of the width, -1/2 to 1/2 along each axis. */
typedef struct {
  double theta[2], velocity[2]; /* pairs: rad in [-pi, pi], rad per drive radian */
  kz_jet jet;
  int64_t turns; /* net turns by which the angle of the centre on the line is more */
  double lost;   /* error of the centre, relative to the present size of the window */
} kz_image;

typedef struct {
  int64_t holders;
  kz_pendulum pendulum;
  kz_release release;
  kz_coordinate centre[2]; /* theta, velocity; this struct owns their texts */
  __float128 width[2];
  int64_t bits;   /* Bits of the orbit in its first periods */
  int64_t before; /* periods before image 0 */
  int64_t digits; /* images of a line: of x, that images need to be marked; 0 = no image is marked any more */
  int64_t marked; /* the last image that is marked */
  int64_t n;      /* image [0 .. n] */
  int64_t capacity;
  kz_image *image;
  bool finished; /* no later image is useful: the window has become wide, or is trapped as a whole */
  kz_arbitrary *orbit;
} kz_images;

/* Makes the images of the window of two axes, with the window itself only. Image 0 is released as dynamics says; image
 * n is that at strobe n. */
kz_images *kz_images_create(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_axis *theta,
                            const kz_axis *velocity);
/* Makes the images of a line, of the points centre + x * width of two coordinates, for points whose x have so many
 * digits. They are marked as long as the polynomial is right to these digits. y is not used. */
kz_images *kz_images_on_line(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate point[2],
                             int64_t digits);
/* Makes images of a piece of that line from the marked image on: x counts from `share` in units of 2^exponent. */
kz_images *kz_images_beside(const kz_images *images, __float128 share, int exponent, int64_t digits);
/* Adds a holder and returns `images`. kz_images_free removes a holder, and the last one frees them; it accepts NULL. */
kz_images *kz_images_hold(kz_images *images);
void kz_images_free(kz_images *images);

/* Adds up to `most` images. It ends earlier, and sets `finished`, if max_periods have passed, if the image has become
 * too wide for a cubic, or if a trapping region holds all of it. */
kz_status kz_images_follow(kz_images *images, kz_dynamics *dynamics, int64_t most, int64_t max_periods);

/* Follows until the images are finished, in stages that a checkpoint keeps: one rank follows, and every rank gets the
 * same images. Collective. */
kz_status kz_images_run(const kz_run *run, kz_dynamics *dynamics, kz_images *images, int64_t max_periods);

/* The place of a window in that of the images: the share x of its width is the share offset + scale x of theirs; reach
 * = the largest of these in modulus. */
typedef struct {
  __float128 offset[2], scale[2];
  double reach;
} kz_view;

/* True if the images can be used for the cells of a window, which must have nearly the same centre and may be at most a
 * little narrower than theirs. Fills *view. */
bool kz_images_serve(const kz_images *images, kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_axis *theta,
                     const kz_axis *velocity, kz_view *view);

/* The image from which the cells of a window are handed over to a precision level, with its polynomial in doubles. */
typedef struct {
  const kz_image *image;
  int64_t periods;
  bool in_quads; /* starts need more digits than doubles have */
  double linear[2][2], higher_terms[2][KZ_HIGHER_TERMS];
  double error; /* rad, of a start */
} kz_hand_over;

/* True if image n lies at a strobe of the final drive. */
bool kz_image_is_final(const kz_images *images, int64_t n);

/* True if the polynomial of image n is right to so many digits of x. */
bool kz_image_is_straight(const kz_images *images, int64_t n, int64_t digits);

/* hand_over [KZ_LEVELS]: for every level the hand-over by image 0, or by the last image at a strobe of the final drive
 * whose polynomial is as accurate as the level's own arithmetic, for shares up to `reach`. */
void kz_hand_overs_make(const kz_images *images, double reach, kz_hand_over *hand_over);
/* *start = the start at the shares theta and velocity of the width of the images. */
void kz_hand_over_start(const kz_hand_over *hand_over, __float128 theta, __float128 velocity, kz_start *start);
/* Start as its distance from the image's centre, in doubles: change [2], rad and rad per drive radian. */
void kz_hand_over_change(const kz_hand_over *hand_over, double theta, double velocity, double change[2]);

/* ---- own orbits: a level beyond quad precision ---- */

extern const kz_level kz_own_orbit_level;

/* Follows the start, released as dynamics says, in more and more digits until double or quad precision decides the rest
 * of its motion. decision->end.label = number of an attractor; 0 = not settled within max_periods; KZ_DOUBTFUL =
 * undecided even with 10,000 bits, or with the most bits of the build. */
kz_status kz_own_orbit_decide(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate start[2],
                              int64_t max_periods, kz_decision *decision);

/* ---- cells of a basin's window as starts, at any depth; items are cell numbers, theta fastest ---- */

typedef struct {
  const kz_basin_plan *plan;
  const kz_pendulum *pendulum;
  kz_dynamics *dynamics;
  kz_images *images; /* this struct is a holder; NULL = the cells are doubles */
  kz_hand_over hand_over[KZ_LEVELS];
  __float128 *place[2]; /* with images: place of each column and of each row, in shares of the images' width */
  kz_cell_starts cells; /* without images */
} kz_window_starts;

/* Makes the starts from finished images that serve the window (kz_images_serve), or NULL. The caller frees them. */
void kz_window_starts_make(const kz_basin_plan *plan, const kz_pendulum *pendulum, kz_dynamics *dynamics,
                           kz_images *images, kz_window_starts *starts);
void kz_window_starts_free(kz_window_starts *starts);

/* Makes a labeller of the cells. decide: cells that quad leaves undecided are decided by their own orbits. */
kz_labeller kz_window_labeller(const kz_window_starts *starts, bool cells_decide);

/* ---- curves: the map stretches a small window along one direction and compresses it across. When its cells are handed
 * over to doubles, a deep window has become a curve, so samples along the curve give the labels of all cells. ---- */

typedef struct {
  const kz_hand_over *hand_over;
  double middle[2], along[2]; /* middle of the window, unit vector of the curve: shares of the images' width */
  double step;                /* distance of neighbouring samples */
  int64_t count;              /* number of samples; 0 = the window is not a curve */
  int64_t columns;            /* Columns of the window */
  double *column, *row;       /* column [j] + row [i] = place of cell (i, j), in steps from sample 0 */
} kz_window_curve;

/* Makes the curve with 16 samples a cell, so that a sample is at most 1/32 of a cell from the start of a cell; across
 * the curve starts differ by less than a tenth of that. The caller frees it. */
void kz_window_curve_make(const kz_window_starts *starts, kz_window_curve *curve);
void kz_window_curve_free(kz_window_curve *curve);

/* Returns the sample nearest to a cell. */
int64_t kz_window_curve_sample(const kz_window_curve *curve, int64_t cell);
/* State of a sample at hand-over: state [2], half-turns and rad per drive radian, after *periods drive periods. */
void kz_window_curve_state(const kz_window_curve *curve, int64_t sample, double state[2], int64_t *periods);
