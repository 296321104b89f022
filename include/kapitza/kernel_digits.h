/* kernel: orbits in any number of digits (C; layer 0). */
#pragma once

#include "kapitza/kernel.h"
#include "kapitza/model_release.h"

/* Whole drive periods in any number of digits, by Taylor series. Beside the orbit of a centre they can carry its neighbourhood: the images
 * of the starts centre + (x, y) as polynomials of degree 3 in x and y. The numbers are those of FLINT (Arb). */

/* The fewest and the most bits behind the binary point. */
enum { KZ_FEWEST_BITS = 116, KZ_MOST_BITS = 40000 };

/* Writes the coordinate as decimal text, with at least `digits` right digits behind the point, to text [size]. KZ_FAILED if it does not fit. */
kz_status kz_coordinate_text(const kz_coordinate *coordinate, int64_t digits, char *text, size_t size);
/* a - b, with an error of at most 2^-bits, or of the rounding to a quad. */
__float128 kz_coordinate_difference(const kz_coordinate *a, const kz_coordinate *b, int64_t bits);

/* The neighbourhood of an orbit: the coefficients of x, y (linear) and of xx, xy, yy, xxx, xxy, xyy, yyy (bent), for the angle [0] and the
 * velocity [1]. `linear` is right to 33 digits, or to 17 if only the first degree is carried; `bent` is right to 17. */
enum { KZ_HIGHER_TERMS = 7 };
typedef struct {
  __float128 linear[2][2];
  long double higher_terms[2][KZ_HIGHER_TERMS];
} kz_jet;

/* A state in many digits. Opaque; free with kz_arbitrary_free. It has at most `bits` bits behind the point, to which the start is rounded. */
typedef struct kz_arbitrary kz_arbitrary;
kz_arbitrary *kz_arbitrary_create(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits);
void kz_arbitrary_free(kz_arbitrary *orbit);
/* The orbit begins at a release, whose phase and ramp count as exact; else at a strobe of the final drive. To be called before it advances. */
void kz_arbitrary_release(kz_arbitrary *orbit, const kz_release *release);

/* Advances the orbit to the next strobe, through one drive period but for a release, with `bits` bits behind the point, at least KZ_FEWEST_BITS. *jet becomes the neighbourhood at
 * its end up to `degree` 1 or 3; with degree 0 jet may be NULL. The period adds an error of some 2^-bits; errors of earlier periods grow
 * with the motion. KZ_FAILED if the motion is too fast for 2^14 steps a period. */
kz_status kz_arbitrary_advance(kz_arbitrary *orbit, int64_t bits, int degree, kz_jet *jet);

/* The same orbit on a line of starts: start + x * width, where `width` is that of each coordinate. It keeps its tangent itself, to
 * `tangent_bits` as long as its own bits are as many, and *jet becomes its neighbourhood in x; y is not used. */
kz_arbitrary *kz_arbitrary_on_line(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits,
                                   int64_t tangent_bits, kz_jet *jet);
/* Keeps the present state and tangent of an orbit on a line as its mark; at first that is its start. */
void kz_arbitrary_mark(kz_arbitrary *orbit);
/* The orbit on a line that begins at the mark of `orbit`, at x = share of the line that its neighbourhood then was; the new line's x is
 * counted from there in units of 2^exponent. at_mark: the jet of that time. The caller frees it, like any orbit. */
kz_arbitrary *kz_arbitrary_beside(const kz_arbitrary *orbit, const kz_jet *at_mark, __float128 share, int exponent,
                                  int64_t bits, int64_t tangent_bits, kz_jet *jet);

/* The state as pairs of doubles, high + low: theta in rad, in [-pi, pi] without whole turns; velocity in rad per drive radian. */
void kz_arbitrary_read(const kz_arbitrary *orbit, double theta[2], double velocity[2]);
/* Net turns by which its angle on the line, from the release on, is more than that which is read. */
int64_t kz_arbitrary_turns(const kz_arbitrary *orbit);

/* The exact state as text [kz_arbitrary_size], for a checkpoint, and back. KZ_FAILED if the text is not such a state. */
size_t kz_arbitrary_size(const kz_arbitrary *orbit);
void kz_arbitrary_write(const kz_arbitrary *orbit, char *text);
kz_status kz_arbitrary_restore(kz_arbitrary *orbit, const char *text);
