/* The images of a window under the map. All cells of a small window share their first periods: one orbit, that of the centre, is followed in
 * as many digits as the depth takes, and beside it the window as a polynomial of degree 3. So cells become starts that have spent n periods.
 * Nothing here is collective. */
#ifndef KAPITZA_STUDY_IMAGES_H
#define KAPITZA_STUDY_IMAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* The window after n periods: its centre, and the rest as a polynomial in shares of its width, -1/2 to 1/2 along each axis. */
typedef struct {
  double theta[2], velocity[2]; /* pairs: rad in [-pi, pi], rad per drive radian */
  kz_jet jet;
  double lost; /* error of the centre, relative to the window's size now */
} kz_image;

typedef struct {
  int64_t holders;
  kz_pendulum pendulum;
  kz_coordinate centre[2]; /* theta, velocity; their texts are its own */
  __float128 width[2];
  int64_t bits; /* of the orbit in its first periods */
  int64_t n;    /* image [0 .. n] */
  int64_t capacity;
  kz_image *image;
  bool finished; /* no later image serves: the window has become wide, or is trapped as a whole */
  kz_arbitrary *orbit;
} kz_images;

/* Of the window of two axes, with its image after 0 periods. */
kz_images *kz_images_create(const kz_pendulum *pendulum, const kz_axis *theta, const kz_axis *velocity);
/* One more holds them; the last one that lets go frees them (NULL: nothing). */
kz_images *kz_images_hold(kz_images *images);
void kz_images_free(kz_images *images);

/* Adds up to `most` images. Ends earlier where it is finished: max_periods have passed, the image has become too wide for a cubic, or a
 * trapping region holds all of it. */
kz_status kz_images_follow(kz_images *images, kz_dynamics *dynamics, int64_t most, int64_t max_periods);

/* What is left to follow, in periods that take as long as the last one: the image grows as it did, and the time falls as the square of the
 * bits. An estimate. */
double kz_images_left(const kz_images *images);

/* Takes n images that follow image `before` from elsewhere, in the place of those that are here. */
void kz_images_extend(kz_images *images, int64_t before, int64_t n, const kz_image *image, bool finished);

/* Where a window lies in that of the images: at offset + scale x for a share x of its own width; `reach`: the farthest share of theirs. */
typedef struct {
  __float128 offset[2], scale[2];
  double reach;
} kz_view;

/* Whether the images serve the cells of a window: one about nearly the same place that is as wide or wider, or little narrower. */
bool kz_images_serve(const kz_images *images, const kz_pendulum *pendulum, const kz_axis *theta, const kz_axis *velocity,
                     kz_view *view);

/* Where the cells of a window begin at a precision level: an image, its polynomial in doubles, the error of a start. */
typedef struct {
  const kz_image *image;
  int64_t periods;
  bool in_quads; /* starts are needed in more digits than doubles have */
  double linear[2][2], bent[2][KZ_BENT];
  double error; /* rad */
} kz_hand_over;

/* The last image whose polynomial is right to the errors of the level, for shares up to `reach`. */
kz_hand_over kz_hand_over_at(const kz_images *images, int32_t level, double reach);
/* The start at shares of the width of the images. */
void kz_hand_over_start(const kz_hand_over *hand_over, __float128 theta, __float128 velocity, kz_start *start);
/* The same as the change from the image's centre, in doubles: rad, rad per drive radian. */
void kz_hand_over_change(const kz_hand_over *hand_over, double theta, double velocity, double change[2]);

#endif
