#include "step_check.h"

#include <float.h>

#include "cells.h"

enum {
  DOUBLINGS = 8,       /* Doublings of the steps that are tried as advice */
  MOST_STEPS = 100000, /* Largest number of steps that a scene can ask for */
  MOST_NODES = 10000   /* an axis, that are advised: 2.5 GB */
};

/* rad, error of one drive period above which the user is warned. */
static const double WARN_ABOVE = 1e-4;
/* Errors in cells of a basin, where a hundredth of a cell is less than WARN_ABOVE, and the error above which the scene
 * is refused: a picture that is shifted by so much. */
static const double WARN_ABOVE_CELLS = 0.01, REFUSE_ABOVE_CELLS = 0.1;

double kz_steps_tolerance(const kz_basin_plan *plan) {
  return fmin(WARN_ABOVE, WARN_ABOVE_CELLS * kz_cell_size(plan));
}

kz_step_motions kz_motions_of(const kz_scene *scene, double fastest, const char *keys) {
  return (kz_step_motions){scene->parameters.pendulum, scene->numerics, fastest, WARN_ABOVE,
                           KZ_STEPS_REFUSED,           INFINITY,        keys,    ""};
}

void kz_motions_label_cells(const kz_basin_plan *plan, kz_step_motions *motions) {
  motions->cell = kz_cell_size(plan);
  motions->warn_above = kz_steps_tolerance(plan);
  if (motions->warn_above < WARN_ABOVE) motions->refuse_above = REFUSE_ABOVE_CELLS * motions->cell;
}

bool kz_motions_find_steps(const kz_step_motions *m, kz_numerics *numerics) {
  const int32_t most = (int32_t)fmin(MOST_STEPS, ldexp(m->numerics.steps_per_period, DOUBLINGS));
  *numerics = m->numerics;
  if (kz_steps_enough(&m->pendulum, m->fastest, m->warn_above, most, numerics)) return true;
  if (m->refuse_above >= KZ_STEPS_REFUSED) return false;
  *numerics = m->numerics;
  return kz_steps_enough(&m->pendulum, m->fastest, m->refuse_above, most, numerics);
}

/* The advice at the end of a message. */
static void step_check_advice(const kz_step_motions *m, size_t bytes, char *text) {
  kz_numerics numerics;
  if (kz_motions_find_steps(m, &numerics))
    snprintf(text, bytes, "%d steps or more", (int)numerics.steps_per_period);
  else
    snprintf(text, bytes, "not even %d steps are enough: %s", (int)numerics.steps_per_period,
             m->refuse_above >= KZ_STEPS_REFUSED ? "slower starts, or weaker damping and drive"
                                                 : "wider cells, or basin.method exact");
}

static void describe_error(const kz_step_motions *m, double error, size_t bytes, char *text) {
  if (error == DBL_MAX)
    snprintf(text, bytes, "diverge");
  else if (m->refuse_above >= KZ_STEPS_REFUSED)
    snprintf(text, bytes, "are off by up to %.2g rad after one drive period", error);
  else
    snprintf(text, bytes, "are off by up to %.2g rad after one drive period, where a cell is %.2g wide", error,
             m->cell);
}

kz_speed_errors kz_motions_errors(const kz_step_motions *m) {
  return kz_step_error_classes(&m->pendulum, &m->numerics, m->fastest);
}

kz_status kz_motions_check(const kz_step_motions *m) {
  const kz_speed_errors classes = kz_motions_errors(m);
  const int worst = kz_worst_class(&classes);
  if (classes.error[worst] <= m->refuse_above) return KZ_OK;
  char what[120], help[160];
  describe_error(m, classes.error[worst], sizeof what, what);
  step_check_advice(m, sizeof help, help);
  return kz_fail(KZ_REFUSED,
                 "%s: %swith numerics.steps_per_period = %d of %s, motions at speeds from %.3g to %.3g %s; %s", m->keys,
                 m->where, (int)m->numerics.steps_per_period, kz_scheme_at(m->numerics.scheme).name,
                 classes.speed[worst], classes.speed[worst + 1], what, help);
}

void kz_motions_warn(const kz_step_motions *m, const kz_speed_errors *classes, FILE *summary) {
  char help[160];
  for (int c = 0; c < KZ_SPEED_CLASSES; c++)
    if (classes->error[c] > m->warn_above)
      fprintf(summary, "warning: %sat speeds from %.3g to %.3g the error of one drive period is up to %.2g rad\n",
              m->where, classes->speed[c], classes->speed[c + 1], classes->error[c]);
  if (kz_worst_error(classes) <= m->warn_above) return;
  step_check_advice(m, sizeof help, help);
  fprintf(summary, "warning: for an error below %.2g rad per period at every speed: numerics.steps_per_period: %s\n",
          m->warn_above, help);
}

kz_status kz_steps_check_table(const kz_basin_plan *plan, double table_error) {
  const double cell = kz_cell_size(plan);
  if (!(table_error > cell)) return KZ_OK;
  const int64_t most = kz_larger(plan->table_theta, plan->table_velocity);
  const double nodes = (double)most * pow(table_error / cell, 1.0 / kz_stencil(plan->interpolation));
  char more[64] = "";
  if (nodes <= MOST_NODES) snprintf(more, sizeof more, ", or some %.0f nodes an axis", 100 * ceil(nodes / 100));
  return kz_fail(
      KZ_REFUSED,
      "basin.icm|basin.method: the map table has an error of %.2g rad a period, but a cell is %.2g wide; use method "
      "direct%s",
      table_error, cell, more);
}

void kz_steps_warn_table(const kz_basin_plan *plan, double table_error, FILE *summary) {
  if (table_error <= kz_steps_tolerance(plan)) return;
  fprintf(
      summary,
      "warning: the map table has an error of %.2g rad a period (%.2g of a cell); use more nodes (basin.icm), a higher "
      "interpolation, or method direct\n",
      table_error, table_error / kz_cell_size(plan));
}
