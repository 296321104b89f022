/* Cells that are proved by following them: the set of a cell is advanced, period by period, until the region of one attractor holds it. */

#include "proof.h"

enum { LANES = 256, MOST_PERIODS = 16 };
static const double LARGEST = 0.5; /* of a set's sides, rad and rad per drive radian: no larger one gets small again */

/* Cells under way. */
typedef struct {
  int n;
  kz_enclosure set[LANES];
  int64_t cell[LANES];
  int periods[LANES];
} walk;

/* A cell, larger by more than the rounding of its corners. */
static kz_enclosure set_of(const kz_proof *proof, int64_t f) {
  double half[2], centre[2];
  kz_proof_half_cell(proof, half);
  kz_proof_centre(proof, f, centre);
  const double larger = 1 + KZ_PROOF_ROUNDING;
  return (kz_enclosure){
      .theta = {centre[0]}, .velocity = {centre[1]}, .matrix = {{1, 0}, {0, 1}}, .reach = {half[0] * larger, half[1] * larger}};
}

/* Cell i of the walk after one more period: its attractor, 0 = none yet; *over: it is not followed any further. */
static uint8_t look(const kz_proof *proof, walk *w, int i, bool *over) {
  *over = true;
  if (!(w->set[i].reach[0] < LARGEST && w->set[i].reach[1] < LARGEST)) return 0;
  const uint8_t found = kz_proof_holds(proof, &w->set[i]);
  *over = found != 0 || ++w->periods[i] == MOST_PERIODS;
  return found;
}

static void remove_cell(walk *w, int i) {
  w->n--;
  w->cell[i] = w->cell[w->n];
  w->set[i] = w->set[w->n];
  w->periods[i] = w->periods[w->n];
}

void kz_proof_cells(const kz_proof *proof, int64_t first, int64_t n, uint8_t *label) {
  walk w = {.n = 0};
  for (int64_t next = 0; next < n || w.n > 0;) {
    for (; next < n && w.n < LANES; next++) {
      label[next] = proof->label[first + next];
      if (label[next] != 0) continue;
      w.set[w.n] = set_of(proof, first + next);
      w.periods[w.n] = 0;
      w.cell[w.n++] = next;
    }
    kz_enclosures_advance(proof->tables[KZ_ENCLOSE_DOUBLES], KZ_NEW_FRAME, w.n, w.set);
    for (int i = w.n - 1; i >= 0; i--) {
      bool over;
      label[w.cell[i]] = look(proof, &w, i, &over);
      if (over) remove_cell(&w, i);
    }
  }
}
