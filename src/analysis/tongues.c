#include "curves.h"

#include "kapitza/kernel.h"

enum { PROBES = 64, ROUNDS = 4 };

typedef struct {
  double k, beta;
  bool half;
} tongue_point;

static double tongue_residual(double m, void *context) {
  const tongue_point *point = context;
  return point->half ? kz_hill_half(point->k, point->beta, m) : kz_hill_whole(point->k, point->beta, m);
}

/* k of the equation of w in u = exp(-beta t/2) w, without damping. */
static double undamped_k(double k, double beta) {
  return k - 0.25 * beta * beta;
}

double kz_tongue_lower(double k, double beta) {
  if (k > 0) return NAN;
  double above = kz_mathieu_m(1, undamped_k(k, beta), 0, false);
  if (beta == 0 || k == 0) return k == 0 ? 0 : above;
  tongue_point point = {k, beta, false};
  double m = kz_root(tongue_residual, &point, 0, above);
  return isfinite(m) ? m : above;
}

/* Returns the largest growth among equally spaced m from low to high, at *best; moves the ends beside it. */
static double probe_growth(const tongue_point *point, double *low, double *high, double *best) {
  double k[PROBES], beta[PROBES], m[PROBES], growth[PROBES], angle[PROBES];
  uint8_t stable[PROBES];
  double step = (*high - *low) / (PROBES + 1);
  for (int i = 0; i < PROBES; i++) {
    k[i] = point->k;
    beta[i] = point->beta;
    m[i] = *low + (i + 1) * step;
  }
  kz_linear_floquet(NULL, PROBES, k, beta, m, growth, angle, stable);
  int top = 0;
  for (int i = 1; i < PROBES; i++)
    if (growth[i] > growth[top]) top = i;
  *best = m[top];
  *low = m[top] - step;
  *high = m[top] + step;
  return growth[top];
}

/* Within the undamped tongue growth rises from its lower edge to one maximum and falls to its upper edge: the damped
 * edges lie on both sides of a point of growth. */
double kz_tongue_edge(int tongue, double k, double beta, double turn, bool upper_edge) {
  int lower = tongue == 1 ? 2 : 4, upper = lower + 1;
  double kappa = undamped_k(k, beta), axis = tongue == 1 ? 0.25 : 1;
  double foot = kappa <= axis ? kz_mathieu_m(lower, kappa, 0, false) : kz_mathieu_m(upper, kappa, turn, false);
  double top = kz_mathieu_m(upper, kappa, turn, true), edge = upper_edge ? top : foot;
  if (beta == 0 || !isfinite(edge)) return edge;
  tongue_point point = {k, beta, tongue == 1};
  double low = foot, high = top, inside = NAN;
  for (int round = 0; round < ROUNDS; round++) {
    if (probe_growth(&point, &low, &high, &inside) > 0) {
      double m =
          upper_edge ? kz_root(tongue_residual, &point, inside, edge) : kz_root(tongue_residual, &point, edge, inside);
      return isfinite(m) ? m : edge;
    }
  }
  return NAN;
}

/* ---- thresholds ---- */

/* The edge of a tongue over the distance of k from exact tuning, which resolves its narrow valley at large Q. */
typedef struct {
  int tongue, method;
  double quality_factor, axis, turn, step;
} valley;

static double edge_at(double from_axis, void *context) {
  const valley *v = context;
  double k = v->axis + from_axis, beta = sqrt(fabs(k)) / v->quality_factor;
  if (v->method == KZ_BY_FLOQUET) return kz_tongue_edge(v->tongue, k, beta, v->turn, false);
  return v->tongue == 1 ? kz_hill_cut_half(k, beta, false) : kz_hill_cut_whole(k, beta);
}

/* Slope of the edge, of fourth order. */
static double slope_at(double x, void *context) {
  const valley *v = context;
  double h = v->step;
  return 8 * (edge_at(x + h, context) - edge_at(x - h, context)) - edge_at(x + 2 * h, context) +
         edge_at(x - 2 * h, context);
}

/* The lowest of equally spaced points, then Brent's minimum, then the zero of the slope: k to 1e-11 of the tongue's
 * width. NaN where the edge has no lowest point inside (low Q: it only falls towards k = 0). */
static double lowest_from_axis(valley *v) {
  enum { POINTS = 256 };
  double spacing = 2.4 * v->axis / POINTS, lowest = INFINITY;
  int point = 0;
  for (int i = 1; i < POINTS; i++) {
    double edge = edge_at(i * spacing - v->axis, v);
    if (!(edge < lowest)) continue;
    lowest = edge;
    point = i;
  }
  double best = point * spacing - v->axis;
  if (point < 1 || !(edge_at(best - spacing, v) > lowest) || !(edge_at(best + spacing, v) > lowest)) return NAN;
  double x = kz_lowest(edge_at, v, best - spacing, best, best + spacing);
  double width = v->tongue == 1 ? edge_at(x, v) : pow(edge_at(x, v), 2);
  v->step = 5e-4 * fmin(width, v->axis + x);
  double refined = kz_root(slope_at, v, x - 0.02 * width, x + 0.02 * width);
  return isfinite(refined) ? refined : x;
}

void kz_tongue_threshold(int32_t tongue, double quality_factor, int32_t method, kz_threshold *threshold) {
  double q = quality_factor, axis = tongue == 1 ? 0.25 : 1;
  if (method == KZ_BY_ASYMPTOTE) {
    if (tongue == 1)
      *threshold = (kz_threshold){0.25 - 5 / (32 * q * q), 1 / (2 * q), 1 / (2 * q)};
    else
      *threshold = (kz_threshold){1 + 2 / (3 * q), 2 / sqrt(q), sqrt(12 / sqrt(5)) / sqrt(q)};
    return;
  }
  valley v = {tongue, method, q, axis, kz_mathieu_turn(tongue == 1 ? 3 : 5), 0};
  double lowest = lowest_from_axis(&v);
  *threshold = (kz_threshold){axis + lowest, edge_at(lowest, &v), edge_at(0, &v)};
}
