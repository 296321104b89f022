/* The share of a window that ends on the same attractor whatever the phase of release: every cell is labelled at phases of the drive that
 * are spread evenly over a period. Attractors and trapping regions are the same at all of them. A tile is some cells at one phase. */
#include <math.h>

#include "basin.h"

enum { BLOCK = 16384 };

typedef struct {
  const kz_basin_plan *plan;
  kz_dynamics *dynamics;
  kz_release release; /* of the scene */
  int64_t cells, blocks;
} phases;

static phases phases_of(const kz_scene *scene, kz_dynamics *dynamics) {
  const int64_t cells = scene->basin.theta.count * scene->basin.velocity.count;
  return (phases){.plan = &scene->basin,
                  .dynamics = dynamics,
                  .release = scene->parameters.release,
                  .cells = cells,
                  .blocks = (cells + BLOCK - 1) / BLOCK};
}

static double phase_at(const phases *p, int64_t i) {
  return 2 * M_PI * (double)i / (double)p->plan->phases;
}

/* Labels n cells from `first` on, out [n]: numbers of kz_dynamics, 0 = not settled or not decided. */
static kz_status label_some(const phases *p, double phase, int64_t first, int64_t n, int16_t *out) {
  const kz_labeller labeller = kz_cell_labeller(p->plan, p->dynamics);
  kz_release release = p->release;
  KZ_FREED kz_decision *decision = kz_malloc((size_t)n * sizeof *decision);
  KZ_FREED int64_t *cell = kz_malloc((size_t)n * sizeof *cell);
  for (int64_t i = 0; i < n; i++) cell[i] = first + i;
  release.phase = phase;
  kz_dynamics_set_release(p->dynamics, &release);
  const kz_status status = kz_label(&labeller, n, cell, decision);
  for (int64_t i = 0; status == KZ_OK && i < n; i++) out[i] = decision[i].label > 0 ? (int16_t)decision[i].label : 0;
  kz_dynamics_set_release(p->dynamics, &p->release);
  return status;
}

static kz_status phase_tile(void *context, int64_t tile, void *record) {
  const phases *p = context;
  const int64_t first = tile % p->blocks * BLOCK, left = p->cells - first;
  return label_some(p, phase_at(p, tile / p->blocks), first, left < BLOCK ? left : BLOCK, record);
}

/* Label of a cell at a phase, of the records. */
static int16_t label_at(const phases *p, const int16_t *label, int64_t phase, int64_t cell) {
  return label[(phase * p->blocks + cell / BLOCK) * BLOCK + cell % BLOCK];
}

/* How many different ends a cell has: attractors, and one more where it has not settled or is not decided. */
static int64_t ends_of(const phases *p, const int16_t *label, int64_t cell) {
  int64_t ends = 0;
  for (int64_t i = 0; i < p->plan->phases; i++) {
    int64_t before = 0;
    while (before < i && label_at(p, label, before, cell) != label_at(p, label, i, cell)) before++;
    ends += before == i;
  }
  return ends;
}

/* The attractor in which a cell ends at all phases; 0 = there is none. */
static int16_t common_end(const phases *p, const int16_t *label, int64_t cell) {
  return ends_of(p, label, cell) == 1 ? label_at(p, label, 0, cell) : 0;
}

/* The id in the file; -1 = none. */
static int32_t id_at(const kz_catalogue *catalogue, int16_t number) {
  return number > 0 ? catalogue->id_of[number] : -1;
}

static double share_of(const phases *p, const int16_t *label, const kz_catalogue *catalogue, int64_t phase, int64_t id) {
  int64_t count = 0;
  for (int64_t cell = 0; cell < p->cells; cell++) count += id_at(catalogue, label_at(p, label, phase, cell)) == id;
  return (double)count / (double)p->cells;
}

static kz_status write_group(const phases *p, const int16_t *label, const kz_catalogue *catalogue, kz_store *store,
                             FILE *summary) {
  const int64_t n = p->plan->phases, known = catalogue->count;
  int64_t alike = 0;
  KZ_SCALE(store, "phases", "phase", n, phase_at(p, i));
  KZ_SCALE(store, "phases", "velocity", p->plan->velocity.count, kz_axis_centre(&p->plan->velocity, i));
  KZ_SCALE(store, "phases", "theta", p->plan->theta.count, kz_axis_centre(&p->plan->theta, i));
  KZ_TRY(kz_store_dimension(store, "phases", "attractor", known, NULL));
  KZ_COLUMN(store, "phases", "fraction", n * known, double, share_of(p, label, catalogue, i / known, i % known));
  KZ_COLUMN(store, "phases", "common", p->cells, int16_t, id_at(catalogue, common_end(p, label, i)));
  KZ_COLUMN(store, "phases", "ends", p->cells, uint8_t, ends_of(p, label, i));
  for (int64_t cell = 0; cell < p->cells; cell++) alike += common_end(p, label, cell) > 0;
  fprintf(summary, "Released at %lld phases of the drive, %.4g %% of the cells end alike at all of them.\n", (long long)n,
          100.0 * (double)alike / (double)p->cells);
  return kz_store_real(store, "phases", "share", (double)alike / (double)p->cells);
}

static kz_stage stage_of(phases *p) {
  return kz_stage_for_rank0("phases", p->blocks * p->plan->phases, BLOCK * sizeof(int16_t), phase_tile, p);
}

kz_status kz_phases_find(const kz_scene *scene, const kz_window_labels *labelling, const kz_catalogue *catalogue,
                         kz_store *store, FILE *summary) {
  if (scene->basin.phases <= 0) return KZ_OK;
  phases p = phases_of(scene, labelling->dynamics);
  const kz_stage stage = stage_of(&p);
  KZ_FREED int16_t *label = kz_malloc((size_t)stage.n_tiles * stage.record_bytes);
  kz_status status = kz_stage_run(labelling->run, &stage, label);
  if (status == KZ_OK && store) status = write_group(&p, label, catalogue, store, summary);
  return kz_ranks_agree(labelling->run->ranks, status);
}

kz_status kz_phases_measure(const kz_scene *scene, kz_dynamics *dynamics, double *seconds) {
  if (scene->basin.phases <= 0) return KZ_OK;
  phases p = phases_of(scene, dynamics);
  const kz_stage stage = stage_of(&p);
  return kz_stage_measure(&stage, 2, 1.0, seconds);
}

double kz_phases_bytes(const kz_basin_plan *plan) {
  return plan->phases > 0 ? 2.0 * (double)plan->phases * ((double)(plan->theta.count * plan->velocity.count) + BLOCK) : 0;
}
