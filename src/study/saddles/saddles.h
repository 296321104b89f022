/* Study `saddles`: lines of starts that cross a window, and the search for cycles along them; all known cycles of the
 * strobe map up to a period, attracting or not, and their index sums. */
#pragma once

#include "kapitza/dynamics_saddles.h"
#include "labelling/catalogue.h"
#include "labelling/listed.h"
#include "plan.h"

/* Cycles of a piece at most, those found repeatedly counted again. */
enum { KZ_CYCLES_OF_A_PIECE = 16384 };

/* Lines of constant angle, or rows of constant velocity; each is cut into `pieces` pieces, and a piece is a tile. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_saddles_plan *plan;
  bool rows;
  kz_axis along, across;
  int64_t count, pieces, cells; /* cells: of a piece */
  double steepest;              /* Limit of the trace in kz_dynamics_search_line */
} kz_lines;

/* Cycles as kz_dynamics_search_line has them, once each, by period and speed. The caller frees `cycle`. */
typedef struct {
  int64_t count;
  double *cycle;
} kz_found;

size_t kz_cycle_bytes(const kz_saddles_plan *plan);
/* Largest number of bytes that one piece can give. */
size_t kz_piece_bytes(const kz_saddles_plan *plan);

/* The lines of a round 0, 1, ...: rows, lines of constant angle, then both with half the distance, and so on. */
kz_lines kz_lines_of(const kz_pendulum *pendulum, const kz_saddles_plan *plan, int round);
/* Searches one piece by kz_dynamics_search_line: found [kz_piece_bytes], work [2]; returns the number of cycles,
 * KZ_CYCLES_OF_A_PIECE + 1 if there are more. */
int64_t kz_lines_search(const kz_lines *lines, int64_t tile, int64_t most_starts, double *found, int64_t work[2]);
/* Searches all pieces in a kept stage and adds their cycles to *found on rank 0. Collective. */
kz_status kz_lines_run(const kz_run *run, const kz_lines *lines, const char *name, kz_found *found);

/* A rough estimate of the number of cycles, which grows exponentially with the period. Fig. 12 has 16, 16 and 24 of up
 * to 3, 4 and 6 periods, epsilon = 1 and 3 have 146 and 888 of up to 3: right to a factor of 4. */
double kz_saddles_expected(const kz_scene *scene);
