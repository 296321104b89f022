#include "curves.h"

/* Square root of a radicand that rounding may push below 0 at the end of its domain. */
static double root_of(double x) {
  return x < 0 && x > -1e-12 ? 0 : sqrt(x);
}

/* Head of a curve's function: k, the damping there, and m at its turn. */
#define UNUSED __attribute__((unused))
#define CURVE(name) static double name(double k, double beta UNUSED, double turn UNUSED)

/* m of a curve for low <= k <= high, else NaN. */
#define FORMULA(name, low, high, m)               \
  CURVE(name) {                                   \
    return k >= (low) && k <= (high) ? (m) : NAN; \
  }

FORMULA(exact_1, -INFINITY, INFINITY, kz_mathieu_m(1, k, turn, 0))
FORMULA(exact_2, -INFINITY, INFINITY, kz_mathieu_m(2, k, turn, 0))
FORMULA(exact_3, -INFINITY, INFINITY, kz_mathieu_m(3, k, turn, 0))
FORMULA(exact_3_upper, -INFINITY, INFINITY, kz_mathieu_m(3, k, turn, 1))
FORMULA(exact_4, -INFINITY, INFINITY, kz_mathieu_m(4, k, turn, 0))
FORMULA(exact_5, -INFINITY, INFINITY, kz_mathieu_m(5, k, turn, 0))
FORMULA(exact_5_upper, -INFINITY, INFINITY, kz_mathieu_m(5, k, turn, 1))

static double cosine_cut(double k) {
  return 2 * root_of(k * (k - 1) * (k - 4) / (3 * k - 8));
}
static double half_radical(double k) {
  return root_of((9 - 4 * k) * (13 - 20 * k));
}
FORMULA(butikov_1, -INFINITY, 0, cosine_cut(k))
FORMULA(butikov_2, -INFINITY, 0.25, 0.25 * (half_radical(k) - (9 - 4 * k)))
FORMULA(butikov_3, 0.25, 0.65, 0.25 * (9 - 4 * k - half_radical(k)))
FORMULA(butikov_3_upper, -INFINITY, 0.65, 0.25 * (9 - 4 * k + half_radical(k)))
FORMULA(butikov_4, -INFINITY, 1, root_of(2 * (k - 1) * (k - 4) * (k - 9) / (k - 5)))
FORMULA(butikov_5, 1, 8.0 / 3, cosine_cut(k))
static double refined_4(double k) {
  return root_of((((5 * k - 162) * k + 2101) * k - 12136) * k + 24592);
}
FORMULA(butikov_4_refined, -INFINITY, 1, root_of(2 * ((3 * k - 47) * k + 164 - refined_4(k))))
static double refined_5(double k, double sign) {
  double inner = root_of(648 + k * (k - 9) * (k * k - 13 * k + 68));
  return root_of(4 * k * k - 36 * k + 72 + sign * 2 * sqrt(2) * inner);
}
FORMULA(butikov_5_refined, 1, 4, refined_5(k, -1))
FORMULA(butikov_5_refined_upper, -INFINITY, 4, refined_5(k, 1))

FORMULA(blackburn_lower, -INFINITY, 0, sqrt(-2 * k))
FORMULA(blackburn_upper, -INFINITY, 0, 0.450 - 1.799 * k)
FORMULA(blackburn_upper_note, -INFINITY, 0, 0.450 - 2.22 * k)
FORMULA(blackburn_tangent, -INFINITY, 0.25, 2 * (0.25 - k))
FORMULA(blackburn_down_upper, 0, 0.25, 0.450 - 1.799 * k)

FORMULA(damped_0, -INFINITY, INFINITY, kz_tongue_lower(k, beta))
FORMULA(damped_1, -INFINITY, INFINITY, kz_tongue_edge(1, k, beta, turn, false))
FORMULA(damped_1_upper, -INFINITY, INFINITY, kz_tongue_edge(1, k, beta, turn, true))
FORMULA(damped_2, -INFINITY, INFINITY, kz_tongue_edge(2, k, beta, turn, false))
FORMULA(damped_2_upper, -INFINITY, INFINITY, kz_tongue_edge(2, k, beta, turn, true))
FORMULA(butikov_damped_1, -INFINITY, 2.25, kz_hill_cut_half(k, beta, false))
FORMULA(butikov_damped_1_upper, -INFINITY, 2.25, kz_hill_cut_half(k, beta, true))
FORMULA(butikov_damped_2, -INFINITY, 8.0 / 3, kz_hill_cut_whole(k, beta))

#define CURVES(ROW, UPPER, EDGES)                                                           \
  ROW(exact_1, 0)              /* k <= 0: 4k = a_0(2m) */                                   \
  ROW(exact_2, 0)              /* k <= 1/4: 4k = b_1(2m) */                                 \
  ROW(exact_3, 3)              /* 1/4 <= k <= 0.6304: 4k = a_1(2m) */                       \
  UPPER(exact_3, 3)            /* k <= 0.6304: 4k = a_1(2m), beyond its turn */             \
  ROW(exact_4, 0)              /* k <= 1: 4k = b_2(2m) */                                   \
  ROW(exact_5, 5)              /* 1 <= k <= 2.0313: 4k = a_2(2m) */                         \
  UPPER(exact_5, 5)            /* k <= 2.0313: 4k = a_2(2m), beyond its turn */             \
  ROW(butikov_1, 0)            /* k <= 0: BUT (3) */                                        \
  ROW(butikov_2, 0)            /* k <= 1/4: BUT (4) */                                      \
  ROW(butikov_3, 0)            /* 1/4 <= k <= 13/20: BUT (5), minus */                      \
  UPPER(butikov_3, 0)          /* k <= 13/20: BUT (5), plus */                              \
  ROW(butikov_4, 0)            /* k <= 1: BUT (6) */                                        \
  ROW(butikov_5, 0)            /* 1 <= k < 8/3: BUT (7) */                                  \
  ROW(butikov_4_refined, 0)    /* k <= 1: BUT (17) */                                       \
  ROW(butikov_5_refined, 0)    /* 1 <= k <= 2.042: BUT (19), minus */                       \
  UPPER(butikov_5_refined, 0)  /* k <= 2.042: BUT (19), plus */                             \
  ROW(blackburn_lower, 0)      /* k <= 0: BSG (5) */                                        \
  ROW(blackburn_upper, 0)      /* k <= 0: BSG (6) */                                        \
  ROW(blackburn_upper_note, 0) /* k <= 0: BSG, note 13 */                                   \
  ROW(blackburn_tangent, 0)    /* k <= 1/4: BSG, delta = 1/4 - epsilon/2, tangent to b_1 */ \
  ROW(blackburn_down_upper, 0) /* 0 <= k <= 1/4: BSG (6), down */                           \
  ROW(damped_0, 0)             /* k <= 0: multiplier 1, continues curve 1 */                \
  ROW(damped_1, 3)             /* tongue 1: multiplier -1, continues curves 2 and 3 */      \
  UPPER(damped_1, 3)           /* tongue 1 beyond its turn */                               \
  ROW(damped_2, 5)             /* tongue 2: multiplier 1, continues curves 4 and 5 */       \
  UPPER(damped_2, 5)           /* tongue 2 beyond its turn */                               \
  ROW(butikov_damped_1, 0)     /* k <= 9/4 and a real root: BUT (25), corrected */          \
  UPPER(butikov_damped_1, 0)   /* larger root of BUT (25), corrected */                     \
  ROW(butikov_damped_2, 0)     /* k <= 8/3 and a real root: BUT (26), corrected */          \
  EDGES(hill, kz_hill_edge)    /* any wave form */                                          \
  EDGES(meissner, kz_meissner_edge)

#define ROW(name, turning) {#name, #name, name, turning, NULL, 0},
#define UPPER(name, turning) {#name "_upper", #name, name##_upper, turning, NULL, 0},
#define EDGES(name, edge)                                                                     \
  {#name "_1", #name "_1", NULL, 0, edge, 1}, {#name "_2", #name "_2", NULL, 0, edge, 2},     \
      {#name "_3", #name "_3", NULL, 0, edge, 3}, {#name "_4", #name "_4", NULL, 0, edge, 4}, \
      {#name "_5", #name "_5", NULL, 0, edge, 5},
const kz_curve kz_curves[] = {CURVES(ROW, UPPER, EDGES)};
const int kz_curve_count = sizeof kz_curves / sizeof kz_curves[0];

#define NAME_OF_ROW(name, turning) "|" #name
#define NAME_OF_UPPER(name, turning) ""
#define NAMES_OF_EDGES(name, edge) "|" #name "_1|" #name "_2|" #name "_3|" #name "_4|" #name "_5"
const char *kz_curve_names(void) {
  return &(CURVES(NAME_OF_ROW, NAME_OF_UPPER, NAMES_OF_EDGES))[1];
}

double kz_damping_at(const kz_damping *damping, double k) {
  return damping->quality_factor > 0 ? sqrt(fabs(k)) / damping->quality_factor : damping->beta;
}

void kz_curve_values(const kz_curve *curve, const kz_damping *damping, int64_t n, const double *k, double *m) {
  const double turn = curve->turning ? kz_mathieu_turn(curve->turning) : 0;
  for (int64_t i = 0; i < n; i++) m[i] = curve->value(k[i], kz_damping_at(damping, k[i]), turn);
}

typedef struct {
  double k, nu;
} angle_point;

/* Function that vanishes where a solution has the Floquet angle 2 pi nu. */
static double angle_residual(double m, void *context) {
  const angle_point *point = context;
  double complex up = kz_hill_pivot(point->k, 0, m, 1 + point->nu), down = kz_hill_pivot(point->k, 0, m, 1 - point->nu);
  return point->k - point->nu * point->nu - 0.25 * m * m * (1 / creal(up) + 1 / creal(down));
}

/* Returns m of the curve with angle 2 pi nu, which increases with m from curve 1 (0) to curve 2 (pi). */
static double angle_curve(double k, double nu) {
  if (k > nu * nu) return NAN;
  if (k == nu * nu) return 0;
  angle_point point = {k, nu};
  double low = k < 0 ? kz_mathieu_m(1, k, 0, 0) : 0, high = kz_mathieu_m(2, k, 0, 0);
  double m = kz_root(angle_residual, &point, low, high);
  return isfinite(m) ? m : high;
}

void kz_subharmonic_values(int32_t order, int64_t n, const double *k, double *m_exact, double *m_formula) {
  double nu = 1.0 / order, turn = order == 2 ? kz_mathieu_turn(3) : 0;
  for (int64_t i = 0; i < n; i++) {
    if (order == 2)
      m_exact[i] = k[i] <= 0.25 ? kz_mathieu_m(2, k[i], 0, 0) : kz_mathieu_m(3, k[i], turn, 0);
    else
      m_exact[i] = angle_curve(k[i], nu);
    m_formula[i] = k[i] <= (order == 2 ? 1 : nu * nu) ? kz_hill_cut_angle(k[i], nu) : NAN;
  }
}
