#include "resilience.h"

const char *kz_sizes_lack(const kz_reals *sizes) {
  if (sizes->count < 1 || sizes->count > KZ_MOST_SHOCK_SIZES) return "sizes: must be a list of 1 to 16 sizes";
  for (int64_t i = 1; i < sizes->count; i++)
    if (!(sizes->values[i] > sizes->values[i - 1]))
      return "sizes: has a size that is not above the one before it; give sizes in rising order";
  return NULL;
}

typedef struct {
  kz_dynamics *dynamics;
  const kz_resilience_plan *plan;
  int64_t n;
  const kz_resilience *point; /* [n] */
  const int64_t *own;         /* places of the points that are searched */
} searching;

static const kz_shock NO_SHOCK = {NAN, NAN, NAN, -1};

kz_resilience *kz_resilience_list(const kz_dynamics *dynamics, const kz_catalogue *catalogue, int64_t *n) {
  const int64_t known = kz_dynamics_count(dynamics);
  int64_t capacity = 0, count = 0;
  for (int64_t id = 0; id < catalogue->count; id++) capacity += catalogue->entries[id].row.period;
  kz_resilience *point = kz_calloc((size_t)capacity + 1, sizeof *point);
  for (int64_t id = 0; id < catalogue->count; id++) {
    const kz_entry *entry = catalogue->entries + id;
    int64_t number = 1;
    while (number < known && catalogue->id_of[number] != id) number++;
    for (int64_t phase = 0; phase < entry->row.period; phase++)
      point[count++] = (kz_resilience){
          .number = number, .phase = phase, .theta = entry->theta[phase], .velocity = entry->velocity[phase]};
  }
  *n = count;
  return point;
}

/* A kz_ends_fn: by direct integration, which cannot fail. */
static void resilience_follow(void *context, int64_t n, const double *start, kz_label *end) {
  const searching *s = context;
  const kz_labeller labeller = kz_pair_labeller(start, s->plan->max_periods, KZ_BY_STATES, s->dynamics);
  (void)kz_label_first(&labeller, n, NULL, end);
}

static kz_shock_problem problem_at(searching *s, const kz_resilience *point) {
  return (kz_shock_problem){.ends = resilience_follow,
                            .context = s,
                            .from = {point->theta, point->velocity},
                            .own = (int32_t)point->number,
                            .scale = s->plan->scale,
                            .farthest = s->plan->farthest,
                            .tolerance = s->plan->tolerance};
}

static kz_status resilience_tile(void *context, int64_t tile, void *record) {
  searching *s = context;
  const kz_resilience *point = s->point + s->own[tile];
  kz_resilience *out = record;
  const kz_shock_problem problem = problem_at(s, point);
  *out = *point;
  kz_shocks_find(&problem, out->shock);
  for (int64_t i = 0; i < s->plan->sizes.count; i++)
    kz_shocks_harmless(&problem, s->plan->sizes.values[i], out->harmless + i);
  return KZ_OK;
}

/* The place of the mirror image of point i, itself where it has none before it. */
static int64_t image_of(const kz_resilience *point, int64_t i) {
  for (int64_t j = 0; j < i; j++) {
    const bool seam = point[i].theta == -M_PI && point[j].theta == -M_PI;
    if (point[j].velocity == -point[i].velocity && (seam || point[j].theta == -point[i].theta)) return j;
  }
  return i;
}

/* Shock of a point from the one of its mirror image. */
static void resilience_mirror(const kz_dynamics *dynamics, const kz_resilience *found, kz_resilience *point) {
  memcpy(point->harmless, found->harmless, sizeof point->harmless);
  for (int kind = 0; kind < 3; kind++) {
    const kz_shock *shock = found->shock + kind;
    kz_attractor row = {.mirror = shock->end};
    if (shock->end > 0) kz_dynamics_attractor(dynamics, shock->end, &row);
    point->shock[kind] = (kz_shock){-shock->theta, -shock->velocity, shock->size, (int32_t)row.mirror};
  }
}

/* Smallest shock of both over an attractor's strobe points, the tile's first: each bounds the next search. */
static kz_status smallest_tile(void *context, int64_t tile, void *record) {
  searching *s = context;
  const kz_resilience *first = s->point + s->own[tile];
  kz_resilience *out = record;
  *out = *first;
  for (int64_t i = s->own[tile]; i < s->n && s->point[i].number == first->number; i++) {
    const kz_shock_problem problem = problem_at(s, s->point + i);
    if (image_of(s->point, i) != i) continue; /* one of a motion that is its own mirror image */
    if (i == s->own[tile] || isnan(out->shock[2].size))
      kz_shocks_find(&problem, out->shock);
    else
      kz_shocks_nearer(&problem, out->shock + 2);
  }
  out->shock[0] = out->shock[1] = NO_SHOCK;
  return KZ_OK;
}

/* Lists points that mirror no others, own [n], and returns n; only first points if only the smallest counts. */
static int64_t list_own(const searching *s, int64_t *own) {
  int64_t count = 0;
  for (int64_t i = 0; i < s->n; i++)
    if (image_of(s->point, i) == i && !(s->plan->smallest && s->point[i].phase > 0)) own[count++] = i;
  return count;
}

kz_status kz_resilience_run(const kz_run *run, kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n,
                            kz_resilience *point) {
  KZ_AUTOFREE int64_t *own = kz_malloc((size_t)n * sizeof *own + 1);
  KZ_AUTOFREE kz_resilience *found = kz_malloc((size_t)n * sizeof *found + 1);
  searching s = {dynamics, plan, n, point, own};
  const kz_stage stage = kz_stage_for_all("shocks", list_own(&s, own), sizeof *point,
                                          plan->smallest ? smallest_tile : resilience_tile, &s);
  KZ_TRY(n > 0 ? kz_stage_run(run, &stage, found) : KZ_OK);
  for (int64_t i = 0; i < stage.n_tiles; i++) point[own[i]] = found[i];
  for (int64_t i = 0; i < n; i++) {
    const int64_t image = image_of(point, i), from = plan->smallest ? image - point[image].phase : image;
    if (plan->smallest && point[i].phase > 0)
      for (int kind = 0; kind < 3; kind++) point[i].shock[kind] = NO_SHOCK;
    else if (image != i)
      resilience_mirror(dynamics, point + from, point + i);
  }
  return KZ_OK;
}
