/* Barriers over values of one key of the pendulum mapping, or over a plane of two: searched at places here and there,
 * and continued between. */
#pragma once

#include "gates.h"

/* Reads the attractors that are left, and searches and continues their paths over the plan's axes. labels: of the
 * scene's own pendulum. Collective. */
kz_status kz_escape_over_plane(const kz_scene *scene, const kz_escape_labels *labels, const kz_listed *attractors,
                               kz_store *store, FILE *summary);

static inline bool kz_escape_has_plane(const kz_escape_plan *plan) {
  return plan->x.parameter >= 0;
}
