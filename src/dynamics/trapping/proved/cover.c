/* Cells that a parallelogram meets. Rounding moves its corners by some 1e-11 cells, and a place on an edge by at most
 * the length of the edge over its rise, below LARGEST / FLAT, times the last place of a row's number, 1e-12: SLACK is
 * more. */
#include "proof.h"

static const double SLACK = 1e-5, FLAT = 1e-3, LARGEST = 100; /* cells; LARGEST: of an image, from its centre */

/* A parallelogram in units of cells: centre + a p + b q, |p|, |q| <= 1; x from theta = -pi, y from velocity = -top. */
typedef struct {
  double centre[2], a[2], b[2];
} parallelogram;

/* A parallelogram that contains a set. */
static parallelogram image_of(const kz_proof *proof, const kz_enclosure *set) {
  double half[2];
  kz_proof_half_cell(proof, half);
  parallelogram image;
  const double centre[2] = {set->theta[0] + M_PI, set->velocity[0] + proof->top};
  for (int i = 0; i < 2; i++) {
    image.centre[i] = centre[i] / (2 * half[i]);
    image.a[i] = set->matrix[i][0] * set->reach[0] / (2 * half[i]);
    image.b[i] = set->matrix[i][1] * set->reach[1] / (2 * half[i]);
  }
  return image;
}

/* False if a parallelogram is too large to be covered by cells, or reaches beyond the grid's velocities. */
static bool is_within(const kz_proof *proof, const parallelogram *image) {
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

/* Whether the cells `from` .. `to` of a row, around the circle, all have the label. */
static bool row_has(const kz_proof *proof, int64_t row, int64_t from, int64_t to, uint8_t label) {
  for (int64_t i = from; i <= to; i++)
    if (label_of(proof, row, i) != label) return false;
  return true;
}

static void set_corners(const parallelogram *p, double corner[5][2]) {
  static const int side[5][2] = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}};
  for (int c = 0; c < 5; c++)
    for (int i = 0; i < 2; i++) corner[c][i] = p->centre[i] + side[c][0] * p->a[i] + side[c][1] * p->b[i];
}

/* One that meets four cells at most: these have the same label. */
static uint8_t cover_small(const kz_proof *proof, const parallelogram *p, double x, double y) {
  const double top = (double)(proof->rows - 1);
  const int64_t left = (int64_t)floor(p->centre[0] - x), right = (int64_t)floor(p->centre[0] + x);
  const int64_t low = (int64_t)fmax(floor(p->centre[1] - y), 0), high = (int64_t)fmin(floor(p->centre[1] + y), top);
  const uint8_t label = label_of(proof, low, left);
  const bool one = label == label_of(proof, low, right) && label == label_of(proof, high, left) &&
                   label == label_of(proof, high, right);
  return one ? label : 0;
}

/* The attractor of all cells that a parallelogram within the grid touches; 0 if they do not have the same one. */
static uint8_t cover_overlap(const kz_proof *proof, const parallelogram *p) {
  const double width = fabs(p->a[0]) + fabs(p->b[0]) + 2 * SLACK, height = fabs(p->a[1]) + fabs(p->b[1]) + 2 * SLACK;
  if (width < 0.5 && height < 0.5) return cover_small(proof, p, width, height);
  const int64_t top = proof->rows - 1, middle = (int64_t)fmin(floor(p->centre[1]), (double)top);
  const uint8_t label = label_of(proof, middle, (int64_t)floor(p->centre[0]));
  if (label == 0) return 0;
  double corner[5][2];
  set_corners(p, corner);
  const double y = fabs(p->a[1]) + fabs(p->b[1]) + SLACK;
  const int64_t first = (int64_t)fmax(floor(p->centre[1] - y), 0),
                last = (int64_t)fmin(floor(p->centre[1] + y), (double)top);
  for (int64_t row = first; row <= last; row++) {
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (int i = 0; i < 4; i++)
      clip_edge(corner[i], corner[i + 1], (double)row - SLACK, (double)(row + 1) + SLACK, &from, &to);
    if (from <= to && !row_has(proof, row, (int64_t)floor(from - SLACK), (int64_t)floor(to + SLACK), label)) return 0;
  }
  return label;
}

bool kz_ellipse_holds(const kz_proof_ellipse *ellipse, const double centre[2], const kz_enclosure *set) {
  for (int corner = 0; corner < 4; corner++) {
    const double y[2] = {corner % 2 ? set->reach[0] : -set->reach[0], corner / 2 ? set->reach[1] : -set->reach[1]};
    const double x[2] = {
        remainder(set->theta[0] - centre[0], 2 * M_PI) + set->matrix[0][0] * y[0] + set->matrix[0][1] * y[1],
        set->velocity[0] - centre[1] + set->matrix[1][0] * y[0] + set->matrix[1][1] * y[1]};
    double z[2];
    kz_proof_solve(ellipse->axes, x, z);
    if (!(hypot(z[0], z[1]) < ellipse->radius * (1 - KZ_PROOF_ROUNDING))) return false;
  }
  return true;
}

uint8_t kz_proof_holds(const kz_proof *proof, const kz_enclosure *set) {
  const parallelogram image = image_of(proof, set);
  const uint8_t label = is_within(proof, &image) ? cover_overlap(proof, &image) : 0;
  for (int i = 0; label == 0 && i < proof->n_parts; i++) {
    const kz_proof_part *part = &proof->part[i];
    if (fabs(set->velocity[0] - part->centre[1]) < part->half[1] && kz_ellipse_holds(&part->ellipse, part->centre, set))
      return part->number;
  }
  return label;
}
