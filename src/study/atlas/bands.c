/* Narrow bands of attractors: a cycle is born on one curve and loses its stability on another one close by. Where one
 * of the two is missing, the other one would begin or end an attractor in all of the plane. */
#include "lines.h"

/* Sides of the plane: narrowest band with one edge; largest distance of edges in widths; error of a crossing. */
static const double NARROW = 1e-5, REACH = 4, BLURRED = 1e-5;

/* In a narrow band the map is Henon's, x' = a - x^2 - D x_before, with the determinant D. A pair of cycles is born with
 * the trace 1 + D, and the trace falls by 2 sqrt(a) to
 * -(1 + D) while a grows by (1 + D)^2. There it falls by 1/(1 + D) for each a, and the fold's coefficient times its
 * gradient is 1/(1 - D)^2. So both edges give the width. */
double kz_atlas_band(const kz_cycle_kind *kind, double d, double form, double gradient) {
  const double ratio = (1 + d) / (1 - d);
  return kind->multiplier > 0 ? ratio * ratio / (gradient * fabs(form)) : (1 + d) / gradient;
}

/* The other edge of a band: an unpaired one on its attractors' side, or a little beyond; -1 = none. */
static int64_t edge_of(const kz_atlas_crossings *crossings, const bool *paired, int64_t i) {
  const kz_atlas_crossing *from = crossings->list + i;
  for (int side = from->change, tried = 0; tried < 2; side = -side, tried++)
    for (int64_t j = i + side; j >= 0 && j < crossings->count; j += side) {
      const kz_atlas_crossing *to = crossings->list + j;
      if (fabs(to->at - from->at) > BLURRED + (tried == 0 ? REACH * from->width : 0)) break;
      if (!paired[j] && to->class == from->class && to->change == -from->change) return j;
    }
  return -1;
}

int kz_atlas_compare_crossings(const void *first, const void *second) {
  const kz_atlas_crossing *a = first, *b = second;
  if (a->at != b->at) return a->at < b->at ? -1 : 1;
  if (a->curve != b->curve) return a->curve < b->curve ? -1 : 1;
  return a->row != b->row ? (a->row < b->row ? -1 : 1) : a->class - b->class;
}

void kz_atlas_pair(kz_atlas_crossings *crossings) {
  KZ_AUTOFREE bool *paired = kz_calloc((size_t)crossings->count + 1, sizeof *paired);
  int64_t left = 0;
  for (int64_t i = 0; i < crossings->count; i++) {
    if (paired[i] || crossings->list[i].width >= NARROW) continue;
    const int64_t other = edge_of(crossings, paired, i);
    if (other < 0) continue;
    paired[i] = paired[other] = true;
    if ((other - i) * crossings->list[i].change > 0) continue;
    const double at = crossings->list[i].at; /* the error of both is larger than the band */
    crossings->list[i].at = crossings->list[other].at;
    crossings->list[other].at = at;
  }
  for (int64_t i = 0; i < crossings->count; i++)
    if (paired[i] || crossings->list[i].width >= NARROW) crossings->list[left++] = crossings->list[i];
  crossings->count = left;
  if (left > 0) qsort(crossings->list, (size_t)left, sizeof *crossings->list, kz_atlas_compare_crossings);
}
