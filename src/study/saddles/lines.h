/* Lines of starts that cross a window, and the cycles that show on them. */
#ifndef KAPITZA_STUDY_SADDLES_LINES_H
#define KAPITZA_STUDY_SADDLES_LINES_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* Lines of constant angle, or rows of constant velocity, all cut into as many pieces: a tile each. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_saddles_plan *plan;
  bool rows;
  kz_axis along, across;
  int64_t count, pieces;
} kz_lines;

/* Cycles as kz_dynamics_search_line gives them, each once, in the order of periods and speeds; cycle is to be freed. */
typedef struct {
  int64_t count;
  double *cycle;
} kz_found;

size_t kz_cycle_bytes(const kz_saddles_plan *plan);
/* What one piece may give. */
size_t kz_piece_bytes(const kz_saddles_plan *plan);

/* Those of a round = 0 ..: rows, lines of constant angle, then both twice as near, and so on. */
kz_lines kz_lines_of(const kz_pendulum *pendulum, const kz_saddles_plan *plan, int round);
/* One piece, found [kz_piece_bytes]: kz_dynamics_search_line. */
int64_t kz_lines_search(const kz_lines *lines, int64_t tile, int64_t most_starts, double *found, int64_t work[2]);
/* All pieces: what they show joins the cycles of rank 0. Collective; kept. */
kz_status kz_lines_run(const kz_run *run, const kz_lines *lines, const char *name, kz_found *found);

#endif
