#include "gates.h"

#include "kapitza/dynamics_saddles.h"

/* rad: a branch begins so far from its saddle. */
static const double FIRST_DISTANCE = 1e-5;

kz_status kz_escape_label(const kz_escape_labels *labels, int round, int64_t n, const double *start, int32_t *id) {
  KZ_AUTOFREE kz_label *label = kz_calloc((size_t)n + 1, sizeof *label);
  kz_labeller labeller = kz_pair_labeller(start, labels->max_periods, KZ_BY_MARKS, labels->dynamics);
  labeller.run = labels->run;
  KZ_TRY(kz_label_items(&labeller, round, n, NULL, label));
  for (int64_t i = 0; i < n; i++) id[i] = label[i].label > 0 ? labels->id[label[i].label] : -1;
  return KZ_OK;
}

/* A point of a branch: over a piece that the map of the cycle moves to the next one. */
static void branch_point(const double state[2], const double away[2], double growth, int side, int i, double point[2]) {
  const double distance = FIRST_DISTANCE * pow(fabs(growth), (growth < 0 ? 2.0 : 1.0) * i / KZ_GATE_POINTS);
  for (int c = 0; c < 2; c++) point[c] = state[c] + (side ? -distance : distance) * away[c];
}

/* Whether a state is so near to the attractor that it ends there, at any phase of it. */
static bool is_caught(const kz_path_end *attractor, const double cycle[][4], const double *z) {
  static const double CAUGHT = 5e-3; /* rad */
  for (int64_t j = 0; j < attractor->period; j++)
    if (hypot(remainder(z[0] - cycle[j][0], 2 * M_PI), z[1] - cycle[j][1]) < CAUGHT) return true;
  return false;
}

bool kz_gate_borders(const kz_hamilton *flow, const kz_path_end *attractor, const kz_path_end *saddle) {
  enum { POINTS = 16, MOST_PERIODS = 4000 };
  static const double LEAVES = 12, APPROACHES = 8; /* e-foldings of the distances from the saddle and the attractor */
  const double slowest = kz_escape_slowest(attractor), period = (double)saddle->period;
  const double periods = fmin(LEAVES * period / log(fabs(saddle->growth)) + APPROACHES * slowest, MOST_PERIODS);
  KZ_AUTOFREE double (*cycle)[4] = kz_calloc((size_t)attractor->period, sizeof *cycle);
  double z[POINTS][4] = {{0}};
  bool caught[POINTS] = {false};
  int count = 0;
  for (int64_t j = 0; j < attractor->period; j++) {
    memcpy(cycle[j], j ? cycle[j - 1] : attractor->state, sizeof *cycle);
    if (j) kz_hamilton_advance(flow, 1, cycle[j], 0, NULL, 0, NULL);
  }
  for (int i = 0; i < POINTS; i++)
    branch_point(saddle->state, saddle->away, saddle->growth, i % 2, i / 2 * (2 * KZ_GATE_POINTS / POINTS), z[i]);
  for (int64_t t = 0; (double)t < periods && count < POINTS; t++) {
    kz_hamilton_advance(flow, POINTS, z[0], 0, NULL, 0, NULL);
    for (int i = 0; i < POINTS; i++) {
      if (caught[i]) continue;
      caught[i] = is_caught(attractor, (const double (*)[4])cycle, z[i]);
      count += caught[i];
    }
  }
  return count > 0 && count < POINTS;
}

static int32_t id_of_all(const int32_t *id) {
  for (int i = 1; i < KZ_GATE_POINTS; i++)
    if (id[i] != id[0]) return -1;
  return id[0];
}

kz_status kz_escape_labels_make(const kz_search *search, const kz_listed *attractors, kz_escape_labels *labels) {
  KZ_TRY(kz_search_window(labels->run, labels->dynamics, search, NULL));
  for (int64_t i = 0; i < attractors->count; i++)
    if (attractors->period[i] > 0)
      kz_dynamics_add_cycle(labels->dynamics, (int64_t)attractors->period[i], attractors->theta[i * attractors->phases],
                            attractors->velocity[i * attractors->phases]);
  kz_dynamics_update(labels->dynamics);
  kz_listed_match(labels->dynamics, attractors, labels->id);
  return KZ_OK;
}

kz_status kz_gates_find(const kz_escape_labels *labels, const kz_escape_flow *flow, const kz_listed *saddles,
                        kz_gate *gate) {
  const int64_t n = 2 * KZ_GATE_POINTS * saddles->count;
  KZ_AUTOFREE double (*point)[2] = kz_calloc((size_t)n + 1, sizeof *point);
  KZ_AUTOFREE int32_t *id = kz_calloc((size_t)n + 1, sizeof *id);
  for (int64_t s = 0; s < saddles->count; s++) {
    kz_path_end end;
    const int64_t at = s * saddles->phases;
    gate[s] = (kz_gate){.is_saddle = kz_path_end_find(flow->flow, (int64_t)saddles->period[s], false,
                                                      saddles->theta[at], saddles->velocity[at], &end),
                        .alone = {-1, -1}};
    if (!gate[s].is_saddle) continue;
    gate[s].period = end.period;
    gate[s].winding = end.winding;
    for (int c = 0; c < 2; c++) {
      gate[s].state[c] = end.state[c];
      gate[s].away[c] = end.away[c];
      gate[s].stable[c] = end.plane[c][0];
    }
    for (int i = 0; i < 2 * KZ_GATE_POINTS; i++)
      branch_point(end.state, end.away, end.growth, i / KZ_GATE_POINTS, i % KZ_GATE_POINTS,
                   point[2 * KZ_GATE_POINTS * s + i]);
  }
  KZ_TRY(kz_escape_label(labels, 0, n, point[0], id));
  for (int64_t s = 0; s < saddles->count; s++)
    for (int side = 0; side < 2 && gate[s].is_saddle; side++) {
      const int32_t *ids = id + KZ_GATE_POINTS * (2 * s + side);
      gate[s].alone[side] = id_of_all(ids);
      for (int i = 0; i < KZ_GATE_POINTS; i++) gate[s].meets |= ids[i] < 0 ? 0 : (uint64_t)1 << ids[i];
    }
  return KZ_OK;
}

void kz_gates_pair(const kz_listed *attractors, const kz_listed *saddles, kz_gate *gate) {
  for (int64_t s = 0; s < saddles->count; s++) {
    kz_gate *image = gate + (int64_t)saddles->mirror[s];
    uint64_t seen = 0;
    for (int64_t a = 0; a < attractors->count; a++) seen |= (gate[s].meets >> a & 1) << (int64_t)attractors->mirror[a];
    image->meets |= seen;
  }
}

uint64_t kz_gates_alone(int64_t saddles, const kz_gate *gate) {
  uint64_t alone = 0;
  for (int64_t s = 0; s < saddles; s++)
    for (int side = 0; side < 2; side++)
      if (gate[s].alone[side] >= 0 && gate[s].alone[0] != gate[s].alone[1]) alone |= (uint64_t)1 << gate[s].alone[side];
  return alone;
}
