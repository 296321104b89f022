/* Chooses the period where per-cell integration starts: the last image as accurate as the arithmetic after it. */
#include "window.h"

/* rad: images that are wider are bent too much for any estimate of the fourth degree. */
static const long double widest = 1e-3L;
/* Relative rounding of the coefficients of the first degree, a period, and of all that a pair of doubles holds. */
static const long double linear_error = 4e-34L, bent_error = 1e-18L, pair_error = 4e-32L;

/* Sums of the coefficients' moduli of one degree, for shares up to `reach`. */
typedef struct {
  long double linear, square, cube;
} sizes;

static sizes sizes_of(const kz_jet *jet, double reach) {
  sizes s = {0};
  for (int axis = 0; axis < 2; axis++) {
    for (int i = 0; i < 2; i++) s.linear += fabsl((long double)jet->linear[axis][i]);
    for (int i = 0; i < 3; i++) s.square += fabsl(jet->higher_terms[axis][i]);
    for (int i = 3; i < KZ_HIGHER_TERMS; i++) s.cube += fabsl(jet->higher_terms[axis][i]);
  }
  s.linear *= reach;
  s.square *= (long double)reach * reach;
  s.cube *= (long double)reach * reach * reach;
  return s;
}

/* An estimate, about twice too large, of what degrees above the third would add: the third degree times the ratio of
 * two successive degrees. The ratio is that of the second degree to the first, or, if that is larger, the root of the
 * ratio of the third to the first: a symmetric centre has no second degree. Near a fold the first degree is small, and
 * both ratios are large. */
static long double left_out(const sizes *s) {
  if (!(s->linear > 0)) return s->cube;
  return 2 * s->cube * fmaxl(s->square / s->linear, sqrtl(s->cube / s->linear));
}

/* Errors of a start from image n, rad; the first image is the window itself. */
static long double error_of(const kz_images *images, int64_t n, const sizes *s) {
  const kz_image *image = images->image + n;
  const long double whole = sizes_of(&image->jet, 0.5).linear;
  const long double state = pair_error * hypotl(image->theta[0], image->velocity[0]);
  if (n == 0) return state;
  return left_out(s) + linear_error * (long double)n * s->linear + bent_error * (long double)n * (s->square + s->cube) +
         image->lost * whole + state;
}

bool kz_image_is_final(const kz_images *images, int64_t n) {
  return images->before + n >= kz_release_strobes(&images->release);
}

bool kz_image_is_straight(const kz_images *images, int64_t n, int64_t digits) {
  enum { MORE = 3 };
  const sizes s = sizes_of(&images->image[n].jet, 0.5);
  const long double rounding = bent_error * (long double)(images->before + n) * (s.square + s.cube);
  return left_out(&s) + rounding <= powl(10, -(long double)(digits + MORE)) * s.linear;
}

static int64_t last_image(const kz_images *images, const kz_level *level, double reach) {
  int64_t last = 0;
  for (int64_t n = 1; n <= images->n; n++) {
    const sizes s = sizes_of(&images->image[n].jet, reach);
    const long double bound =
        level->error + pair_error * hypotl(images->image[n].theta[0], images->image[n].velocity[0]);
    if (!(s.linear < widest)) break;
    if (!kz_image_is_final(images, n)) continue;
    if (left_out(&s) + bent_error * (long double)n * (s.square + s.cube) <= bound) last = n;
  }
  return last;
}

static kz_hand_over hand_over_at(const kz_images *images, const kz_level *level, double reach) {
  const int64_t n = last_image(images, level, reach);
  const kz_image *image = images->image + n;
  const sizes s = sizes_of(&image->jet, reach);
  kz_hand_over h = {.image = image,
                    .periods = images->before + n,
                    .in_quads = n == 0 || level->in_pairs,
                    .error = (double)error_of(images, n, &s)};
  for (int axis = 0; axis < 2; axis++) {
    for (int i = 0; i < 2; i++) h.linear[axis][i] = (double)image->jet.linear[axis][i];
    for (int i = 0; i < KZ_HIGHER_TERMS; i++) h.higher_terms[axis][i] = (double)image->jet.higher_terms[axis][i];
  }
  return h;
}

void kz_hand_overs_make(const kz_images *images, double reach, kz_hand_over *hand_over) {
  for (int32_t level = 0; level < KZ_LEVELS; level++)
    hand_over[level] = hand_over_at(images, kz_level_rows + level, reach);
}

static double in_doubles(const double *linear, const double *b, double x, double y) {
  const double second = (b[0] * x + b[1] * y) * x + b[2] * y * y;
  const double third = (b[3] * x + b[4] * y) * x * x + (b[5] * x + b[6] * y) * y * y;
  return (linear[0] * x + linear[1] * y) + (second + third);
}

static __float128 in_quads(const __float128 *linear, const long double *b, __float128 x, __float128 y) {
  const __float128 second = (b[0] * x + b[1] * y) * x + b[2] * y * y;
  const __float128 third = (b[3] * x + b[4] * y) * x * x + (b[5] * x + b[6] * y) * y * y;
  return linear[0] * x + linear[1] * y + (second + third);
}

/* pair = centre + change, where the change is the smaller one. */
static void hand_over_add(const double centre[2], double change, double pair[2]) {
  const double rest = centre[1] + change;
  pair[0] = centre[0] + rest;
  pair[1] = rest - (pair[0] - centre[0]);
}

static void add_quad(const double centre[2], __float128 change, double pair[2]) {
  const __float128 sum = (centre[1] + change) + centre[0];
  pair[0] = (double)sum;
  pair[1] = (double)(sum - pair[0]);
}

void kz_hand_over_change(const kz_hand_over *h, double theta, double velocity, double change[2]) {
  for (int axis = 0; axis < 2; axis++)
    change[axis] = in_doubles(h->linear[axis], h->higher_terms[axis], theta, velocity);
}

void kz_hand_over_start(const kz_hand_over *h, __float128 theta, __float128 velocity, kz_start *start) {
  const kz_image *image = h->image;
  *start =
      (kz_start){.periods = h->periods, .error = {h->error * h->error, 0, h->error * h->error}, .turns = image->turns};
  if (h->in_quads) {
    add_quad(image->theta, in_quads(image->jet.linear[0], image->jet.higher_terms[0], theta, velocity), start->theta);
    add_quad(image->velocity, in_quads(image->jet.linear[1], image->jet.higher_terms[1], theta, velocity),
             start->velocity);
  } else {
    double change[2];
    kz_hand_over_change(h, (double)theta, (double)velocity, change);
    hand_over_add(image->theta, change[0], start->theta);
    hand_over_add(image->velocity, change[1], start->velocity);
  }
}
