/* A labelled grid as counts, which are added up over its tiles: basin entropy (A. Daza et al., Sci. Rep. 6 (2016)
 * 31416) and uncertain shares at distances (C. Grebogi et al., Phys. Lett. A 99 (1983) 415). */
#pragma once

#include "kapitza/store.h"

enum { KZ_BOX = 5 }; /* cells along an edge of a box of the basin entropy */
enum { KZ_DISTANCES = 8, KZ_BOX_CELLS = KZ_BOX * KZ_BOX };

/* All fields are int64_t, so that kz_ranks_sum can add them. */
typedef struct {
  int64_t evidence[KZ_MAX_FLAGS];       /* [code]: cells of which the file has this evidence */
  int64_t unsettled, doubtful, changed; /* cells; unsettled: without id; doubtful: without mirror images; changed:
                                         * decided ones to which a part of the study has given another label */
  int64_t boxes[KZ_BOX_CELLS + 1];      /* [i]: boxes with i settled cells */
  int64_t parts[KZ_BOX_CELLS + 1][KZ_BOX_CELLS + 1]; /* [i][j]: attractors that have j cells of such a box */
  int64_t compared[KZ_DISTANCES],
      uncertain[KZ_DISTANCES]; /* [d]: cells compared with those 2^d columns away; those that differ */
} kz_counts;

/* Add boxes of 5 x 5 cells of label [rows][columns], from its first row and column on (smaller ones at the last),
 * and pairs of cells along its rows; circle = theta is periodic. Unsettled cells (-1) are left out, and so are boxes
 * with no other cells. */
void kz_count_boxes(int64_t columns, int64_t rows, const int16_t *deep_label, kz_counts *counts);
void kz_count_pairs(int64_t columns, int64_t rows, const int16_t *deep_label, bool circle, kz_counts *counts);

/* Mean Gibbs entropy (natural logarithm) of all boxes, and of those with more than one label; 0 if there are none. */
void kz_entropy_of(const kz_counts *counts, double *entropy, double *boundary_entropy);
/* Share of the compared cells that are uncertain at distance 2^d columns; 0 if none was compared. */
double kz_uncertain_share(const kz_counts *counts, int d);
