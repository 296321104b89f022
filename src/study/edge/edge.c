/* Study `edge`: the saddle on the edge between the basins of two starts. The search for attractors is shared by all ranks, the edge is
 * followed as one tile. */
#include "edge.h"

#include <inttypes.h>
#include <math.h>

#include "labelling/catalogue.h"
#include "labelling/search.h"

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  int64_t max_periods;
} edge_job;

kz_cost kz_edge_cost(const kz_scene *scene) {
  const double bytes = 64 * ((double)scene->edge->periods + 1) + 40 * (double)kz_search_of(scene).starts;
  return (kz_cost){.disk_bytes = bytes, .memory_bytes = bytes};
}

/* Record: the edge, then its orbit [periods + 1][2]. */
static kz_status edge_tile(void *context, int64_t tile, void *record) {
  const edge_job *e = context;
  (void)tile;
  return kz_edge_track(e->scene, e->dynamics, e->max_periods, record, (double *)((kz_edge *)record + 1));
}

static void name_of(const edge_job *e, int32_t number, char name[KZ_NAME_LENGTH]) {
  kz_attractor row;
  snprintf(name, KZ_NAME_LENGTH, "not settled");
  if (number > 0) {
    kz_dynamics_attractor(e->dynamics, number, &row);
    kz_orbit_name(row.period, row.winding, row.centre, name);
  }
}

/* The id in the group saddles, -1 = not there. */
static kz_status saddle_of(const kz_edge *edge, kz_store *store, int64_t *saddle) {
  int64_t n = 0, phases = 0;
  *saddle = -1;
  KZ_TRY(kz_store_length(store, "saddles", "saddle", &n));
  KZ_TRY(kz_store_length(store, "saddles", "phase", &phases));
  for (int64_t i = 0; i < n; i++)
    for (int64_t phase = 0; phase < phases; phase++) {
      kz_strobe_point point;
      KZ_TRY(kz_strobe_read(store, "saddles", i, phase, &point));
      if (hypot(remainder(point.theta - edge->theta[0], 2 * M_PI), point.velocity - edge->velocity[0]) < 1e-8) *saddle = i;
    }
  return KZ_OK;
}

static kz_status write_group(const kz_edge *edge, const double *orbit, kz_store *store) {
  const int64_t n = edge->n_periods + 1;
  KZ_TRY(kz_store_dimension(store, "edge", "strobe", n, NULL));
  KZ_TRY(kz_store_dimension(store, "edge", "phase", edge->cycle.period, NULL));
  KZ_COLUMN(store, "edge", "theta", n, double, orbit[2 * i]);
  KZ_COLUMN(store, "edge", "velocity", n, double, orbit[2 * i + 1]);
  KZ_TRY(kz_store_variable(store, "edge", "strobe_theta", edge->theta));
  KZ_TRY(kz_store_variable(store, "edge", "strobe_velocity", edge->velocity));
  KZ_TRY(kz_store_integer(store, "edge", "period", edge->cycle.period));
  KZ_TRY(kz_store_integer(store, "edge", "winding", edge->cycle.winding));
  KZ_TRY(kz_store_real(store, "edge", "exponent", edge->exponent));
  for (int i = 0; edge->cycle.period > 0 && i < 2; i++) {
    char name[32];
    snprintf(name, sizeof name, "multiplier_%d_re", i + 1);
    KZ_TRY(kz_store_real(store, "edge", name, edge->cycle.multiplier_re[i]));
    snprintf(name, sizeof name, "multiplier_%d_im", i + 1);
    KZ_TRY(kz_store_real(store, "edge", name, edge->cycle.multiplier_im[i]));
  }
  return KZ_OK;
}

/* Writes the group edge, and prints the edge state and the attractors on its two sides. */
static kz_status publish(const edge_job *e, const kz_edge *edge, const double *orbit, kz_store *store, FILE *summary) {
  char first[KZ_NAME_LENGTH], second[KZ_NAME_LENGTH], name[KZ_NAME_LENGTH] = "no cycle", full[KZ_NAME_LENGTH + 10] = "";
  int64_t saddle;
  name_of(e, edge->first_end, first);
  name_of(e, edge->second_end, second);
  if (edge->cycle.period > 0) kz_orbit_name(edge->cycle.period, edge->cycle.winding, edge->cycle.centre, name);
  snprintf(full, sizeof full, "%s%s", edge->cycle.period > 0 ? "unstable " : "", name);
  KZ_TRY(write_group(edge, orbit, store));
  KZ_TRY(kz_store_text(store, "edge", "name", full));
  KZ_TRY(kz_store_text(store, "edge", "first_end", first));
  KZ_TRY(kz_store_text(store, "edge", "second_end", second));
  KZ_TRY(saddle_of(edge, store, &saddle));
  KZ_TRY(kz_store_integer(store, "edge", "saddle", saddle));
  fprintf(summary, "Edge between %s and %s: ", first, second);
  if (edge->cycle.period > 0)
    fprintf(summary,
            "%s of period %d at theta = %.10g, velocity = %.10g, with multipliers %.10g and %.3g, found after %" PRId64
            " periods.\n",
            full, edge->cycle.period, edge->theta[0], edge->velocity[0], edge->cycle.multiplier_re[0],
            edge->cycle.multiplier_re[1], edge->n_periods);
  else
    fprintf(summary,
            "no cycle of at most %" PRId64 " periods was found in %" PRId64
            " periods; the distance of the two sides grows by exp(%.4g) per period: %s.\n",
            e->scene->edge->max_period, edge->n_periods, edge->exponent,
            edge->exponent > 0 ? "a chaotic saddle, or a long cycle" : "not settled");
  return KZ_OK;
}

kz_status kz_edge_run(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const size_t bytes = sizeof(kz_edge) + 2 * ((size_t)scene->edge->periods + 1) * sizeof(double);
  const kz_search search = kz_search_of(scene);
  KZ_FREED_BY(kz_dynamics_freed)
  kz_dynamics *dynamics = kz_search_dynamics(scene);
  edge_job e = {scene, dynamics, search.max_periods};
  const kz_stage stage = kz_stage_for_rank0("edge", 1, bytes, edge_tile, &e);
  KZ_FREED kz_edge *record = kz_malloc(bytes);
  KZ_TRY(kz_search_window(run, dynamics, &search, NULL));
  KZ_TRY(kz_stage_run(run, &stage, record));
  return store ? publish(&e, record, (const double *)(record + 1), store, summary) : KZ_OK;
}
