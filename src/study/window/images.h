/* The images of a window under the map. All cells of a small window move together at first. The program follows one orbit, that of the
 * centre, in as many digits as the depth needs, and beside it the window as a polynomial of degree 3. After n periods this gives the start
 * of every cell. Nothing here is collective. */
#ifndef KAPITZA_STUDY_IMAGES_H
#define KAPITZA_STUDY_IMAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* The window after n periods: its centre, and the other points as a polynomial in shares of the width, -1/2 to 1/2 along each axis. */
typedef struct {
  double theta[2], velocity[2]; /* pairs: rad in [-pi, pi], rad per drive radian */
  kz_jet jet;
  double lost; /* error of the centre, relative to the present size of the window */
} kz_image;

typedef struct {
  int64_t holders;
  kz_pendulum pendulum;
  kz_coordinate centre[2]; /* theta, velocity; this struct owns their texts */
  __float128 width[2];
  int64_t bits;   /* of the orbit in its first periods */
  int64_t before; /* periods before image 0 */
  int64_t digits; /* images of a line: of x, that images need to be marked; 0 = no image is marked any more */
  int64_t marked; /* the last image that is marked */
  int64_t n;      /* image [0 .. n] */
  int64_t capacity;
  kz_image *image;
  bool finished; /* no later image is useful: the window has become wide, or is trapped as a whole */
  kz_arbitrary *orbit;
} kz_images;

/* Makes the images of the window of two axes, with its image after 0 periods only. */
kz_images *kz_images_create(const kz_pendulum *pendulum, const kz_axis *theta, const kz_axis *velocity);
/* Makes the images of a line, of the points centre + x * width of two coordinates, for points whose x have so many digits. They are marked as
 * long as the polynomial is right to these digits. y is not used. */
kz_images *kz_images_on_line(const kz_pendulum *pendulum, const kz_coordinate point[2], int64_t digits);
/* Makes the images of a piece of that line from the marked image on: x is counted from `share` in units of 2^exponent of the old one. */
kz_images *kz_images_beside(const kz_images *images, __float128 share, int exponent, int64_t digits);
/* Adds a holder and returns `images`. kz_images_free removes a holder, and the last one frees them; it accepts NULL. */
kz_images *kz_images_hold(kz_images *images);
void kz_images_free(kz_images *images);

/* Adds up to `most` images. It ends earlier, and sets `finished`, if max_periods have passed, if the image has become too wide for a cubic,
 * or if a trapping region holds all of it. */
kz_status kz_images_follow(kz_images *images, kz_dynamics *dynamics, int64_t most, int64_t max_periods);

/* Estimates the work that is left, in units of the last period. It assumes that the image goes on to grow as it did, and that the time of
 * a period falls as the square of the bits. */
double kz_images_left(const kz_images *images);

/* Replaces all images after image `before` by n images that another rank has made. */
void kz_images_extend(kz_images *images, int64_t before, int64_t n, const kz_image *image, bool finished);

/* The place of a window in that of the images: the share x of its width is the share offset + scale x of theirs; reach = the largest of
 * these in modulus. */
typedef struct {
  __float128 offset[2], scale[2];
  double reach;
} kz_view;

/* True if the images can be used for the cells of a window, which must have nearly the same centre and may be at most a little narrower
 * than theirs. Fills *view. */
bool kz_images_serve(const kz_images *images, const kz_pendulum *pendulum, const kz_axis *theta, const kz_axis *velocity,
                     kz_view *view);

/* The image from which the cells of a window are handed over to a precision level, with its polynomial in doubles. */
typedef struct {
  const kz_image *image;
  int64_t periods;
  bool in_quads; /* starts need more digits than doubles have */
  double linear[2][2], bent[2][KZ_BENT];
  double error; /* rad, of a start */
} kz_hand_over;

/* True if the polynomial of image n is right to so many digits of x. */
bool kz_image_is_straight(const kz_images *images, int64_t n, int64_t digits);

/* The hand-over by the last image whose polynomial is as accurate as the level's own arithmetic, for shares up to `reach`. */
kz_hand_over kz_hand_over_at(const kz_images *images, int32_t level, double reach);
/* *start = the start at the shares theta and velocity of the width of the images. */
void kz_hand_over_start(const kz_hand_over *hand_over, __float128 theta, __float128 velocity, kz_start *start);
/* The same start as its distance from the image's centre, in doubles: change [2], rad and rad per drive radian. */
void kz_hand_over_change(const kz_hand_over *hand_over, double theta, double velocity, double change[2]);

#endif
