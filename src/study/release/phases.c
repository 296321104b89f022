#include "phases.h"

enum { BLOCK = 16384 };

double kz_phase_at(const kz_phases *p, int64_t i) {
  return 2 * M_PI * (double)i / (double)p->phases;
}

static int64_t blocks_of(int64_t n) {
  return (n + BLOCK - 1) / BLOCK;
}

/* Items at one phase: a row. */
static kz_status label_at_phase(void *context, int64_t first, int64_t n, void *record) {
  const kz_phases *p = context;
  kz_release release = p->release;
  int16_t *out = record;
  KZ_AUTOFREE kz_label *label = kz_malloc((size_t)n * sizeof *label);
  KZ_AUTOFREE int64_t *item = kz_malloc((size_t)n * sizeof *item);
  for (int64_t i = 0; i < n; i++) item[i] = first % p->n + i;
  release.phase = kz_phase_at(p, first / p->n);
  kz_dynamics_set_release(p->labeller.dynamics, &release);
  const kz_status status = kz_label_items(&p->labeller, 1, n, item, label);
  for (int64_t i = 0; status == KZ_OK && i < n; i++) out[i] = label[i].label > 0 ? label[i].label : 0;
  kz_dynamics_set_release(p->labeller.dynamics, &p->release);
  return status;
}

bool kz_phases_fold(const kz_pendulum *pendulum, const kz_release *release, int64_t phases) {
  return kz_pairing_symmetry(pendulum) == KZ_SYMMETRY_HALF_PERIOD && phases % 2 == 0 && !(release->periods > 0);
}

/* Phases at which items are followed. */
static int64_t own_phases(const kz_phases *p) {
  return p->folded ? p->phases / 2 : p->phases;
}

kz_status kz_phases_label(kz_phases *p, const kz_run *run) {
  const int64_t known = kz_dynamics_count(p->labeller.dynamics);
  const kz_stage stage =
      kz_stage_of_rows(p->stage, own_phases(p), p->n, BLOCK, BLOCK * sizeof(int16_t), label_at_phase, p);
  p->label = kz_rank(run->ranks) == 0 ? kz_malloc((size_t)stage.n_tiles * stage.record_bytes) : NULL;
  p->image = kz_calloc((size_t)known + 1, sizeof *p->image);
  for (int64_t i = 1; i <= known; i++) {
    kz_attractor row;
    kz_dynamics_attractor(p->labeller.dynamics, i, &row);
    p->image[i] = (int16_t)row.mirror;
  }
  return kz_stage_run(run, &stage, p->label);
}

void kz_phases_free(kz_phases *p) {
  free(p->label);
  free(p->image);
}

double kz_phases_bytes(int64_t phases, int64_t n) {
  return phases > 0 ? 2.0 * (double)phases * (double)(n + BLOCK) : 0;
}

int16_t kz_phases_at(const kz_phases *p, int64_t phase, int64_t item) {
  if (phase >= own_phases(p)) return p->image[kz_phases_at(p, phase - own_phases(p), p->n - 1 - item)];
  return p->label[(phase * blocks_of(p->n) + item / BLOCK) * BLOCK + item % BLOCK];
}

int64_t kz_phases_ends(const kz_phases *p, int64_t item) {
  int64_t ends = 0;
  for (int64_t i = 0; i < p->phases; i++) {
    int64_t before = 0;
    while (before < i && kz_phases_at(p, before, item) != kz_phases_at(p, i, item)) before++;
    ends += before == i;
  }
  return ends;
}

int16_t kz_phases_common(const kz_phases *p, int64_t item) {
  return kz_phases_ends(p, item) == 1 ? kz_phases_at(p, 0, item) : 0;
}
