/* Attractors of kz_dynamics and their ids in the file. */
#include <math.h>
#include <stdlib.h>

#include "labelling/catalogue.h"
#include "wada.h"

/* rad: strobe points of one attractor agree so well; and exponents of one chaotic attractor. */
static const double SAME = 1e-6;

/* A row of the file. */
typedef struct {
  kz_strobe_point first; /* its point is NaN of a chaotic one */
  double lyapunov, mirror;
} listed;

static kz_status read_list(kz_store *store, int64_t n, listed *list) {
  for (int64_t i = 0; i < n; i++) {
    KZ_TRY(kz_strobe_read(store, "attractors", i, 0, &list[i].first));
    KZ_TRY(kz_store_number(store, "attractors", "lyapunov", &i, &list[i].lyapunov));
    KZ_TRY(kz_store_number(store, "attractors", "mirror", &i, &list[i].mirror));
  }
  return KZ_OK;
}

/* Whether attractor `number` is the one of this row. */
static bool is_listed(const kz_dynamics *dynamics, int64_t number, const listed *row) {
  kz_attractor attractor;
  kz_dynamics_attractor(dynamics, number, &attractor);
  if (attractor.period != (int32_t)row->first.period) return false;
  if (attractor.period == 0) return fabs(attractor.lyapunov - row->lyapunov) < SAME;
  const size_t period = (size_t)attractor.period;
  KZ_FREED double *theta = kz_malloc(period * sizeof *theta), *velocity = kz_malloc(period * sizeof *velocity);
  kz_dynamics_strobe(dynamics, number, theta, velocity);
  for (size_t i = 0; i < period; i++)
    if (hypot(remainder(theta[i] - row->first.theta, 2 * M_PI), velocity[i] - row->first.velocity) < SAME) return true;
  return false;
}

/* Both lists have one order, which tells chaotic mirror images apart. */
static void set_ids(const kz_dynamics *dynamics, const listed *list, kz_file_attractors *attractors) {
  const int64_t n = kz_dynamics_count(dynamics);
  KZ_FREED int64_t *order = kz_malloc((size_t)(n + 1) * sizeof *order);
  kz_dynamics_order(dynamics, order);
  for (int64_t i = 0; i <= n; i++) attractors->id[i] = -1;
  for (int64_t row = 0; row < attractors->count; row++) {
    int64_t i = 0;
    attractors->mirror[row] = (int32_t)list[row].mirror;
    while (i < n && (attractors->id[order[i]] >= 0 || !is_listed(dynamics, order[i], list + row))) i++;
    if (i < n) attractors->id[order[i]] = (int32_t)row;
  }
}

kz_status kz_file_attractors_match(const kz_run *run, kz_store *store, kz_dynamics *dynamics, kz_file_attractors *attractors) {
  int64_t n = 0;
  KZ_TRY(kz_ranks_agree(run->ranks, store ? kz_store_length(store, "attractors", "attractor", &n) : KZ_OK));
  KZ_TRY(kz_ranks_broadcast(run->ranks, &n, sizeof n));
  KZ_FREED listed *list = kz_calloc((size_t)n + 1, sizeof *list);
  KZ_TRY(kz_ranks_agree(run->ranks, store ? read_list(store, n, list) : KZ_OK));
  KZ_TRY(kz_ranks_broadcast(run->ranks, list, ((size_t)n + 1) * sizeof *list));
  const int64_t known = kz_dynamics_count(dynamics);
  for (int64_t i = 0; i < n; i++)
    if (list[i].first.period > 0)
      kz_dynamics_add_cycle(dynamics, (int64_t)list[i].first.period, list[i].first.theta, list[i].first.velocity);
  if (kz_dynamics_count(dynamics) > known) kz_dynamics_update(dynamics);
  attractors->count = n;
  set_ids(dynamics, list, attractors);
  return KZ_OK;
}
