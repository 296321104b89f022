/* Multiple shooting with a node a period. The equations M step = -F are solved by step = M^T y, (M M^T + shift) y = -F,
 * which is block tridiagonal: the least-norm step, and Levenberg's where that does not help. */
#include "kapitza/kernel_paths.h"

enum { MAX_ITERATIONS = 40, MAX_ALONG = 12, MAX_DESCENT = 6 };
/* Shift of the equations beside their largest diagonal element: the least, that of the first step, the largest, and one
 * that leaves the nearly free shift in time out. */
static const double LEAST_SHIFT = 1e-15, FIRST_SHIFT = 1e-10, LARGEST_SHIFT = 0.1, FLOOR_SHIFT = 1e-8;
/* Jumps below EXACT, or below CLOSED that shrink no more, are due to rounding; larger steps are shortened (rad). */
static const double CLOSED = 1e-9, EXACT = 1e-13, LONGEST = 0.5;
/* Jumps on the floor of the bent valley that a shift in time makes, and steps that may follow it (rad). */
static const double ON_FLOOR = 1e-2, SHORT = 0.1;

typedef double block[4][4];

typedef struct {
  int64_t n;
  const kz_path_end *end[2];
  double *image;  /* [n][4] of each node after a period */
  double *jump;   /* [n][4] image less the next node */
  block *tangent; /* [n] */
  block *pivot, *below;
  double *y, *step, *next; /* next [n + 1][4] */
  double *column;          /* [n][4] derivative of the jumps by a parameter, which then moves too; NULL = none */
  double along;            /* step of that parameter */
} shooting;

static void shooting_free(shooting *s) {
  free(s->image);
}

static shooting shooting_of(int64_t n, const kz_path_end *from, const kz_path_end *to) {
  const size_t count = (size_t)n + 1;
  double *memory = kz_calloc(count * (5 * 4 + 3 * 16), sizeof *memory);
  shooting s = {.n = n, .end = {from, to}, .image = memory};
  s.jump = s.image + 4 * count;
  s.y = s.jump + 4 * count;
  s.step = s.y + 4 * count;
  s.next = s.step + 4 * count;
  s.tangent = (block *)(s.next + 4 * count);
  s.pivot = s.tangent + count;
  s.below = s.pivot + count;
  return s;
}

static double largest_of(const shooting *s) {
  double largest = 0;
  for (int64_t i = 0; i < 4 * s->n; i++)
    if (!(fabs(s->jump[i]) <= largest)) largest = fabs(s->jump[i]);
  return isfinite(largest) ? largest : INFINITY;
}

/* Jumps at all nodes, and tangents; returns the largest jump. */
static double polish_shoot(const kz_hamilton *flow, const double *node, shooting *s) {
  memcpy(s->image, node, (size_t)(4 * s->n) * sizeof *node);
  kz_hamilton_advance(flow, s->n, s->image, 1, s->tangent[0][0], 0, NULL);
  for (int64_t i = 0; i < 4 * s->n; i++) s->jump[i] = s->image[i] - node[i + 4];
  return largest_of(s);
}

/* The projection of a node's steps: the first and the last move in a plane. */
static void polish_projection(const shooting *s, int64_t node, block p) {
  const int side = node == 0 ? 0 : 1;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      p[i][j] = i == j;
      if (node > 0 && node < s->n) continue;
      p[i][j] =
          s->end[side]->plane[i][0] * s->end[side]->plane[j][0] + s->end[side]->plane[i][1] * s->end[side]->plane[j][1];
    }
}

static void polish_product(const block a, const block b, bool b_transposed, block c) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      double sum = 0;
      for (int k = 0; k < 4; k++) sum += a[i][k] * (b_transposed ? b[j][k] : b[k][j]);
      c[i][j] = sum;
    }
}

/* The blocks of M M^T; returns the largest diagonal element. */
static double polish_fill(shooting *s) {
  double largest = 0;
  for (int64_t i = 0; i < s->n; i++) {
    block here, next, moved;
    polish_projection(s, i, here);
    polish_projection(s, i + 1, next);
    polish_product(s->tangent[i], here, false, moved);
    polish_product(moved, s->tangent[i], true, s->pivot[i]);
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 4; k++) {
        s->pivot[i][j][k] += next[j][k];
        s->below[i][j][k] = -moved[j][k]; /* with the jump before; the first has none */
      }
    for (int j = 0; j < 4; j++) largest = fmax(largest, s->pivot[i][j][j]);
  }
  return largest;
}

/* Cholesky's factor of a block; false where it is not positive. */
static bool polish_factorise(block a) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j <= i; j++) {
      double sum = a[i][j];
      for (int k = 0; k < j; k++) sum -= a[i][k] * a[j][k];
      if (i == j && !(sum > 0)) return false;
      a[i][j] = i == j ? sqrt(sum) : sum / a[j][j];
    }
  return true;
}

static void solve_lower(const block a, double x[4]) {
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < i; k++) x[i] -= a[i][k] * x[k];
    x[i] /= a[i][i];
  }
}

static void solve_upper(const block a, double x[4]) {
  for (int i = 3; i >= 0; i--) {
    for (int k = i + 1; k < 4; k++) x[i] -= a[k][i] * x[k];
    x[i] /= a[i][i];
  }
}

/* Factors M M^T + shift in the place of the blocks. */
static bool polish_factorise_all(shooting *s, double shift) {
  for (int64_t i = 0; i < s->n; i++) {
    for (int j = 0; j < 4; j++) s->pivot[i][j][j] += shift;
    for (int j = 0; i > 0 && j < 4; j++) solve_lower(s->pivot[i - 1], s->below[i][j]);
    for (int j = 0; i > 0 && j < 4; j++)
      for (int k = 0; k < 4; k++)
        for (int l = 0; l < 4; l++) s->pivot[i][j][k] -= s->below[i][j][l] * s->below[i][k][l];
    if (!polish_factorise(s->pivot[i])) return false;
  }
  return true;
}

/* Solves (M M^T + shift) y = y. */
static void polish_substitute(const shooting *s, double *y) {
  for (int64_t i = 0; i < s->n; i++) {
    for (int j = 0; i > 0 && j < 4; j++)
      for (int k = 0; k < 4; k++) y[4 * i + j] -= s->below[i][j][k] * y[4 * (i - 1) + k];
    solve_lower(s->pivot[i], y + 4 * i);
  }
  for (int64_t i = s->n - 1; i >= 0; i--) {
    for (int j = 0; i + 1 < s->n && j < 4; j++)
      for (int k = 0; k < 4; k++) y[4 * i + j] -= s->below[i + 1][k][j] * y[4 * (i + 1) + k];
    solve_upper(s->pivot[i], y + 4 * i);
  }
}

/* y from (M M^T + shift) y = -F; with a column c from (M M^T + c c^T + shift) y = -F, by Sherman and Morrison's
 * formula. */
static bool polish_solve(shooting *s, double shift) {
  if (!polish_factorise_all(s, shift)) return false;
  for (int64_t i = 0; i < 4 * s->n; i++) s->y[i] = -s->jump[i];
  polish_substitute(s, s->y);
  if (!s->column) return true;
  double *moved = s->step, own = 1, side = 0;
  memcpy(moved, s->column, (size_t)(4 * s->n) * sizeof *moved);
  polish_substitute(s, moved);
  for (int64_t i = 0; i < 4 * s->n; i++) {
    own += s->column[i] * moved[i];
    side += s->column[i] * s->y[i];
  }
  s->along = side / own;
  for (int64_t i = 0; i < 4 * s->n; i++) s->y[i] -= s->along * moved[i];
  return true;
}

/* step = M^T y of all nodes; returns its largest element. */
static double find_step(shooting *s) {
  double largest = 0;
  for (int64_t i = 0; i <= s->n; i++) {
    double force[4] = {0};
    block p;
    for (int j = 0; j < 4; j++) {
      for (int k = 0; i < s->n && k < 4; k++) force[j] += s->tangent[i][k][j] * s->y[4 * i + k];
      if (i > 0) force[j] -= s->y[4 * (i - 1) + j];
    }
    polish_projection(s, i, p);
    for (int j = 0; j < 4; j++) {
      double sum = 0;
      for (int k = 0; k < 4; k++) sum += p[j][k] * force[k];
      s->step[4 * i + j] = sum;
      largest = fmax(largest, fabs(sum));
    }
  }
  return largest;
}

static double sum_of_squares(const double *x, int64_t n) {
  double sum = 0;
  for (int64_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sum;
}

/* Sets s->next, the step of a shift from nodes with known jumps and tangents. Returns its length, INFINITY if none. */
static double polish_propose(const double *node, double shift, shooting *s) {
  const double scale = polish_fill(s);
  if (!polish_solve(s, shift * scale)) return INFINITY;
  const double length = find_step(s), part = length > LONGEST ? LONGEST / length : 1;
  for (int64_t i = 0; i < 4 * (s->n + 1); i++) s->next[i] = node[i] + part * s->step[i];
  return length;
}

static void polish_accept(double *node, const shooting *s) {
  memcpy(node, s->next, (size_t)(4 * (s->n + 1)) * sizeof *node);
}

/* Goes back to the floor of the valley of small jumps by steps that leave the free shift in time out. */
static void polish_descend(const kz_hamilton *flow, double *node, shooting *s) {
  for (int i = 0; i < MAX_DESCENT; i++) {
    const double before = sum_of_squares(s->jump, 4 * s->n);
    if (isinf(polish_propose(node, FLOOR_SHIFT, s))) return;
    polish_shoot(flow, s->next, s);
    const double now = sum_of_squares(s->jump, 4 * s->n);
    if (!(now < before)) {
      polish_shoot(flow, node, s);
      return;
    }
    polish_accept(node, s);
    if (now > 0.25 * before) return;
  }
}

/* A step from the nodes, whose jumps and tangents are known, before and after. False where even the largest shift makes
 * the jumps no smaller. A short step along the valley may enlarge them, *along times. */
static bool polish_improve(const kz_hamilton *flow, double *node, double *shift, int *along, shooting *s) {
  const double before = sum_of_squares(s->jump, 4 * s->n);
  for (; *shift <= LARGEST_SHIFT; *shift *= 100) {
    const double length = polish_propose(node, *shift, s);
    if (isinf(length)) continue;
    polish_shoot(flow, s->next, s);
    const bool smaller = sum_of_squares(s->jump, 4 * s->n) < before;
    if (smaller || (length < SHORT && before < ON_FLOOR * ON_FLOOR && (*along)-- > 0)) {
      polish_accept(node, s);
      if (!smaller) polish_descend(flow, node, s);
      *shift = fmax(*shift * 1e-3, LEAST_SHIFT);
      return true;
    }
    polish_shoot(flow, node, s);
  }
  return false;
}

/* Coordinates of a node in the plane of its end. */
static void coordinates_of(const kz_path_end *end, double turns, const double *z, double c[2]) {
  c[0] = c[1] = 0;
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++) c[k] += end->plane[i][k] * (z[i] - end->state[i] - (i == 0 ? 2 * M_PI * turns : 0));
}

static void node_at(const kz_path_end *end, double turns, const double c[2], double *z) {
  for (int i = 0; i < 4; i++)
    z[i] = end->state[i] + (i == 0 ? 2 * M_PI * turns : 0) + end->plane[i][0] * c[0] + end->plane[i][1] * c[1];
}

/* Puts the first and the last node into their planes, as near as possible to where they are. */
static void put_on_planes(const kz_path_end *const end[2], kz_path *path) {
  for (int side = 0; side < 2; side++) {
    double *z = path->node + (side ? 4 * path->n : 0), c[2];
    coordinates_of(end[side], path->turns[side], z, c);
    node_at(end[side], path->turns[side], c, z);
  }
}

/* Action, its derivatives, and the distances of the ends. */
static void polish_measure(const kz_hamilton *flow, const kz_path_end *end[2], shooting *s, kz_path *path) {
  double (*integral)[4] = (double (*)[4])s->pivot;
  memcpy(s->image, path->node, (size_t)(4 * s->n) * sizeof *s->image);
  kz_hamilton_advance(flow, s->n, s->image, 0, NULL, 1, integral[0]);
  path->action = 0;
  memset(path->slope, 0, sizeof path->slope);
  for (int64_t i = 0; i < path->n; i++) {
    path->action += integral[i][0];
    for (int j = 0; j < 3; j++) path->slope[j] += integral[i][1 + j];
  }
  for (int side = 0; side < 2; side++) {
    const double *z = path->node + (side ? 4 * path->n : 0);
    const double x[2] = {z[0] - end[side]->state[0] - 2 * M_PI * path->turns[side], z[1] - end[side]->state[1]};
    path->action += (side ? -0.5 : 0.5) * (x[0] * z[2] + x[1] * z[3]);
    path->beyond[side] = hypot(x[0], x[1]);
  }
}

bool kz_path_polish(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, kz_path *path) {
  KZ_AUTOFREE_BY(shooting_free) shooting s = shooting_of(path->n, from, to);
  double shift = FIRST_SHIFT, before = INFINITY;
  int along = MAX_ALONG;
  put_on_planes(s.end, path);
  path->mismatch = polish_shoot(flow, path->node, &s);
  for (path->iterations = 0; path->iterations < MAX_ITERATIONS && isfinite(path->mismatch); path->iterations++) {
    if (path->mismatch < CLOSED && (path->mismatch > 0.25 * before || path->mismatch < EXACT)) break;
    before = path->mismatch;
    if (!polish_improve(flow, path->node, &shift, &along, &s)) break;
    path->mismatch = largest_of(&s);
  }
  if (!(path->mismatch < CLOSED)) return false;
  polish_measure(flow, s.end, &s, path);
  return true;
}

double kz_path_turn(const kz_hamilton *const flow[2], const kz_path_end *const from[2], const kz_path_end *const to[2],
                    double apart, kz_path *path) {
  KZ_AUTOFREE_BY(shooting_free) shooting s = shooting_of(path->n, from[0], to[0]);
  const size_t bytes = (size_t)(4 * (path->n + 1)) * sizeof *path->node;
  KZ_AUTOFREE double *column = kz_malloc(bytes);
  KZ_AUTOFREE double *node = kz_malloc(bytes);
  put_on_planes(s.end, path);
  memcpy(node, path->node, bytes);
  const kz_path_end *beside[2] = {from[1], to[1]};
  put_on_planes(beside, path);
  polish_shoot(flow[1], path->node, &s);
  memcpy(column, s.jump, bytes - 4 * sizeof *node);
  memcpy(path->node, node, bytes);
  path->mismatch = polish_shoot(flow[0], path->node, &s);
  for (int64_t i = 0; i < 4 * s.n; i++) column[i] = (column[i] - s.jump[i]) / apart;
  s.column = column;
  const double length = polish_propose(path->node, LEAST_SHIFT, &s);
  if (isinf(length)) return NAN;
  polish_accept(path->node, &s);
  return s.along * fmin(1, LONGEST / length);
}

/* The node a cycle away from z, nearer to the end, which is then moved by `next` turns. */
static void nearer_node(const kz_path_end *end, double turns, double next, const double *z, double *node) {
  double c[2];
  coordinates_of(end, turns, z, c);
  const double moved[2] = {end->along[0][0] * c[0] + end->along[0][1] * c[1],
                           end->along[1][0] * c[0] + end->along[1][1] * c[1]};
  node_at(end, next, moved, node);
}

/* The nodes between z and a cycle later, from z on. */
static void fill_between(const kz_hamilton *flow, int64_t period, double *z) {
  for (int64_t t = 1; t < period; t++) {
    memcpy(z + 4 * t, z + 4 * (t - 1), 4 * sizeof *z);
    kz_hamilton_advance(flow, 1, z + 4 * t, 0, NULL, 0, NULL);
  }
}

void kz_path_lengthen(const kz_hamilton *flow, const kz_path_end *from, const kz_path_end *to, const int64_t cycles[2],
                      kz_path *path) {
  const int64_t before = cycles[0] * from->period, after = cycles[1] * to->period;
  path->node = kz_realloc(path->node, (size_t)(4 * (path->n + before + after + 1)) * sizeof *path->node);
  memmove(path->node + 4 * before, path->node, (size_t)(4 * (path->n + 1)) * sizeof *path->node);
  for (int64_t i = 0; i < cycles[0]; i++) {
    double *z = path->node + 4 * (before - i * from->period), *earlier = z - 4 * from->period;
    nearer_node(from, path->turns[0], path->turns[0] - (double)from->winding, z, earlier);
    path->turns[0] -= (double)from->winding;
    fill_between(flow, from->period, earlier);
  }
  path->n += before;
  for (int64_t i = 0; i < cycles[1]; i++) {
    double *z = path->node + 4 * path->n;
    path->n += to->period;
    nearer_node(to, path->turns[1], path->turns[1] + (double)to->winding, z, path->node + 4 * path->n);
    path->turns[1] += (double)to->winding;
    fill_between(flow, to->period, z);
  }
}
