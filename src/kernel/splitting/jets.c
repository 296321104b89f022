/* The inner loop of a period with its derivatives (jets.f90), in the compilers' vector types: gfortran does not keep
 * the derivatives in registers and takes six times as long. */
#include <string.h>

#include "vector/vector.h"

enum { LANES = 4, KICKS = 14, FUSED = KICKS + 2 };
enum { X, Y, P, Q, XX, XY, YY, XP, YP, XQ, YQ, X3, XXY, XYY, Y3, TERMS };
typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t bits __attribute__((vector_size(8 * LANES)));

/* A kick a sin theta - b cos theta - push, and a drift: [0] is the value, [1], [2] are derivatives by p and q. */
typedef struct {
  double a[3], b[3], push[3];
} kz_kick;
typedef struct {
  double per_velocity[3], decay[3];
} kz_drift;
/* An angle (half-turns) or a velocity, and its derivatives in rad. */
typedef struct {
  lanes value, derivative[TERMS];
} jet;

/* sin(pi r)/r in powers of r^2: SINE_COEFFICIENTS of sine.f90, and cos(pi r) by its Taylor series; |r| <= 1/2. */
static const double SINE[] = {3.14159265358979323765,     -5.16771278004996952865,      2.55016403987729393818,
                              -0.599264529318738216301,   0.0821458865698926095193,     -0.00737043047876246099464,
                              0.000466299688773173555302, -0.0000219031854208053767726, 7.69472732830679049614e-7};
static const double COSINE[] = {1,
                                -4.934802200544679309417,
                                4.058712126416768218185,
                                -1.335262768854589495875,
                                0.2353306303588935102143,
                                -0.02580689139001406001260,
                                0.001929574309403923047903,
                                -0.0001046381049248457071180,
                                4.303069587032946659836e-6,
                                -1.387895246221377211449e-7,
                                3.604730797462501117270e-9};

/* Two terms of a polynomial in q (Estrin's scheme: half as many dependent operations as by Horner's rule). */
#define LINEAR(list, i) (q * (list)[(i) + 1] + (list)[i])

KZ_INLINE void sine_and_cosine(const lanes *angle, lanes *s, lanes *c) {
  const double round_to_integer = 0x1.8p52;
  const lanes u = *angle, shifted = u + round_to_integer, r = u - (shifted - round_to_integer), q = r * r;
  const lanes q2 = q * q, q4 = q2 * q2, q8 = q4 * q4;
  const bits sign = (bits)shifted << 63;
  const lanes odd =
      (q2 * LINEAR(SINE, 2) + LINEAR(SINE, 0)) + (q4 * (q2 * LINEAR(SINE, 6) + LINEAR(SINE, 4)) + q8 * SINE[8]);
  const lanes even = (q2 * LINEAR(COSINE, 2) + LINEAR(COSINE, 0)) +
                     (q4 * (q2 * LINEAR(COSINE, 6) + LINEAR(COSINE, 4)) + q8 * (q2 * COSINE[10] + LINEAR(COSINE, 8)));
  *s = (lanes)((bits)(r * odd) ^ sign);
  *c = (lanes)((bits)even ^ sign);
}

/* Adds to a derivative by a parameter the part that comes from the parameter's effect on the damping. */
#define ADD_DAMPING_TERM(term, parameter, speed)                                                         \
  do {                                                                                                   \
    angle->derivative[term] += row->per_velocity[parameter] * (speed) -                                  \
                               row->per_velocity[0] * (row->decay[parameter] / row->decay[0]) * (speed); \
    velocity->derivative[term] += (row->decay[parameter] / row->decay[0]) * (speed);                     \
  } while (0)

#define DRIFT_TERM(term)                                                          \
  do {                                                                            \
    angle->derivative[term] += row->per_velocity[0] * velocity->derivative[term]; \
    velocity->derivative[term] *= row->decay[0];                                  \
  } while (0)

/* Advances through a drift, term by term so that the compiler keeps them in registers. */
KZ_INLINE void drift_jet(int order, bool damped, const kz_drift *row, jet *angle, jet *velocity) {
  if (damped && order >= 1) {
    ADD_DAMPING_TERM(P, 1, velocity->value);
    ADD_DAMPING_TERM(Q, 2, velocity->value);
  }
  if (damped && order >= 2) {
    ADD_DAMPING_TERM(XP, 1, velocity->derivative[X]);
    ADD_DAMPING_TERM(YP, 1, velocity->derivative[Y]);
    ADD_DAMPING_TERM(XQ, 2, velocity->derivative[X]);
    ADD_DAMPING_TERM(YQ, 2, velocity->derivative[Y]);
  }
  if (order >= 1) {
    DRIFT_TERM(X);
    DRIFT_TERM(Y);
    DRIFT_TERM(P);
    DRIFT_TERM(Q);
  }
  if (order >= 2) {
    DRIFT_TERM(XX);
    DRIFT_TERM(XY);
    DRIFT_TERM(YY);
    DRIFT_TERM(XP);
    DRIFT_TERM(YP);
    DRIFT_TERM(XQ);
    DRIFT_TERM(YQ);
  }
  if (order >= 3) {
    DRIFT_TERM(X3);
    DRIFT_TERM(XXY);
    DRIFT_TERM(XYY);
    DRIFT_TERM(Y3);
  }
  angle->value += (0.318309886183790671537767526745 * row->per_velocity[0]) * velocity->value;
  velocity->value *= row->decay[0];
}

KZ_INLINE void kick_jet(int order, bool mirrored, const kz_kick *row, jet *angle, jet *velocity) {
  lanes s, c, force, slope;
  const lanes *x = angle->derivative;
  lanes *v = velocity->derivative;
  sine_and_cosine(&angle->value, &s, &c);
  force = row->a[0] * s;
  slope = row->a[0] * c;
  if (!mirrored) {
    force -= row->b[0] * c;
    slope += row->b[0] * s;
    velocity->value += row->push[0];
  }
  velocity->value -= force;
  if (order < 1) return;
  v[X] -= slope * x[X];
  v[Y] -= slope * x[Y];
  v[P] -= slope * x[P] + row->a[1] * s;
  v[Q] -= slope * x[Q] + row->a[2] * s;
  if (!mirrored) {
    v[P] += row->b[1] * c + row->push[1];
    v[Q] += row->b[2] * c + row->push[2];
  }
  if (order < 2) return;
  v[XX] -= slope * x[XX] - force * x[X] * x[X];
  v[XY] -= slope * x[XY] - force * x[X] * x[Y];
  v[YY] -= slope * x[YY] - force * x[Y] * x[Y];
  lanes of_p = row->a[1] * c - force * x[P], of_q = row->a[2] * c - force * x[Q];
  if (!mirrored) {
    of_p += row->b[1] * s;
    of_q += row->b[2] * s;
  }
  v[XP] -= slope * x[XP] + of_p * x[X];
  v[YP] -= slope * x[YP] + of_p * x[Y];
  v[XQ] -= slope * x[XQ] + of_q * x[X];
  v[YQ] -= slope * x[YQ] + of_q * x[Y];
  if (order < 3) return;
  v[X3] -= slope * (x[X3] - x[X] * x[X] * x[X]) - 3 * force * x[X] * x[XX];
  v[XXY] -= slope * (x[XXY] - x[X] * x[X] * x[Y]) - force * (2 * x[X] * x[XY] + x[Y] * x[XX]);
  v[XYY] -= slope * (x[XYY] - x[X] * x[Y] * x[Y]) - force * (2 * x[Y] * x[XY] + x[X] * x[YY]);
  v[Y3] -= slope * (x[Y3] - x[Y] * x[Y] * x[Y]) - 3 * force * x[Y] * x[YY];
}

KZ_INLINE void advance_jet(int order, bool damped, bool mirrored, int64_t n, const kz_kick *kicks,
                           const kz_drift *drifts, jet *angle, jet *velocity) {
  jet a = *angle, v = *velocity;
  for (int64_t step = 0; step < n; step++)
    for (int stage = 0; stage < KICKS; stage++, kicks++) {
      drift_jet(order, damped, drifts + (stage == 0 && step > 0 ? FUSED - 1 : stage), &a, &v);
      kick_jet(order, mirrored, kicks, &a, &v);
    }
  drift_jet(order, damped, drifts + KICKS, &a, &v);
  *angle = a;
  *velocity = v;
}

#define CASE(order, damped, mirrored)                                          \
  case 4 * (order) + 2 * (damped) + (mirrored):                                \
    advance_jet(order, damped, mirrored, n, kicks, drifts, &angle, &velocity); \
    break;
#define CASES(order) CASE(order, 0, 0) CASE(order, 0, 1) CASE(order, 1, 0) CASE(order, 1, 1)

/* Advances 4 states, u half-turns and v, with their derivatives theta, speed [TERMS][4] up to `order` through n steps
 * of split6. kicks [n][14]; drifts [16]: those of a step, and last the sum of the last drift of a step and the first of
 * the next. damped: the damping depends on p or q; mirrored: b and push are 0. */
void kz_jets_advance(int32_t order, int32_t damped, int32_t mirrored, int64_t n, const double *kicks_of,
                     const double *drifts_of, double *u, double *v, double *theta, double *speed) {
  const kz_kick *kicks = (const kz_kick *)kicks_of;
  const kz_drift *drifts = (const kz_drift *)drifts_of;
  jet angle, velocity;
  memcpy(&angle.value, u, sizeof angle.value);
  memcpy(&velocity.value, v, sizeof velocity.value);
  memcpy(angle.derivative, theta, sizeof angle.derivative);
  memcpy(velocity.derivative, speed, sizeof velocity.derivative);
  switch (4 * order + 2 * damped + mirrored) { CASES(0) CASES(1) CASES(2) CASES(3) }
  memcpy(u, &angle.value, sizeof angle.value);
  memcpy(v, &velocity.value, sizeof velocity.value);
  memcpy(theta, angle.derivative, sizeof angle.derivative);
  memcpy(speed, velocity.derivative, sizeof velocity.derivative);
}
