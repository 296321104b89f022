/* The group /stability. */
#include <inttypes.h>

#include "stability.h"

static const char *const GROUP = "stability";

#define COLUMN(type, name, n, expression) KZ_COLUMN(store, GROUP, name, n, type, expression)

static kz_status write_curve(const kz_chart *chart, int64_t task_number, kz_store *store) {
  const kz_curve_task *task = &chart->tasks[task_number];
  const kz_curve_point *point = chart->curves + task_number * chart->stride;
  const int64_t n = kz_chart_row(&chart->axes);
  char name[64];
  snprintf(name, sizeof name, "butikov_subharmonic_%" PRId32, task->order);
  COLUMN(double, task->row >= 0 ? kz_curves[task->row].name : name + strlen("butikov_"), n, point[i].value[0]);
  if (task->row < 0) COLUMN(double, name, n, point[i].value[1]);
  return KZ_OK;
}

static kz_status write_axes(const kz_chart *chart, kz_store *store) {
  const kz_chart_axes *axes = &chart->axes;
  KZ_TRY(kz_store_dimension(store, GROUP, "k", axes->k.count, chart->k));
  KZ_TRY(kz_store_dimension(store, GROUP, "m", axes->m.count, chart->m));
  if (isnan(chart->plan->a.min)) return KZ_OK;
  COLUMN(double, "a", axes->k.count, 4 * chart->k[i]);
  COLUMN(double, "q", axes->m.count, 2 * chart->m[i]);
  return KZ_OK;
}

/* Thresholds of the tongues, three ways: attributes such as tongue_1_lowest_m, tongue_1_lowest_m_determinant. */
static kz_status write_thresholds(double quality_factor, kz_store *store) {
  static const char *const ways[] = {"", "_determinant", "_asymptote"}, *const parts[] = {"lowest_k", "lowest_m",
                                                                                          "tuned_m"};
  for (int32_t tongue = 1; tongue <= 2; tongue++)
    for (int32_t way = KZ_BY_FLOQUET; way <= KZ_BY_ASYMPTOTE; way++) {
      kz_threshold t;
      kz_tongue_threshold(tongue, quality_factor, way, &t);
      const double values[] = {t.k_lowest, t.m_lowest, t.m_tuned};
      for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "tongue_%" PRId32 "_%s%s", tongue, parts[i], ways[way]);
        KZ_TRY(kz_store_real(store, GROUP, name, values[i]));
      }
    }
  return KZ_OK;
}

static bool has_thresholds(const kz_chart *chart) {
  return chart->damping.quality_factor > 0 && kz_is_sine(&chart->form);
}

static kz_status write_damping(const kz_chart *chart, kz_store *store) {
  const kz_damping *damping = &chart->damping;
  if (!(damping->quality_factor > 0)) return kz_store_real(store, GROUP, "damping", damping->beta);
  KZ_TRY(kz_store_real(store, GROUP, "quality_factor", damping->quality_factor));
  return has_thresholds(chart) ? write_thresholds(damping->quality_factor, store) : KZ_OK;
}

/* Returns 1 if all harmonics of a wave form are odd: its second half is minus the first; else 0. */
static kz_status write_form(const kz_pendulum *form, kz_store *store) {
  bool odd = true;
  for (int j = 1; j < form->harmonics; j += 2) odd = odd && form->vertical[j][0] == 0 && form->vertical[j][1] == 0;
  return kz_is_sine(form) ? KZ_OK : kz_store_integer(store, GROUP, "odd_harmonics", odd);
}

kz_status kz_chart_write(const kz_chart *chart, kz_store *store) {
  KZ_TRY(write_axes(chart, store));
  const int64_t n = chart->axes.k.count * chart->axes.m.count;
  COLUMN(double, "log_multiplier", n, chart->points[i].log_multiplier);
  COLUMN(double, "angle", n, chart->points[i].angle);
  COLUMN(uint8_t, "stable", n, chart->points[i].stable);
  for (int64_t i = 0; i < chart->n_tasks; i++) KZ_TRY(write_curve(chart, i, store));
  KZ_TRY(write_form(&chart->form, store));
  return write_damping(chart, store);
}

void kz_chart_summarise(const kz_chart *chart, FILE *summary) {
  int64_t points = chart->axes.k.count * chart->axes.m.count, stable = 0;
  for (int64_t i = 0; i < points; i++) stable += chart->points[i].stable;
  fprintf(summary, "stability: %" PRId64 " x %" PRId64 " points, %.2f %% of them stable, %" PRId64 " curve%s\n",
          chart->axes.k.count, chart->axes.m.count, 100.0 * (double)stable / (double)points, chart->n_tasks,
          chart->n_tasks == 1 ? "" : "s");
  if (!has_thresholds(chart)) return;
  for (int32_t tongue = 1; tongue <= 2; tongue++) {
    kz_threshold t;
    kz_tongue_threshold(tongue, chart->damping.quality_factor, KZ_BY_FLOQUET, &t);
    fprintf(summary, "  tongue %" PRId32 " at Q = %g: lowest at k = %.10g, m = %.10g; m = %.10g at exact tuning\n",
            tongue, chart->damping.quality_factor, t.k_lowest, t.m_lowest, t.m_tuned);
  }
}
