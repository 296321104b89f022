/* Which cells a parallelogram meets. Rounding moves its corners by some 1e-11 cells, and a place on an edge by at most the length of
 * the edge over its rise, below LARGEST / FLAT, times the last place of a row's number, 1e-12: SLACK is more. */
#include <math.h>

#include "proof.h"

static const double SLACK = 1e-5, FLAT = 1e-3, LARGEST = 100; /* cells; LARGEST: of an image, from its centre */

kz_parallelogram kz_proof_image(const kz_proof *proof, const kz_enclosure *set) {
  double half[2];
  kz_proof_half_cell(proof, half);
  kz_parallelogram image;
  const double centre[2] = {set->theta + M_PI, set->velocity + proof->top};
  for (int i = 0; i < 2; i++) {
    image.centre[i] = centre[i] / (2 * half[i]);
    image.a[i] = set->matrix[i][0] * set->reach[0] / (2 * half[i]);
    image.b[i] = set->matrix[i][1] * set->reach[1] / (2 * half[i]);
  }
  return image;
}

bool kz_proof_within(const kz_proof *proof, const kz_parallelogram *image) {
  const double x = fabs(image->a[0]) + fabs(image->b[0]), y = fabs(image->a[1]) + fabs(image->b[1]) + SLACK;
  return x + y < LARGEST && 2 * (x + 1) < (double)proof->columns && image->centre[1] - y >= 0 &&
         image->centre[1] + y <= (double)proof->rows;
}

/* The range of x that an edge has between y = low and y = high widens from .. to. */
static void clip_edge(const double a[2], const double b[2], double low, double high, double *from, double *to) {
  const double rise = b[1] - a[1];
  double s = 0, t = 1;
  if (fmax(a[1], b[1]) < low || fmin(a[1], b[1]) > high) return;
  if (fabs(rise) > FLAT) {
    s = fmin(fmax(((rise > 0 ? low : high) - a[1]) / rise, 0), 1);
    t = fmin(fmax(((rise > 0 ? high : low) - a[1]) / rise, 0), 1);
  }
  const double x[2] = {a[0] + s * (b[0] - a[0]), a[0] + t * (b[0] - a[0])};
  *from = fmin(*from, fmin(x[0], x[1]));
  *to = fmax(*to, fmax(x[0], x[1]));
}

static uint8_t label_of(const kz_proof *proof, int64_t row, int64_t column) {
  const int64_t n = proof->columns;
  return proof->label[row * n + ((column % n) + n) % n];
}

/* Have the cells `from` .. `to` of a row, around the circle, all the label? */
static bool row_has(const kz_proof *proof, int64_t row, int64_t from, int64_t to, uint8_t label) {
  for (int64_t i = from; i <= to; i++)
    if (label_of(proof, row, i) != label) return false;
  return true;
}

static void set_corners(const kz_parallelogram *p, double corner[5][2]) {
  static const int side[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
  for (int c = 0; c < 5; c++)
    for (int i = 0; i < 2; i++) corner[c][i] = p->centre[i] + side[c][0] * p->a[i] + side[c][1] * p->b[i];
}

uint8_t kz_proof_cover(const kz_proof *proof, const kz_parallelogram *p) {
  const int64_t top = proof->rows - 1, middle = (int64_t)fmin(floor(p->centre[1]), (double)top);
  const uint8_t label = label_of(proof, middle, (int64_t)floor(p->centre[0]));
  if (label == 0) return 0;
  double corner[5][2];
  set_corners(p, corner);
  const double y = fabs(p->a[1]) + fabs(p->b[1]) + SLACK;
  const int64_t first = (int64_t)fmax(floor(p->centre[1] - y), 0), last = (int64_t)fmin(floor(p->centre[1] + y), (double)top);
  for (int64_t row = first; row <= last; row++) {
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (int i = 0; i < 4; i++) clip_edge(corner[i], corner[i + 1], (double)row - SLACK, (double)(row + 1) + SLACK, &from, &to);
    if (from <= to && !row_has(proof, row, (int64_t)floor(from - SLACK), (int64_t)floor(to + SLACK), label)) return 0;
  }
  return label;
}

uint8_t kz_proof_at(const kz_proof *proof, double theta, double velocity) {
  const kz_enclosure point = {.theta = remainder(theta, 2 * M_PI), .velocity = velocity};
  const kz_parallelogram image = kz_proof_image(proof, &point);
  return kz_proof_within(proof, &image) ? kz_proof_cover(proof, &image) : 0;
}
