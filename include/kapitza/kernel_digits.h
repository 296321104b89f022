/* Orbits in any number of digits, by Taylor series (C, part of the kernel). */
#pragma once

#include "kapitza/kernel.h"
#include "kapitza/model_release.h"

/* An orbit may carry its neighbourhood: images of starts beside its own by (x, y) as cubic polynomials in x and y. */

/* Least and largest number of bits behind the binary point. */
enum { KZ_FEWEST_BITS = 116, KZ_MOST_BITS = 40000 };

/* Writes the coordinate to text [size] with at least `digits` correct decimals; KZ_FAILED if it does not fit. */
kz_status kz_coordinate_text(const kz_coordinate *coordinate, int64_t digits, char *text, size_t size);
/* Returns a - b, with an error of at most 2^-bits or of the rounding to a quad. */
__float128 kz_coordinate_difference(const kz_coordinate *a, const kz_coordinate *b, int64_t bits);

/* The neighbourhood of an orbit: coefficients of x, y (linear) and of xx, xy, yy, xxx, xxy, xyy, yyy (higher_terms),
 * for the angle [0] and the velocity [1]. `linear` has 33 correct digits (17 if degree 1 alone is carried),
 * higher_terms 17. */
enum { KZ_HIGHER_TERMS = 7 };
typedef struct {
  __float128 linear[2][2];
  long double higher_terms[2][KZ_HIGHER_TERMS];
} kz_jet;

/* A state with at most `bits` bits behind the point, to which the start is rounded. Free with kz_arbitrary_free. */
typedef struct kz_arbitrary kz_arbitrary;
kz_arbitrary *kz_arbitrary_create(const kz_pendulum *pendulum, const kz_coordinate enclosures_start[2], int64_t bits);
void kz_arbitrary_free(kz_arbitrary *orbit);
/* Lets an orbit that has not advanced begin at a release, whose phase and ramp count as exact, not at a strobe. */
void kz_arbitrary_release(kz_arbitrary *orbit, const kz_release *release);

/* Advances the orbit to the next strobe (one drive period, except in the period of release) with `bits` bits behind the
 * point, at least KZ_FEWEST_BITS. *jet becomes the neighbourhood at its end up to `degree` 1 or 3; with degree 0 jet
 * may be NULL. The period adds an error of some 2^-bits; errors of earlier periods grow with the motion. Returns
 * KZ_FAILED if the motion is too fast for 2^14 steps per period. */
kz_status kz_arbitrary_advance(kz_arbitrary *orbit, int64_t bits, int degree, kz_jet *jet);

/* Makes an orbit on a line of starts, start + x * width of each coordinate. It keeps its tangent itself, to
 * `tangent_bits` as long as it has so many bits, and *jet becomes its neighbourhood in x; y is not used. */
kz_arbitrary *kz_arbitrary_on_line(const kz_pendulum *pendulum, const kz_coordinate start[2], int64_t bits,
                                   int64_t tangent_bits, kz_jet *jet);
/* Keeps the present state and tangent of an orbit on a line as its mark, which is its start at first. */
void kz_arbitrary_mark(kz_arbitrary *orbit);
/* Makes the orbit that begins at the mark of `orbit`, at x = share of its line; the new line's x is counted from there
 * in units of 2^exponent. at_mark: jet of `orbit` at its mark. The caller frees the result like any orbit. */
kz_arbitrary *kz_arbitrary_beside(const kz_arbitrary *orbit, const kz_jet *at_mark, __float128 share, int exponent,
                                  int64_t bits, int64_t tangent_bits, kz_jet *jet);

/* Reads the state as pairs of doubles, high + low: theta, rad, wrapped to [-pi, pi]; velocity, rad per drive radian. */
void kz_arbitrary_read(const kz_arbitrary *orbit, double theta[2], double velocity[2]);
/* Returns the net turns since the release, counterclockwise +, that kz_arbitrary_read leaves out. */
int64_t kz_arbitrary_turns(const kz_arbitrary *orbit);

/* Write the exact state as text [kz_arbitrary_size] for a checkpoint, and read it; KZ_FAILED: the text is no state. */
size_t kz_arbitrary_size(const kz_arbitrary *orbit);
void kz_arbitrary_write(const kz_arbitrary *orbit, char *text);
kz_status kz_arbitrary_restore(kz_arbitrary *orbit, const char *text);
