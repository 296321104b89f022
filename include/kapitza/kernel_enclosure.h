/* Sets of states through a drive period, with bounds on every error (C, part of the kernel). */
#pragma once

#include "kapitza/model.h"

/* Precisions of enclosures, sets of states that are proved to contain the true motion of exactly the given pendulum:
 * they include every error of the method and every rounding (docs/explanation/proof.md). Taylor polynomials have order
 * 22 in doubles, 40 in sums of two and of three doubles. */
enum { KZ_ENCLOSE_DOUBLES, KZ_ENCLOSE_PAIRS, KZ_ENCLOSE_TRIPLES, KZ_ENCLOSURES };

/* The set of all states centre + matrix z with |z[i]| <= reach[i]; INFINITY if it could not be followed (lost). */
typedef struct {
  double theta[3], velocity[3]; /* Centre, each a sum of three doubles: rad, rad per drive radian */
  double matrix[2][2];          /* Rows: theta, velocity */
  double reach[2];
  double jacobian_error[2][2]; /* Bounds under KZ_KEEP_FRAME */
} kz_enclosure;

/* The matrix of a set after each period. KZ_NEW_FRAME: a rotation, which keeps a set small that is followed for long.
 * KZ_KEEP_FRAME: the tangent map times the matrix of the start; z is then a function of its value z0 at the start,
 * |z[i] - z0[i]| is at most the growth of reach[i], and |dz[i]/dz0[j] - (i == j)| at most jacobian_error[i][j]. */
typedef enum { KZ_NEW_FRAME, KZ_KEEP_FRAME } kz_enclosure_frame;

/* Makes tables for sets whose centres are at most as fast as `fastest` (rad per drive radian) at the beginning of each
 * step; faster sets are lost. Returns KZ_REFUSED, without a message, if this needs more than 4096 steps per period. */
typedef struct kz_enclosure_tables kz_enclosure_tables;
kz_status kz_enclosure_tables_create(const kz_pendulum *pendulum, int32_t precision, double fastest,
                                     kz_enclosure_tables **tables);
void kz_enclosure_tables_free(kz_enclosure_tables *tables);

/* Advances set [n] through one drive period and removes whole turns. Sets are independent; hundreds are fastest. */
void kz_enclosures_advance(const kz_enclosure_tables *tables, kz_enclosure_frame frame, int64_t n, kz_enclosure *set);

/* Bounds of the force for enclosures, right up to rounding in extended precision. kz_force_sizes: sizes [n] bound the
 * Taylor coefficients of h (a(t) sin - b(t) cos - torque(t)) in t/h, for a step of length h that begins at any t.
 * kz_force_majorant: the largest force at complex times with |Im t| <= r.
 * kz_force_largest: the largest force during step i of length h, counted from t = 0. */
void kz_force_sizes(const kz_pendulum *pendulum, long double h, int32_t n, long double *sizes);
long double kz_force_majorant(const kz_pendulum *pendulum, long double r);
long double kz_force_largest(const kz_pendulum *pendulum, int32_t i, long double h);
