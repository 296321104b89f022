/* Study `saddles`: lines of starts that cross a window, and the search for cycles along them; all known cycles of the strobe map up to a
 * period, attracting or not, and their index sums. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"
#include "labelling/catalogue.h"
#include "plan.h"

/* Lines of constant angle, or rows of constant velocity; each is cut into `pieces` pieces, and a piece is a tile. */
typedef struct {
  const kz_pendulum *pendulum;
  const kz_saddles_plan *plan;
  bool rows;
  kz_axis along, across;
  int64_t count, pieces;
  double shortest; /* rad: of kz_dynamics_search_line */
} kz_lines;

/* Cycles in the form of kz_dynamics_search_line, each once, in the order of periods and speeds. The caller frees `cycle`. */
typedef struct {
  int64_t count;
  double *cycle;
} kz_found;

size_t kz_cycle_bytes(const kz_saddles_plan *plan);
/* Largest number of bytes that one piece can give. */
size_t kz_piece_bytes(const kz_saddles_plan *plan);

/* The lines of a round 0, 1, ...: rows, lines of constant angle, then both with half the distance, and so on. */
kz_lines kz_lines_of(const kz_pendulum *pendulum, const kz_saddles_plan *plan, int round);
/* Searches one piece by kz_dynamics_search_line: found [kz_piece_bytes], work [2]; returns the number of cycles. */
int64_t kz_lines_search(const kz_lines *lines, int64_t tile, int64_t most_starts, double *found, int64_t work[2]);
/* Searches all pieces in a kept stage and adds their cycles to *found on rank 0. Collective. */
kz_status kz_lines_run(const kz_run *run, const kz_lines *lines, const char *name, kz_found *found);

/* All cycles, and those that do not attract, whose places are their ids; the latter share the strobe points of the former. */
typedef struct {
  kz_catalogue all, unstable;
} kz_cycle_list;

/* Lists the cycles that are known; the caller frees the list. */
void kz_cycle_list_make(const kz_dynamics *dynamics, kz_cycle_list *list);
void kz_cycle_list_free(kz_cycle_list *list);

/* The index of each fixed point of F^(n * period) on a cycle: the sign of (1 - mu1^n)(1 - mu2^n). */
int kz_cycle_index(const kz_attractor *cycle, int64_t n);

/* The fixed points of F^period with this winding: their number, and the sum of their indices. */
typedef struct {
  int32_t period, winding, points, index;
} kz_index_sum;
typedef struct {
  int64_t count, open; /* open: sums that are not 0 */
  kz_index_sum *entries;
} kz_index_sums;

/* Makes the sums for every period up to max_period and every winding of a known cycle; the caller frees them. The theorem is in
 * docs/explanation/theory.md. */
void kz_index_sums_make(const kz_cycle_list *list, int64_t max_period, kz_index_sums *sums);
void kz_index_sums_free(kz_index_sums *sums);

/* A rough estimate of the number of cycles, which grows exponentially with the period. Fig. 12 has 16, 16 and 24 of up to 3, 4 and 6 periods,
 * epsilon = 1 and 3 have 146 and 888 of up to 3: right to a factor of 4. */
double kz_saddles_expected(const kz_scene *scene);

/* KZ_REFUSED, at the keys "KEY|KEY", if a file has no unstable cycle with this id. */
kz_status kz_saddle_check(kz_store *store, const char *keys, int64_t saddle);

/* Writes the unstable cycles and the index sums to group /saddles. */
kz_status kz_saddles_write(const kz_cycle_list *cycles, const kz_index_sums *sums, kz_store *store);
/* Prints the cycles that were found, and the index sums. */
void kz_saddles_print(const kz_scene *scene, const kz_cycle_list *cycles, const kz_index_sums *sums, FILE *summary);
