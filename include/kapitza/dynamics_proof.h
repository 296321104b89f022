/* dynamics: starts that are proved to end on an attractor (C; layer 1). */
#pragma once

#include "kapitza/kernel_enclosure.h"

/* Proofs of where starts end under the true flow, by the enclosures of kernel_enclosure.h (docs/explanation/proof.md).
 * The proved region consists of ellipses that contract onto a cycle, and of cells of a grid over the whole circle and
 * velocities from -top to top. For mirrored pendulums the second half of the grid is the mirror image of the first. A
 * cell joins the region if it is proved to reach the ellipses or cells that have joined before. A start is proved if
 * its enclosure reaches the region. Attractors have the numbers 1 .. KZ_PROOF_MOST; nothing here is collective. */
enum { KZ_PROOF_MOST = 254, KZ_PROOF_LATE = 255 };
typedef struct kz_proof kz_proof;

/* Makes a proof with an empty region; columns and rows of the grid are even. Starts may be as fast as `fastest` (rad
 * per drive radian). KZ_REFUSED, without a message, if `fastest` or `top` is too fast for enclosures. The caller frees
 * *proof in every case; it may be NULL. */
kz_status kz_proof_create(const kz_pendulum *pendulum, int64_t columns, int64_t rows, double top, double fastest,
                          kz_proof **proof);
void kz_proof_free(kz_proof *proof);

/* An ellipse around a strobe point: all states point + axes z with |z| <= radius. Radius 0 = no ellipse. */
typedef struct {
  double radius, axes[2][2];
} kz_proof_ellipse;
/* True if it is proved that the map of `period` drive periods carries the ellipse into itself and contracts it, so that
 * all its starts end on one cycle. */
bool kz_proof_traps(const kz_proof *proof, int64_t period, double theta, double velocity,
                    const kz_proof_ellipse *ellipse);
/* Largest ellipse at a strobe point (rad, rad per drive radian) whose starts are proved to end on a cycle of
 * `period`. */
kz_proof_ellipse kz_proof_find_ellipse(const kz_proof *proof, int64_t period, double theta, double velocity);
/* True if it is proved that the cycle of that period at the strobe point [2] is the mirror image of the one in an
 * ellipse around centre [2]; always without mirror symmetry, where nothing is mirrored. */
bool kz_proof_is_mirror(const kz_proof *proof, int64_t period, const double point[2], const double centre[2],
                        const kz_proof_ellipse *ellipse);
/* Adds the ellipse, with all cells inside, to the region of attractor `number`, and its image to that of `mirror` if
 * another. */
void kz_proof_add(kz_proof *proof, uint8_t number, uint8_t mirror, double theta, double velocity,
                  const kz_proof_ellipse *ellipse);

/* A published cycle: strobe points theta [period], velocity [period], Floquet multipliers multiplier_re, _im [2]. */
typedef struct {
  int64_t period;
  const double *theta, *velocity, *multiplier_re, *multiplier_im;
} kz_proof_cycle;
/* True if it is proved that exactly one attracting cycle lies within theta [period] and velocity [period] of the strobe
 * points, and that its multipliers differ from the published ones by at most multiplier [2]. These half-widths are the
 * output. */
bool kz_proof_confine(const kz_proof *proof, const kz_proof_cycle *cycle, double *theta, double *velocity,
                      double multiplier[2]);

/* Number of cells of the grid that are followed: its first half where the other one is the mirror image. */
int64_t kz_proof_own(const kz_proof *proof);
/* label [n] = attractors of the cells first .. first + n - 1, 0 = open. Open cells are followed through up to 16
 * periods, until the region of one attractor contains their image. The grid does not change. */
void kz_proof_cells(const kz_proof *proof, int64_t first, int64_t n, uint8_t *label);
/* Sets the grid from the labels of these cells; mirror [number] = number of the mirror image, mirror[0] = 0. Returns
 * how many cells joined. */
int64_t kz_proof_adopt(kz_proof *proof, const uint8_t *label, const uint8_t mirror[KZ_PROOF_MOST + 1]);
/* A start: theta and velocity as sums high + low, known to within `radius` (rad, and rad per drive radian). */
typedef struct {
  double theta[2], velocity[2], radius;
} kz_proof_start;
/* Follows n starts in one of the precisions KZ_ENCLOSE_DOUBLES, .. number [n] = the attractor on which a
 * start is proved to end; 0 = no proof because its enclosure has grown too large, so more digits may help;
 * KZ_PROOF_LATE = no proof within most_periods. */
void kz_proof_follow(const kz_proof *proof, int32_t precision, int64_t n, const kz_proof_start *start,
                     int64_t most_periods, uint8_t *number);
