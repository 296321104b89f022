#include "listed.h"

static kz_status read_columns(kz_store *store, const char *group, const kz_listed *m) {
  const int64_t n = m->count;
  KZ_TRY(kz_store_numbers(store, group, "period", n, m->period));
  KZ_TRY(kz_store_numbers(store, group, "mirror", n, m->mirror));
  KZ_TRY(kz_store_numbers(store, group, "strobe_theta", n * m->phases, m->theta));
  KZ_TRY(kz_store_numbers(store, group, "strobe_velocity", n * m->phases, m->velocity));
  return strcmp(group, "attractors") == 0 ? kz_store_numbers(store, group, "lyapunov", n, m->lyapunov) : KZ_OK;
}

static kz_status read_lengths(kz_store *store, const char *group, const char *dimension, kz_listed *m) {
  KZ_TRY(kz_store_length(store, group, dimension, &m->count));
  return kz_store_length(store, group, "phase", &m->phases);
}

kz_status kz_listed_read(const kz_run *run, kz_store *store, const char *group, const char *dimension,
                         kz_listed *motions) {
  kz_listed m = {0};
  *motions = m;
  KZ_TRY(kz_ranks_agree(run->ranks, store ? read_lengths(store, group, dimension, &m) : KZ_OK));
  KZ_TRY(kz_ranks_broadcast(run->ranks, &m, sizeof m));
  const size_t numbers = (size_t)(m.count * (3 + 2 * m.phases));
  m.period = kz_calloc(numbers + 1, sizeof(double));
  m.mirror = m.period + m.count;
  m.lyapunov = m.mirror + m.count;
  m.theta = m.lyapunov + m.count;
  m.velocity = m.theta + m.count * m.phases;
  *motions = m;
  KZ_TRY(kz_ranks_agree(run->ranks, store && m.count > 0 ? read_columns(store, group, &m) : KZ_OK));
  return kz_ranks_broadcast(run->ranks, m.period, numbers * sizeof(double));
}

void kz_listed_free(kz_listed *motions) {
  free(motions->period);
}

/* rad: strobe points of one attractor agree so well; and exponents of one chaotic attractor. */
static const double SAME = 1e-6;

/* Whether attractor `number` is this row of the file. */
static bool is_listed(const kz_dynamics *dynamics, int64_t number, const kz_listed *list, int64_t row) {
  kz_attractor attractor;
  kz_dynamics_attractor(dynamics, number, &attractor);
  if (attractor.period != (int32_t)list->period[row]) return false;
  if (attractor.period == 0) return fabs(attractor.lyapunov - list->lyapunov[row]) < SAME;
  const size_t period = (size_t)attractor.period;
  const double first[] = {list->theta[row * list->phases], list->velocity[row * list->phases]};
  KZ_AUTOFREE double *theta = kz_malloc(period * sizeof *theta), *velocity = kz_malloc(period * sizeof *velocity);
  kz_dynamics_strobe(dynamics, number, theta, velocity);
  for (size_t i = 0; i < period; i++)
    if (hypot(remainder(theta[i] - first[0], 2 * M_PI), velocity[i] - first[1]) < SAME) return true;
  return false;
}

void kz_listed_match(const kz_dynamics *dynamics, const kz_listed *list, int32_t *id) {
  const int64_t n = kz_dynamics_count(dynamics);
  KZ_AUTOFREE int64_t *order = kz_malloc((size_t)(n + 1) * sizeof *order);
  kz_dynamics_order(dynamics, order);
  for (int64_t i = 0; i <= n; i++) id[i] = -1;
  for (int64_t row = 0; row < list->count; row++) { /* in one order, which tells chaotic mirror images apart */
    int64_t i = 0;
    while (i < n && (id[order[i]] >= 0 || !is_listed(dynamics, order[i], list, row))) i++;
    if (i < n) id[order[i]] = (int32_t)row;
  }
}
