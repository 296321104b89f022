/* The picture of labels as a grid: distances to other basins. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/* Labels of columns x rows cells, row by row; a step to the right is `across`, one up is `up`; circle: the columns
 * are periodic. Beyond its other edges nothing is known: circles end there. */
typedef struct {
  int64_t columns, rows;
  double across, up;
  bool circle;
  const int16_t *id;
} kz_picture;

/* distance [rows][columns]: from each cell's centre to the nearest cell that is not of the basin `id`, right to half
 * a cell: the distance to its centre, less half of the smaller side of a cell; or to the edge of the picture, if
 * that is nearer; 0 outside of the basin (P. F. Felzenszwalb, D. P. Huttenlocher, Theory Comput. 8 (2012) 415). */
void kz_picture_distances(const kz_picture *picture, int16_t id, double *distance);
