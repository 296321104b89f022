#include "picture.h"

#include "kapitza/common.h"

/* Squares of distances along one line: least over j of f[j] + ((i - j) step)^2, the lower envelope of parabolas. place,
 * border: buffers [n], [n + 1]. */
static void picture_envelope(int64_t n, double step, const double *f, double *least, int64_t *place, double *border) {
  int64_t k = -1;
  for (int64_t j = 0; j < n; j++) {
    if (isinf(f[j])) continue;
    double from = -INFINITY;
    for (; k >= 0; k--) {
      const double at = (double)j * step, before = (double)place[k] * step;
      from = (f[j] + at * at - f[place[k]] - before * before) / (2 * (at - before));
      if (from > border[k]) break;
      from = -INFINITY;
    }
    place[++k] = j;
    border[k] = from;
  }
  for (int64_t i = 0, part = 0; i < n; i++) {
    if (k < 0) {
      least[i] = INFINITY;
      continue;
    }
    while (part < k && border[part + 1] <= (double)i * step) part++;
    const double away = (double)(i - place[part]) * step;
    least[i] = f[place[part]] + away * away;
  }
}

/* Lines of a picture, of a circle with a copy on each side. */
typedef struct {
  double *f, *least, *border;
  int64_t *place;
} line;

static void picture_make(int64_t n, line *l) {
  l->f = kz_malloc((size_t)n * sizeof(double));
  l->least = kz_malloc((size_t)n * sizeof(double));
  l->border = kz_malloc((size_t)n * sizeof(double));
  l->place = kz_malloc((size_t)n * sizeof(int64_t));
}

static void picture_release(line *l) {
  kz_free_local(&l->f);
  kz_free_local(&l->least);
  kz_free_local(&l->border);
  kz_free_local(&l->place);
}

/* Replaces n values, `stride` apart, by the squares of the distances along the line. */
static void picture_along(line *l, int64_t n, int64_t stride, double step, bool circle, double *value) {
  const int64_t pad = circle ? n : 0, all = n + 2 * pad;
  for (int64_t i = 0; i < all; i++) l->f[i] = value[i % n * stride];
  picture_envelope(all, step, l->f, l->least, l->place, l->border);
  for (int64_t i = 0; i < n; i++) value[i * stride] = l->least[i + pad];
}

/* The distance of the centre of cell i of n from the nearer end of its line. */
static double end_distance(int64_t i, int64_t n, double step) {
  return ((double)(i < n - 1 - i ? i : n - 1 - i) + 0.5) * step;
}

void kz_picture_distances(const kz_picture *picture, int16_t id, double *distance) {
  const int64_t columns = picture->columns, rows = picture->rows, longest = kz_larger(columns, rows);
  const double half = fmin(picture->across, picture->up) / 2;
  KZ_AUTOFREE_BY(picture_release) line l;
  picture_make(3 * longest, &l);
  for (int64_t i = 0; i < columns * rows; i++) distance[i] = picture->id[i] == id ? INFINITY : 0;
  for (int64_t column = 0; column < columns; column++)
    picture_along(&l, rows, columns, picture->up, false, distance + column);
  for (int64_t row = 0; row < rows; row++)
    picture_along(&l, columns, 1, picture->across, picture->circle, distance + row * columns);
  for (int64_t i = 0; i < columns * rows; i++) {
    double edge = end_distance(i / columns, rows, picture->up);
    if (!picture->circle) edge = fmin(edge, end_distance(i % columns, columns, picture->across));
    distance[i] = distance[i] > 0 ? fmin(sqrt(distance[i]) - half, edge) : 0;
  }
}
