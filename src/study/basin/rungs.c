/* Method exact: the rungs of precision, from the scene's numerics up, each for the cells that the one below leaves doubtful; and the
 * candidates of those that none decides. */
#include <stdio.h>

#include "labelling/decide.h"
#include "label_parts.h"

typedef struct {
  const char *name; /* of its stages; the first one's are those of all cells */
  int64_t tile;     /* cells that it takes at a time, where it takes those that another one left */
  uint8_t evidence; /* of what it labels */
} rung;

static const rung rungs[KZ_RUNGS + 1] = {
    [KZ_RUNG_DOUBLE] = {"cells", 4096, KZ_FOLLOWED},
    [KZ_RUNG_PAIRS] = {"pairs", 512, KZ_IN_PAIRS},
    [KZ_RUNG_QUAD] = {"quad", KZ_FEW, KZ_IN_QUAD},
    [KZ_RUNGS] = {"candidates", KZ_FEW, KZ_UNDECIDED},
};

int64_t kz_rung_tile(int number) {
  return rungs[number].tile;
}

/* Cells that no rung decides. */
static void label_undecided(const kz_labelling *l, int64_t n, const double *start, int32_t *label, int64_t *periods,
                            kz_labelled *out) {
  int32_t other[KZ_FEW];
  kz_find_candidates(l->dynamics, l->plan->max_periods, n, start, label, periods, other);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_labelled){.periods = (uint32_t)periods[i],
                           .label = (int16_t)label[i],
                           .other = (int16_t)other[i],
                           .evidence = rungs[KZ_RUNGS].evidence};
}

void kz_rung_label(const kz_labelling *l, int64_t n, const double *start, const double *low, int32_t *label, int64_t *periods,
                   kz_labelled *out) {
  if (l->rung == KZ_RUNGS) {
    label_undecided(l, n, start, label, periods, out);
    return;
  }
  kz_dynamics_follow_errors(l->dynamics, l->rung, n, l->plan->max_periods, start, low, label, periods, NULL);
  for (int64_t i = 0; i < n; i++)
    out[i] = (kz_labelled){.periods = (uint32_t)periods[i], .label = (int16_t)label[i], .evidence = rungs[l->rung].evidence};
}

kz_status kz_rungs_climb(kz_labelling *l, int round) {
  char name[32];
  for (l->rung = 1; l->rung <= KZ_RUNGS; l->rung++) {
    KZ_TRY(kz_open_count(l, KZ_DOUBTFUL));
    if (l->before[l->tiles.own] == 0) break;
    snprintf(name, sizeof name, "%s %d", rungs[l->rung].name, round);
    KZ_TRY(kz_open_label(l, name));
  }
  l->rung = 0;
  return KZ_OK;
}
