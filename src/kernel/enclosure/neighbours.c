/* A step of the sets around their centres.
 *
 * A set is {c + A z: |z_i| <= Z_i}. Its true image lies in {c' + A' z}, c' and A' the kept doubles, where |z| grows by
 * at most |A'^-1| p, with p the error of c', A' and the linear map:
 *   M = |A| Z, d = farthest . M, p = error + tangent_error M + nonlinear T d^2 (|sin theta| / 2 + d / 6), T >= |a(t)| +
 *   |b(t)|,
 * with |sin theta| + |b| / T in place of |sin theta| if there is a drive across. jacobian_error bounds |dz_i/dz0_j - (i
 * == j)| of z as a function of its start, as long as the frame is not renewed. */
#include "operations.h"

static const double MAX_REACH = 1e6;          /* Largest reach of a set that is followed */
static const double MIN_DETERMINANT = 1e-250; /* Least determinant of its matrix */
static const double MIN_SINE = 0.25;          /* Least sine of the angle between the columns of a kept frame */

/* |A| x. */
KZ_INLINE void linear_images(const kz_sets *x, vector first, vector second, vector M[2]) {
  for (int i = 0; i < 2; i++) M[i] = absolute_lanes(x->matrix[i][0]) * first + absolute_lanes(x->matrix[i][1]) * second;
}

/* |A^-1| p, with 1 / |det A|. */
KZ_INLINE void solve_frame(const kz_sets *x, vector inverse, const vector p[2], vector z[2]) {
  z[0] = inverse * (absolute_lanes(x->matrix[1][1]) * p[0] + absolute_lanes(x->matrix[0][1]) * p[1]);
  z[1] = inverse * (absolute_lanes(x->matrix[1][0]) * p[0] + absolute_lanes(x->matrix[0][0]) * p[1]);
}

/* Lower bound of |det A|. */
KZ_INLINE vector least_determinant(const kz_sets *x) {
  const vector a = x->matrix[0][0] * x->matrix[1][1], b = x->matrix[0][1] * x->matrix[1][0];
  return absolute_lanes(a - b) - 0x1p-40 * (absolute_lanes(a) + absolute_lanes(b));
}

KZ_INLINE bool all_lanes(mask x) {
  int64_t every = -1;
  for (int lane = 0; lane < LANES; lane++) every &= x[lane];
  return every != 0;
}

/* Marks sets as lost and puts an equilibrium in their place, so that nothing overflows. */
static void mark_lost(mask lost, kz_sets *x) {
  static const kz_enclosure at_rest = {.matrix = {{1, 0}, {0, 1}}};
  for (int lane = 0; lane < LANES; lane++)
    if (lost[lane]) put_set(&at_rest, lane, x);
  x->lost |= lost;
}

void kz_sets_check(const kz_speed_class *speed, kz_sets *x) {
  const mask slow = absolute_lanes(x->velocity.high) <= speed->fastest, small = x->reach[0] + x->reach[1] < MAX_REACH;
  const mask good = slow & small & (least_determinant(x) > MIN_DETERMINANT);
  if (all_lanes(good)) return;
  x->too_fast |= ~slow;
  mark_lost(~good, x);
}

/* Upper bound of 1 / |det A|; sets without area are lost. */
KZ_INLINE vector largest_inverse(kz_sets *x) {
  const vector least = least_determinant(x);
  const mask good = least > MIN_DETERMINANT;
  if (!all_lanes(good)) mark_lost(~good, x);
  return KZ_ROUND_UP / blend_lanes(good, least, broadcast_value(1));
}

#define KZ_NEXT next_order
#define KZ_ARGUMENTS const kz_speed_class *speed, const vector *gain, vector *x, vector *y
#define KZ_SUM(sum) vector sum
#define KZ_DAMP(sum) sum = broadcast_value(speed->damping.high) * y[n]
#define KZ_PUSH(sum)
#define KZ_TERMS for (int i = 0; i <= (int)n; i++)
#define KZ_GAIN(sum) sum = multiply_add(gain[i], x[n - i], sum)
#define KZ_MOVE x[n + 1] = y[n] * speed->step[n].high
#define KZ_SET(sum) y[n + 1] = sum * -speed->inverse[n].high
#include "taylor/tangent.inc"

/* Advances the matrix by Taylor series of h (a(t) cos theta + b(t) sin theta) and of its columns. */
KZ_INLINE void move_matrix(const kz_speed_class *speed, int32_t first, int P, const kz_circle *circle, kz_sets *x) {
  vector stiffness[KZ_ORDER_JACOBIAN];
  for (int n = 0; n + 1 < P; n++) {
    vector s = broadcast_value(0);
    for (int j = 0; j <= n; j++)
      s = multiply_add(broadcast_value(speed->along[first + j].high), circle->cosine[n - j], s);
    stiffness[n] = s;
  }
  for (int n = 0; n + 1 < P && speed->has_across; n++)
    for (int j = 0; j <= n; j++)
      stiffness[n] = multiply_add(broadcast_value(-speed->across[first + j].high), circle->sine[n - j], stiffness[n]);
  for (int column = 0; column < 2; column++) {
    vector a[KZ_ORDER_JACOBIAN], b[KZ_ORDER_JACOBIAN];
    a[0] = x->matrix[0][column];
    b[0] = x->matrix[1][column];
    vector d_theta = b[0] * speed->step[0].high, d_velocity = broadcast_value(0);
#pragma GCC unroll 8 /* KZ_ORDER_TANGENT, so that the coefficients stay in registers */
    for (int n = 0; n + 1 < P; n++) {
      next_order(speed, stiffness, a, b, n);
      d_velocity += b[n + 1];
      d_theta = multiply_add(broadcast_value(speed->step[n + 1].high), b[n + 1], d_theta);
    }
    x->matrix[0][column] += d_theta;
    x->matrix[1][column] += d_velocity;
  }
}

/* Bounds (theta, velocity) of neighbours, |A z| <= M, less their linear map; torque: bound of nonlinear terms. */
KZ_INLINE void nonlinear_part(const kz_speed_class *speed, bool jacobian, const vector M[2], vector torque,
                              vector p[2]) {
  const double (*e)[2] = speed->tangent_error[jacobian];
  for (int i = 0; i < 2; i++) p[i] = (speed->nonlinear[i] * torque + e[i][0] * M[0] + e[i][1] * M[1]) * KZ_ROUND_UP;
}

void kz_neighbours_step(const kz_speed_class *speed, int32_t step, const kz_circle *circle, bool jacobian, kz_sets *x) {
  const double max_torque = speed->max_torque[step], local[2] = {speed->theta_error, speed->velocity_error};
  const vector max_sine = x->max_sine + (speed->has_across ? speed->max_across / max_torque : 0);
  vector M[2], p[2], p_column[2][2], gain[2];
  linear_images(x, x->reach[0], x->reach[1], M);
  const vector d = speed->neighbour_angle[0] * M[0] + speed->neighbour_angle[1] * M[1];
  nonlinear_part(speed, jacobian, M, max_torque * (d * d) * (0.5 * max_sine + d * (1.0 / 6)), p);
  for (int i = 0; i < 2; i++) p[i] = (p[i] + local[i]) * KZ_ROUND_UP;
  for (int j = 0; jacobian && j < 2; j++) {
    linear_images(x, (j == 0) + x->jacobian_error[0][j], (j == 1) + x->jacobian_error[1][j], M);
    const vector along = speed->neighbour_angle[0] * M[0] + speed->neighbour_angle[1] * M[1];
    nonlinear_part(speed, jacobian, M, max_torque * (d * along) * (max_sine + 0.5 * d), p_column[j]);
  }
  if (jacobian)
    move_matrix(speed, step * speed->order, KZ_ORDER_JACOBIAN, circle, x);
  else
    move_matrix(speed, step * speed->order, KZ_ORDER_TANGENT, circle, x);
  const vector inverse = largest_inverse(x);
  solve_frame(x, inverse, p, gain);
  for (int i = 0; i < 2; i++) x->reach[i] = (x->reach[i] + gain[i]) * KZ_ROUND_UP;
  for (int j = 0; jacobian && j < 2; j++) {
    solve_frame(x, inverse, p_column[j], gain);
    for (int i = 0; i < 2; i++) x->jacobian_error[i][j] = (x->jacobian_error[i][j] + gain[i]) * KZ_ROUND_UP;
  }
}

void kz_sets_widen(const vector p[2], kz_sets *x) {
  vector gain[2];
  solve_frame(x, largest_inverse(x), p, gain);
  for (int i = 0; i < 2; i++) x->reach[i] = (x->reach[i] + gain[i]) * KZ_ROUND_UP;
}

void kz_sets_drop_rest(kz_sets *x) {
  const vector p[2] = {absolute_lanes(x->theta_rest), absolute_lanes(x->velocity_rest)};
  x->theta_rest = x->velocity_rest = broadcast_value(0);
  kz_sets_widen(p, x);
}

/* Removes whole turns, with an error of the angle of at most 2^-99 + turns 2^-105 (B7). */
void kz_sets_wrap(kz_sets *x) {
  static const double turn[3] = KZ_TWO_PI;
  const vector turns = nearest_integer(x->theta.high * (1 / turn[0]));
  x->theta = less_multiple(x->theta, turns, turn);
  const vector p[2] = {0x1p-99 + 0x1p-105 * absolute_lanes(turns), broadcast_value(0)};
  kz_sets_widen(p, x);
}

/* Renews the frame by A z = Q (Q^-1 A z), Q a rotation but for rounding, which the slack covers. */
void kz_sets_renew_frame(kz_sets *x) {
  vector squares[2], lengths[2];
  for (int j = 0; j < 2; j++) {
    lengths[j] = x->matrix[0][j] * x->matrix[0][j] + x->matrix[1][j] * x->matrix[1][j];
    squares[j] = lengths[j] * (x->reach[j] * x->reach[j]);
  }
  const vector area = x->matrix[0][0] * x->matrix[1][1] - x->matrix[0][1] * x->matrix[1][0];
  const mask first = squares[0] >= squares[1], keep = area * area > MIN_SINE * MIN_SINE * lengths[0] * lengths[1];
  vector a[2], b[2];
  for (int i = 0; i < 2; i++) {
    a[i] = blend_lanes(first, x->matrix[i][0], x->matrix[i][1]);
    b[i] = blend_lanes(first, x->matrix[i][1], x->matrix[i][0]);
  }
  const vector reach_a = blend_lanes(first, x->reach[0], x->reach[1]),
               reach_b = blend_lanes(first, x->reach[1], x->reach[0]);
  vector length = blend_lanes(first, lengths[0], lengths[1]);
  for (int lane = 0; lane < LANES; lane++) length[lane] = sqrt(length[lane]);
  const vector q[2] = {a[0] / length, a[1] / length};
  const vector slack = 0x1p-44 * (length * reach_a + (absolute_lanes(b[0]) + absolute_lanes(b[1])) * reach_b);
  const vector along = (length * reach_a + absolute_lanes(b[0] * q[0] + b[1] * q[1]) * reach_b + slack) * KZ_ROUND_UP;
  const vector across = (absolute_lanes(b[1] * q[0] - b[0] * q[1]) * reach_b + slack) * KZ_ROUND_UP;
  x->reach[0] = blend_lanes(keep, x->reach[0], along);
  x->reach[1] = blend_lanes(keep, x->reach[1], across);
  for (int i = 0; i < 2; i++) x->matrix[i][0] = blend_lanes(keep, x->matrix[i][0], q[i]);
  x->matrix[0][1] = blend_lanes(keep, x->matrix[0][1], -q[1]);
  x->matrix[1][1] = blend_lanes(keep, x->matrix[1][1], q[0]);
}
