#include "resilience.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "labelling/labeller.h"

typedef struct {
  kz_dynamics *dynamics;
  const kz_resilience_plan *plan;
  const kz_resilience *point;
  const int64_t *own; /* places of the points that are searched */
} searching;

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
      point[count++] =
          (kz_resilience){.number = number, .phase = phase, .theta = entry->theta[phase], .velocity = entry->velocity[phase]};
  }
  *n = count;
  return point;
}

/* A kz_ends_fn: by direct integration. */
static void follow(void *context, int64_t n, const double *start, int32_t *end, int64_t *periods) {
  const searching *s = context;
  kz_follow_starts(s->dynamics, s->plan->max_periods, n, start, end, periods);
}

static kz_status resilience_tile(void *context, int64_t tile, void *record) {
  searching *s = context;
  const kz_resilience *point = s->point + s->own[tile];
  kz_resilience *out = record;
  const kz_shock_problem problem = {.ends = follow,
                                    .context = s,
                                    .from = {point->theta, point->velocity},
                                    .own = (int32_t)point->number,
                                    .scale = s->plan->scale,
                                    .farthest = s->plan->farthest};
  *out = *point;
  kz_shocks_find(&problem, out->shock);
  for (int64_t i = 0; i < s->plan->sizes.count; i++) kz_shocks_harmless(&problem, s->plan->sizes.values[i], out->harmless + i);
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

/* What holds for a point from what was found at its mirror image. */
static void mirror(const int32_t *mirrored, const kz_resilience *found, kz_resilience *point) {
  memcpy(point->harmless, found->harmless, sizeof point->harmless);
  for (int kind = 0; kind < 3; kind++) {
    const kz_shock *shock = found->shock + kind;
    point->shock[kind] =
        (kz_shock){-shock->theta, -shock->velocity, shock->size, shock->end > 0 ? mirrored[shock->end] : shock->end};
  }
}

/* mirrored [count + 1]: the number of each attractor's mirror image, to be freed. */
static int32_t *mirrors_of(const kz_dynamics *dynamics) {
  const int64_t n = kz_dynamics_count(dynamics);
  int32_t *mirrored = kz_calloc((size_t)n + 1, sizeof *mirrored);
  for (int64_t number = 1; number <= n; number++) {
    kz_attractor row;
    kz_dynamics_attractor(dynamics, number, &row);
    mirrored[number] = row.mirror;
  }
  return mirrored;
}

/* Runs the stage over the points that are not mirror images of others, then fills in those. */
static kz_status search(const kz_run *run, searching *s, int64_t n, int64_t *own, kz_resilience *found, kz_resilience *point) {
  int32_t *mirrored = mirrors_of(s->dynamics);
  int64_t n_own = 0;
  for (int64_t i = 0; i < n; i++)
    if (image_of(point, i) == i) own[n_own++] = i;
  const kz_stage stage = kz_stage_for_all("shocks", n_own, sizeof *point, resilience_tile, s);
  kz_status status = kz_stage_run(run, &stage, found);
  for (int64_t i = 0; status == KZ_OK && i < n_own; i++) point[own[i]] = found[i];
  for (int64_t i = 0; status == KZ_OK && i < n; i++)
    if (image_of(point, i) != i) mirror(mirrored, point + image_of(point, i), point + i);
  free(mirrored);
  return status;
}

kz_status kz_resilience_run(const kz_run *run, kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n,
                            kz_resilience *point) {
  if (n == 0) return KZ_OK;
  int64_t *own = kz_malloc((size_t)n * sizeof *own);
  kz_resilience *found = kz_malloc((size_t)n * sizeof *found);
  searching s = {dynamics, plan, point, own};
  const kz_status status = search(run, &s, n, own, found, point);
  free(own);
  free(found);
  return status;
}

kz_status kz_resilience_try(kz_dynamics *dynamics, const kz_resilience_plan *plan, int64_t n, const kz_resilience *point,
                            int64_t *own) {
  int64_t place = 0;
  kz_resilience found;
  *own = 0;
  for (int64_t i = 0; i < n; i++) *own += image_of(point, i) == i;
  for (int64_t i = 0, left = *own / 2; i < n && left >= 0; i++)
    if (image_of(point, i) == i && left-- == 0) place = i;
  searching s = {dynamics, plan, point, &place};
  return *own > 0 ? resilience_tile(&s, 0, &found) : KZ_OK;
}
