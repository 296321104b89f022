/* Bifurcation diagram: the strobe points after a transient, once with the values going up and once down. Each walk
 * carries its state from value to value, so that it shows where attractors are lost and not found again. */
#include "sweep.h"

enum { WALKS = 2 };
/* rad: a motion that has come to rest is pushed this much at each value, or rounding would hold it where it is no
 * longer stable. */
static const double PUSH = 1e-6;

/* Drive periods of a tile: about a second. */
enum { LEG_PERIODS = 100000 };

typedef struct {
  double theta, velocity;
} strobe_state;

/* Both walks on their way; a tile carries one of them through one leg: some values, or a part of a long transient. */
typedef struct {
  const kz_scene *scene;
  strobe_state state[WALKS];
  int64_t first, values; /* values of the leg, in the order of the walk */
  int64_t skip;          /* periods of the transient, which begins at the first value where `pushed` */
  bool pushed;
  int64_t samples; /* at each value; 0 = the transient goes on */
} walking;

/* Value of a step of a walk. */
static int64_t value_at(const kz_sweep_plan *plan, int64_t strobe_walk, int64_t step) {
  return strobe_walk == 0 ? step : plan->values.count - 1 - step;
}

/* out: [samples] angles, then velocities. */
static void record_value(const walking *w, const kz_flow *map, bool pushed, strobe_state *state, double *out) {
  int64_t turns = 0;
  if (pushed) state->theta += PUSH;
  kz_advance(map, 1, w->skip, &state->theta, &state->velocity, &turns);
  for (int64_t s = 0; s < w->samples; s++) {
    kz_advance(map, 1, 1, &state->theta, &state->velocity, &turns);
    out[s] = state->theta >= M_PI ? -M_PI : state->theta;
    out[w->samples + s] = state->velocity;
  }
}

/* record: the state after the leg, then [values][2][samples] angles and velocities. */
static kz_status strobe_tile(void *context, int64_t tile, void *record) {
  const walking *w = context;
  const kz_sweep_plan *plan = w->scene->sweep;
  strobe_state state = w->state[tile];
  double *out = (double *)((strobe_state *)record + 1);
  for (int64_t i = 0; i < w->values && w->first + i < plan->values.count; i++, out += 2 * w->samples) {
    kz_pendulum pendulum;
    if (!kz_sweep_pendulum(w->scene, kz_sweep_value(plan, value_at(plan, tile, w->first + i)), &pendulum)) continue;
    kz_flow *map = kz_flow_create(&pendulum, &w->scene->numerics);
    record_value(w, map, i > 0 || w->pushed, &state, out);
    kz_flow_free(map);
  }
  *(strobe_state *)record = state;
  return KZ_OK;
}

/* One leg of both walks; its points go to their places in `points` [walks][values][2][samples]. */
static kz_status run_leg(walking *w, const kz_run *run, double *points) {
  const kz_sweep_plan *plan = w->scene->sweep;
  const size_t value = (size_t)(2 * w->samples) * sizeof(double);
  const kz_stage stage =
      kz_stage_for_all("sweep strobe", WALKS,
                       sizeof(strobe_state) + (size_t)(w->values * 2 * w->samples) * sizeof(double), strobe_tile, w);
  KZ_AUTOFREE char *records = kz_malloc(WALKS * stage.record_bytes);
  KZ_TRY(kz_stage_run(run, &stage, records));
  for (int64_t walk_values = 0; walk_values < WALKS; walk_values++) {
    const char *record = records + (size_t)walk_values * stage.record_bytes;
    memcpy(w->state + walk_values, record, sizeof *w->state);
    for (int64_t i = 0; w->samples > 0 && i < w->values && w->first + i < plan->values.count; i++)
      memcpy(points + (walk_values * plan->values.count + value_at(plan, walk_values, w->first + i)) * 2 * w->samples,
             record + sizeof(strobe_state) + (size_t)i * value, value);
  }
  return KZ_OK;
}

/* All values, in legs. */
static kz_status strobe_walk_of(const kz_scene *scene, const kz_run *run, double *points) {
  const kz_sweep_plan *plan = scene->sweep;
  const strobe_state start = {plan->start_theta, plan->start_velocity};
  const int64_t at_once = LEG_PERIODS / (plan->transient + plan->samples);
  walking w = {.scene = scene, .state = {start, start}, .values = at_once > 0 ? at_once : 1};
  for (w.first = 0; w.first < plan->values.count; w.first += w.values) {
    int64_t left = plan->transient;
    for (w.pushed = true, w.samples = 0, w.skip = LEG_PERIODS; left > LEG_PERIODS;
         left -= LEG_PERIODS, w.pushed = false)
      KZ_TRY(run_leg(&w, run, NULL));
    w.skip = left;
    w.samples = plan->samples;
    KZ_TRY(run_leg(&w, run, points));
  }
  return KZ_OK;
}

/* The walks side by side: [values][up, then down]. */
static kz_status write_strobe(const kz_scene *scene, const double *points, kz_store *store, FILE *summary) {
  const int64_t values = scene->sweep->values.count, samples = scene->sweep->samples, all = WALKS * samples;
#define POINT(coordinate) points[((i % all / samples * values + i / all) * 2 + coordinate) * samples + i % samples]
  KZ_TRY(kz_store_dimension(store, "sweep", "sample", all, NULL));
  KZ_COLUMN(store, "sweep", "sample_walk", all, int8_t, i / samples);
  KZ_COLUMN(store, "sweep", "strobe_theta", values * all, double, POINT(0));
  KZ_COLUMN(store, "sweep", "strobe_velocity", values * all, double, POINT(1));
  fprintf(summary, "strobe points of %lld periods at each value, up and down\n", (long long)samples);
  return KZ_OK;
}

kz_status kz_sweep_strobe(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  KZ_AUTOFREE double *points =
      kz_calloc((size_t)(WALKS * scene->sweep->values.count * 2 * scene->sweep->samples), sizeof *points);
  KZ_TRY(strobe_walk_of(scene, run, points));
  return kz_ranks_agree(run->ranks, store ? write_strobe(scene, points, store, summary) : KZ_OK);
}
