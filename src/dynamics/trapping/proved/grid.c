/* The grid of a proof: cells of the strobe plane, each open or proved to end on an attractor. */
#include "proof.h"

kz_status kz_proof_create(const kz_pendulum *pendulum, int64_t columns, int64_t rows, double top, double fastest,
                          kz_proof **proof) {
  kz_proof *made = *proof = kz_calloc(1, sizeof *made);
  made->columns = columns;
  made->rows = rows;
  made->top = top;
  made->mirrored = kz_is_mirrored(pendulum);
  made->beta = pendulum->beta;
  made->label = kz_calloc((size_t)(columns * rows), sizeof *made->label);
  const double most = fmax(top, fastest) + 1.5 * kz_stiffness(pendulum);
  for (int32_t precision = 0; precision < KZ_ENCLOSURES; precision++)
    KZ_TRY(kz_enclosure_tables_create(pendulum, precision, most, &made->tables[precision]));
  return KZ_OK;
}

void kz_proof_free(kz_proof *proof) {
  if (!proof) return;
  for (int p = 0; p < KZ_ENCLOSURES; p++) kz_enclosure_tables_free(proof->tables[p]);
  free(proof->label);
  free(proof);
}

void kz_proof_half_cell(const kz_proof *proof, double half[2]) {
  half[0] = M_PI / (double)proof->columns;
  half[1] = proof->top / (double)proof->rows;
}

void kz_proof_centre(const kz_proof *proof, int64_t f, double state[2]) {
  double half[2];
  kz_proof_half_cell(proof, half);
  state[0] = (double)(2 * (f % proof->columns) + 1 - proof->columns) * half[0];
  state[1] = (double)(2 * (f / proof->columns) + 1 - proof->rows) * half[1];
}

int64_t kz_proof_own(const kz_proof *proof) {
  return proof->columns * proof->rows / (proof->mirrored ? 2 : 1);
}

int64_t kz_proof_adopt(kz_proof *proof, const uint8_t *label, const uint8_t mirror[KZ_PROOF_MOST + 1]) {
  const int64_t own = kz_proof_own(proof);
  int64_t added = 0;
  for (int64_t f = 0; f < own; f++) {
    added += label[f] != 0 && proof->label[f] == 0;
    proof->label[f] = label[f];
    if (proof->mirrored) proof->label[2 * own - 1 - f] = mirror[label[f]];
  }
  return added;
}

/* The corner of cell f that is farthest from the centre of an ellipse, in its norm. */
static double farthest_corner(const kz_proof *proof, int64_t f, const kz_proof_part *part) {
  double half[2], cell[2], farthest = 0;
  kz_proof_half_cell(proof, half);
  kz_proof_centre(proof, f, cell);
  for (int corner = 0; corner < 4; corner++) {
    const double x[2] = {remainder(cell[0] - part->centre[0], 2 * M_PI) + (corner % 2 ? half[0] : -half[0]),
                         cell[1] - part->centre[1] + (corner / 2 ? half[1] : -half[1])};
    double z[2];
    kz_proof_solve(part->ellipse.axes, x, z);
    farthest = fmax(farthest, hypot(z[0], z[1]));
  }
  return farthest;
}

void kz_proof_draw(kz_proof *proof, const kz_proof_part *part) {
  const int64_t cells = proof->columns * proof->rows;
  for (int64_t f = 0; f < cells; f++)
    if (proof->label[f] == 0 && farthest_corner(proof, f, part) < part->ellipse.radius * (1 - KZ_PROOF_ROUNDING))
      proof->label[f] = part->number;
}
