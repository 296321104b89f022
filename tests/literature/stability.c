/* Every value of tests/literature/reference.json about charts, thresholds and the effective potential: exact ones to
 * 1e-9, formulas to their printed digits. */

#include "../tools/test.h"

#include "kapitza/analysis.h"
#include "kapitza/kernel.h"
#include "curves.h"
#include "reference.h"

static const reference_span whole_file = {NULL, NULL};

static const kz_curve *curve_named(const char *name) {
  for (int i = 0; i < kz_curve_count; i++)
    if (strcmp(kz_curves[i].name, name) == 0) return &kz_curves[i];
  fail_msg("no curve %s", name);
  return NULL;
}

static double stability_value(const char *name, double k, double quality_factor) {
  kz_damping damping = {0, quality_factor};
  double m;
  kz_curve_values(curve_named(name), &damping, 1, &k, &m);
  return m;
}

#define CLOSE(ours, theirs, tolerance) close_to(#ours, ours, theirs, tolerance)
static void close_to(const char *what, double ours, double theirs, double tolerance) {
  if (!(fabs(ours - theirs) <= tolerance)) fail_msg("%s: %.16g, published %.16g", what, ours, theirs);
}

TEST(transition_curves_of_butikov_fig_1) {
  int seen = 0;
  for (int c = 1; c <= 5; c++) {
    char section[32], exact[32], formula[32], refined[32];
    snprintf(section, sizeof section, "butikov_fig1_curve%d", c);
    snprintf(exact, sizeof exact, "exact_%d", c);
    snprintf(formula, sizeof formula, "butikov_%d", c);
    snprintf(refined, sizeof refined, "butikov_%d_refined", c);
    reference_span rows = reference_section(whole_file, section), row = {NULL, NULL};
    while ((row = reference_next(rows, row)).first) {
      double k = reference_number(row, "k");
      CLOSE(stability_value(exact, k, NAN), reference_number(row, "m_exact"), 1e-9);
      CLOSE(stability_value(formula, k, NAN), reference_number(row, "m_formula"), 1e-9);
      if (c >= 4) CLOSE(stability_value(refined, k, NAN), reference_number(row, "m_formula2"), 1e-9);
      seen++;
    }
  }
  assert_true(seen > 40);
}

TEST(curves_turn_back_where_published) {
  reference_span exact = reference_section(whole_file, "butikov_curve3_turning_point_exact");
  CLOSE(kz_mathieu_turn(curve_named("exact_3")->turning), reference_number(exact, "m"), 1e-7);
  double k = reference_number(exact, "k");
  assert_true(isfinite(stability_value("exact_3", k - 1e-9, NAN)) && isnan(stability_value("exact_3", k + 1e-9, NAN)));
  CLOSE(stability_value("butikov_3", 0.65, NAN), 1.6, 1e-12);
  assert_true(isfinite(stability_value("exact_5", 2.0312, NAN)) && isnan(stability_value("exact_5", 2.0314, NAN)));
  CLOSE(kz_mathieu_turn(curve_named("exact_5")->turning), 3.829, 1e-3);
}

TEST(subharmonics_of_butikov_fig_9) {
  for (int n = 2; n <= 6; n += 2) {
    char section[32];
    snprintf(section, sizeof section, "butikov_fig9_n%d", n);
    reference_span rows = reference_section(whole_file, section), row = {NULL, NULL};
    int seen = 0;
    while ((row = reference_next(rows, row)).first) {
      double k = reference_number(row, "k"), exact, formula;
      kz_subharmonic_values(n, 1, &k, &exact, &formula);
      CLOSE(exact, reference_number(row, "m_exact"), 1e-9);
      CLOSE(formula, reference_number(row, "m_eq21"), 1e-9);
      seen++;
    }
    assert_true(seen >= 7);
  }
}

/* Numbers of texts on Paul traps: the first zone ends at q = 0.908046; the tip of a mass filter's zone. */
TEST(zone_of_the_paul_trap) {
  const kz_pendulum sine = {.m = 1};
  CLOSE(2 * stability_value("exact_2", 0, NAN), 0.908046, 5e-7);
  CLOSE(4 * kz_hill_edge(&sine, 2, 0.908046 / 2), 0, 5e-6);
  CLOSE(-4 * kz_hill_edge(&sine, 1, 0.706 / 2), 0.237, 5e-4);
  CLOSE(4 * kz_hill_edge(&sine, 2, 0.706 / 2), 0.237, 5e-4);
}

TEST(floquet_angles_of_butikov_fig_10) {
  const double k[] = {0, 0.74991592006338, 1.3999408919327}, beta[] = {0, 0, 0};
  const double m[] = {0.2255522566639546, 0.5235, 0.5653};
  double growth[3], angle[3];
  uint8_t stable[3];
  kz_linear_floquet(NULL, 3, k, beta, m, growth, angle, stable);
  for (int i = 0; i < 3; i++) {
    CLOSE(angle[i], 1.0 / 6, 1e-12);
    assert_true(growth[i] == 0 && stable[i] == 1);
  }
}

/* The boundaries of Blackburn's Fig. 4: both orientations, five dampings, with (5) and (6). */
TEST(boundaries_of_blackburn_fig_4) {
  const int omega[] = {5, 7, 9, 11, 15, 20, 30, 50};
  const char *quality[] = {"5", "10", "20", "50", "None"};
  for (int i = 0; i < 8; i++)
    for (int j = 0; j < 5; j++) {
      char section[64];
      snprintf(section, sizeof section, "blackburn_fig4_Omega%d_Q%s", omega[i], quality[j]);
      reference_span row = reference_section(whole_file, section);
      double k = 1.0 / (omega[i] * omega[i]), q = j == 4 ? NAN : atof(quality[j]);
      CLOSE(stability_value("damped_0", -k, q), reference_number(row, "eps_lower_exact"), 1e-9);
      CLOSE(stability_value("damped_1", -k, q), reference_number(row, "eps_upper_exact"), 1e-9);
      CLOSE(stability_value("damped_1", k, q), reference_number(row, "eps_down_upper_exact"), 1e-9);
      CLOSE(stability_value("blackburn_lower", -k, q), reference_number(row, "eq5"), 1e-9);
      CLOSE(stability_value("blackburn_upper", -k, q), reference_number(row, "eq6"), 1e-9);
      CLOSE(stability_value("blackburn_down_upper", k, q), reference_number(row, "eq6_down"), 1e-9);
    }
  double k = reference_number_at(strstr(reference_text(), "\"blackburn_delta_at_eps0.5_exact\":") + 34);
  CLOSE(stability_value("exact_2", k, NAN), 0.5, 1e-9);
}

TEST(tongues_of_butikov_fig_11) {
  for (int tongue = 1; tongue <= 2; tongue++) {
    char section[64];
    snprintf(section, sizeof section, "butikov_fig11_Q5_tongue%d(k,m_exact,m_eq2%d)", tongue, 4 + tongue);
    reference_span rows = reference_section(whole_file, section), row = {NULL, NULL};
    int seen = 0;
    while ((row = reference_next(rows, row)).first) {
      const char *second = strchr(row.first, ',') + 1, *third = strchr(second, ',') + 1;
      double k = reference_number_at(row.first);
      CLOSE(stability_value(tongue == 1 ? "damped_1" : "damped_2", k, 5), reference_number_at(second), 1e-9);
      CLOSE(stability_value(tongue == 1 ? "butikov_damped_1" : "butikov_damped_2", k, 5), reference_number_at(third),
            1e-9);
      seen++;
    }
    assert_int_equal(seen, 10);
  }
}

TEST(thresholds_of_butikov_section_6) {
  const int quality[] = {5, 10, 20, 100};
  for (int i = 0; i < 4; i++) {
    char section[32];
    snprintf(section, sizeof section, "butikov_sec6_Q%d", quality[i]);
    reference_span at_q = reference_section(whole_file, section);
    for (int tongue = 1; tongue <= 2; tongue++)
      for (int way = KZ_BY_FLOQUET; way <= KZ_BY_DETERMINANT; way++) {
        const char *names[2][2] = {{"tongue1_exact", "tongue1_eq25"}, {"tongue2_exact", "tongue2_eq26"}};
        reference_span row = reference_section(at_q, names[tongue - 1][way]);
        kz_threshold threshold;
        kz_tongue_threshold(tongue, quality[i], way, &threshold);
        CLOSE(threshold.k_lowest, reference_number(row, "k_min"), 1e-9);
        CLOSE(threshold.m_lowest, reference_number(row, "m_min"), 1e-9);
        CLOSE(threshold.m_tuned, reference_number(row, tongue == 1 ? "m_at_k0.25" : "m_at_k1"), 1e-9);
      }
  }
}

/* BSG (10)-(12) at theta = 2, epsilon = 0.3, Omega = 11, Q = 5, and the rims of its Fig. 5. */
TEST(effective_potential_of_blackburn) {
  kz_energy energy;
  kz_potential_energy(1.0 / 121, 1.0 / 55, 0.3, 2, &energy);
  CLOSE(energy.exact, 0.030434554, 1e-9);
  CLOSE(energy.blackburn, 0.030237336, 1e-9);
  CLOSE(energy.simple, 0.030307184, 1e-9);
  kz_rim rim;
  kz_potential_rim(1.0 / 121, 1.0 / 55, 0.05, &rim);
  assert_true(isnan(rim.simple) && isnan(rim.exact) && !rim.stable_inverted);
  kz_potential_rim(1.0 / 121, 1.0 / 55, 0.2, &rim);
  CLOSE(180 - rim.simple * 180 / M_PI, 65.59, 5e-3);
  assert_true(rim.stable_inverted);
}
