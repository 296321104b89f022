#include "counted.h"

#include "routes.h"

/* Motions of a tile. */
enum { BATCH = 8 };

typedef struct {
  const kz_scene *scene;
  const kz_listed *attractors;
  const kz_run *run;
  int64_t batches; /* batches for an attractor and a temperature */
} work;

/* Lives of a tile: drive periods that were followed, and lives that ended. */
typedef struct {
  int64_t periods, ended;
} lives;

bool kz_escape_is_left(const kz_escape_plan *plan, const kz_listed *attractors, int64_t id) {
  bool named = plan->from.count == 0;
  for (int64_t i = 0; i < plan->from.count; i++) named = named || plan->from.values[i] == id;
  return named && attractors->period[id] > 0;
}

/* The angle of the undisturbed motion after `period` periods, on the line. */
static double undisturbed_angle(const kz_escape_cycle *cycle, int64_t period) {
  const int64_t phase = period % cycle->period;
  return cycle->end[phase].state[0] +
         2 * M_PI * (double)(cycle->turns[phase] + cycle->winding * (period / cycle->period));
}

static kz_status counted_live(const work *w, const kz_walker *walker, const kz_escape_cycle *cycle, uint64_t seed,
                              lives *sum) {
  const kz_escape_plan *plan = w->scene->escape;
  double theta = cycle->end[0].state[0], velocity = cycle->end[0].state[1];
  for (int64_t t = 0; t < plan->max_periods; t++) {
    kz_walker_advance(walker, seed, (uint64_t)t, &theta, &velocity);
    sum->periods++;
    if (t % 4096 == 0) KZ_TRY(kz_ranks_interrupted(w->run->ranks));
    if (fabs(theta - undisturbed_angle(cycle, t + 1)) > plan->angle) {
      sum->ended++;
      return KZ_OK;
    }
  }
  return KZ_OK;
}

/* Record: the lives of a batch. */
static kz_status count_tile(void *context, int64_t tile, void *record) {
  const work *w = context;
  const kz_escape_plan *plan = w->scene->escape;
  const int64_t batch = tile % w->batches, row = tile / w->batches;
  const int64_t id = row / plan->temperatures.count, temperature = row % plan->temperatures.count;
  if (!kz_escape_is_left(plan, w->attractors, id)) return KZ_OK;
  const kz_pendulum *pendulum = &w->scene->parameters.pendulum;
  kz_escape_flow flow = kz_escape_flow_of(pendulum);
  kz_escape_cycle cycle;
  const int64_t at = id * w->attractors->phases;
  const bool found = kz_escape_cycle_find(&flow, (int64_t)w->attractors->period[id], true, w->attractors->theta + at,
                                          w->attractors->velocity + at, &cycle);
  kz_walker *walker = kz_walker_create(pendulum, plan->temperatures.values[temperature], flow.samples);
  kz_status status = KZ_OK;
  for (int64_t i = batch * BATCH; i < plan->walkers && i < (batch + 1) * BATCH && found && status == KZ_OK; i++)
    status = counted_live(w, walker, &cycle, kz_path_hash((uint64_t)row, (uint64_t)i), record);
  kz_walker_free(walker);
  kz_escape_cycle_free(&cycle);
  kz_escape_flow_free(&flow);
  return status;
}

/* Chi-squared quantile / degrees of freedom (E. B. Wilson, M. M. Hilferty, PNAS 17 (1931) 684), normal z. */
static double chi_squared_share(double freedom, double z) {
  const double a = 2 / (9 * freedom), root = 1 - a + z * sqrt(a);
  return root * root * root;
}

static kz_status write_lives(const work *w, const lives *sum, kz_store *store, FILE *summary) {
  static const double Z = 1.959963984540054; /* normal quantile for 95 % */
  const kz_reals *temperatures = &w->scene->escape->temperatures;
  const int64_t n = w->attractors->count * temperatures->count;
#define MEAN(i) (sum[i].ended > 0 ? (double)sum[i].periods / (double)sum[i].ended : NAN)
#define END(i, z) (MEAN(i) / chi_squared_share(2 * (double)sum[i].ended, z))
  KZ_SCALE(store, "escape", "temperature", temperatures->count, temperatures->values[i]);
  KZ_COLUMN(store, "escape", "life", n, double, MEAN(i));
  KZ_COLUMN(store, "escape", "life_low", n, double, END(i, Z));
  KZ_COLUMN(store, "escape", "life_high", n, double, END(i, -Z));
  KZ_COLUMN(store, "escape", "life_ended", n, int32_t, sum[i].ended);
  for (int64_t i = 0; i < n; i++)
    if (sum[i].ended > 0)
      fprintf(summary,
              "Counted: attractor %lld lives %.4g periods at T = %g (%.4g to %.4g; %lld of %lld lives ended)\n",
              (long long)(i / temperatures->count), MEAN(i), temperatures->values[i % temperatures->count], END(i, Z),
              END(i, -Z), (long long)sum[i].ended, (long long)w->scene->escape->walkers);
  return KZ_OK;
}

kz_status kz_escape_count(const kz_scene *scene, const kz_run *run, const kz_listed *attractors, kz_store *store,
                          FILE *summary) {
  const kz_escape_plan *plan = scene->escape;
  const int64_t rows = attractors->count * plan->temperatures.count;
  if (rows == 0) return KZ_OK;
  work w = {scene, attractors, run, (plan->walkers + BATCH - 1) / BATCH};
  const kz_stage stage = kz_stage_for_rank0("lives", rows * w.batches, sizeof(lives), count_tile, &w);
  KZ_AUTOFREE lives *record = kz_calloc((size_t)(rows * w.batches) + 1, sizeof *record);
  KZ_AUTOFREE lives *sum = kz_calloc((size_t)rows + 1, sizeof *sum);
  KZ_TRY(kz_stage_run(run, &stage, record));
  for (int64_t i = 0; i < rows * w.batches; i++) {
    sum[i / w.batches].periods += record[i].periods;
    sum[i / w.batches].ended += record[i].ended;
  }
  return store ? write_lives(&w, sum, store, summary) : KZ_OK;
}
