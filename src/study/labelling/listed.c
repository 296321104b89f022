#include "listed.h"

#include <stdlib.h>
#include <string.h>

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

kz_status kz_listed_read(const kz_run *run, kz_store *store, const char *group, const char *dimension, kz_listed *motions) {
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
