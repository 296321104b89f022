/* Saddles as gates: on which basins their unstable branches end. */
#pragma once

#include "routes.h"
#include "labelling/labeller.h"
#include "labelling/listed.h"
#include "labelling/search.h"

enum { KZ_GATE_POINTS = 16 /* labelled points a branch */, KZ_GATE_ATTRACTORS = 64 /* bits of kz_gate */ };

/* Labels along the two branches of a saddle. */
typedef struct {
  bool is_saddle;   /* false: a repeller, or no cycle of Hamilton's flow */
  int32_t alone[2]; /* id of the attractor on which all points of a branch end; -1 = there are several */
  uint64_t meets;   /* bit of each attractor on which any point of them ends */
  int64_t period, winding;
  double state[2], away[2], stable[2]; /* strobe point 0, its unstable and its stable direction */
} kz_gate;

/* Attractors of the file, and how starts are labelled with their ids. */
typedef struct {
  const kz_run *run;
  kz_dynamics *dynamics;
  int64_t max_periods;
  int32_t id[INT16_MAX + 1]; /* id in the file of each attractor of kz_dynamics; -1 = none */
} kz_escape_labels;

/* Finds id [n] of the attractors on which starts [n][2] end; -1 = none or not in the file. Collective. */
kz_status kz_escape_label(const kz_escape_labels *labels, int round, int64_t n, const double *start, int32_t *id);
/* Finds the attractors of a list that `search` finds, and gives the labels their ids. Collective. */
kz_status kz_escape_labels_make(const kz_search *search, const kz_listed *attractors, kz_escape_labels *labels);
/* The gates of all saddles. Collective. */
kz_status kz_gates_find(const kz_escape_labels *labels, const kz_escape_flow *flow, const kz_listed *saddles,
                        kz_gate *gate);

/* Whether some points of a saddle's unstable branches end on the attractor, and others do not. */
bool kz_gate_borders(const kz_hamilton *flow, const kz_path_end *attractor, const kz_path_end *saddle);

/* Whether a saddle lies on the edge of the basin of attractor `id`, where it can be reached from inside: one branch
 * ends on the attractor alone. Where no saddle does so, the boundary is fractal from inside too, and the saddles count
 * whose branches meet the basin. `alone`: bits of the attractors for which one does. */
static inline bool kz_gate_is_alone(const kz_gate *gate, int32_t id) {
  return (gate->alone[0] == id) != (gate->alone[1] == id);
}
static inline bool kz_gate_is_of(const kz_gate *gate, int32_t id, uint64_t alone) {
  if (alone >> id & 1) return kz_gate_is_alone(gate, id);
  return (gate->meets >> id & 1) && !(gate->alone[0] == id && gate->alone[1] == id);
}
/* Adds to what each saddle meets the mirror images of what its own image meets; pendulums with mirror symmetry. */
void kz_gates_pair(const kz_listed *attractors, const kz_listed *saddles, kz_gate *gate);
uint64_t kz_gates_alone(int64_t saddles, const kz_gate *gate);
