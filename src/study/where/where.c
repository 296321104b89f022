/* Where starts end: the catalogue of the scene's window, then every start in as much precision as it takes. One rank alone. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "attractors/catalogue.h"
#include "numerics/cells.h"
#include "labelling/labeller.h"
#include "attractors/search.h"
#include "labelling/starts.h"

typedef struct {
  const kz_scene *scene;
  kz_search search;
  kz_dynamics *dynamics;
  int64_t n;
  const double *start, *low; /* [n][2] rad, rad per drive radian */
  double *state;             /* [the larger of n and the search's starts][2] */
  int32_t *found;            /* [the same] */
  kz_start *asked;           /* [n] */
  kz_decision *decision;     /* [n] */
  int64_t *reached;          /* [numbers from 1] */
} asking;

static kz_status allocate(asking *a) {
  const int64_t most = a->n > a->search.starts ? a->n : a->search.starts;
  const kz_scene *scene = a->scene;
  a->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics,
                                   scene->has_basin ? scene->basin.max_period : scene->attractors.max_period);
  a->state = kz_malloc(2 * (size_t)most * sizeof *a->state);
  a->found = kz_malloc((size_t)most * sizeof *a->found);
  a->decision = kz_malloc((size_t)a->n * sizeof *a->decision);
  a->asked = kz_malloc((size_t)a->n * sizeof *a->asked);
  if (a->dynamics && a->state && a->found && a->decision && a->asked) return KZ_OK;
  return kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)most);
}

/* The attractors that the window's starts, and then those asked for, end on. */
static kz_status discover(asking *a) {
  a->search.max_velocity = kz_dynamics_max_velocity(a->dynamics, &a->search.window);
  KZ_TRY(kz_search_window(NULL, a->dynamics, &a->search, a->state, a->found));
  const int64_t searched = kz_dynamics_count(a->dynamics);
  int64_t *reached = kz_calloc((size_t)searched + 1, sizeof *reached);
  if (!reached) return kz_fail(KZ_FAILED, "no memory for the catalogue of attractors");
  for (int64_t i = 0; i < a->search.starts; i++) reached[a->found[i]]++;
  for (int64_t i = 0; i < a->n; i++) kz_start_state(a->start[2 * i], a->start[2 * i + 1], a->state + 2 * i);
  kz_status status = kz_discover(NULL, a->dynamics, a->search.max_periods, a->n, a->state, a->found);
  const int64_t known = kz_dynamics_count(a->dynamics);
  a->reached = kz_calloc((size_t)known + 1, sizeof *a->reached);
  if (status == KZ_OK && !a->reached) status = kz_fail(KZ_FAILED, "no memory for the catalogue of attractors");
  if (status == KZ_OK) memcpy(a->reached, reached, (size_t)(searched + 1) * sizeof *reached);
  free(reached);
  kz_dynamics_update(a->dynamics);
  return status;
}

static kz_status ask(asking *a) {
  const kz_labeller labeller = {
      .dynamics = a->dynamics, .max_periods = a->search.max_periods, .start = kz_start_of_array, .context = a->asked};
  for (int64_t i = 0; i < a->n; i++) {
    a->asked[i] = kz_start_at(a->start[2 * i], a->start[2 * i + 1]);
    if (a->low) a->asked[i].theta[1] = a->low[2 * i], a->asked[i].velocity[1] = a->low[2 * i + 1];
  }
  KZ_TRY(kz_label(&labeller, a->n, NULL, a->decision));
  for (int64_t i = 0; i < a->n; i++) {
    if (a->decision[i].label == KZ_DOUBTFUL) KZ_TRY(kz_label_candidates(&labeller, 1, &i, a->decision + i));
    a->reached[a->decision[i].label]++;
    a->reached[a->decision[i].other]++;
  }
  return KZ_OK;
}

/* Names of the levels of precision. */
static const char *const precision_names[] = {
    [KZ_LEVEL_DOUBLE] = "double",
    [KZ_LEVEL_FINE] = "double",
    [KZ_LEVEL_PAIRS_20] = "pairs",
    [KZ_LEVEL_PAIRS_28] = "pairs",
    [KZ_LEVEL_QUAD] = "quad",
    [KZ_LEVEL_ARBITRARY] = "arbitrary",
    [KZ_LEVELS] = NULL,
};

static kz_status describe_orbit(const kz_entry *entry, kz_ending *ending) {
  const size_t bytes = (size_t)entry->row.period * sizeof(double);
  memcpy(ending->name, entry->name, sizeof ending->name);
  ending->period = entry->row.period;
  ending->winding = entry->row.winding;
  ending->strobe_theta = kz_malloc(bytes + 1);
  ending->strobe_velocity = kz_malloc(bytes + 1);
  if (!ending->strobe_theta || !ending->strobe_velocity) return kz_fail(KZ_FAILED, "no memory for strobe points");
  memcpy(ending->strobe_theta, entry->theta, bytes);
  memcpy(ending->strobe_velocity, entry->velocity, bytes);
  return KZ_OK;
}

static kz_status describe_start(const asking *a, const kz_catalogue *catalogue, int64_t i, kz_ending *ending) {
  const kz_decision *d = a->decision + i;
  if (d->label <= 0) return KZ_OK;
  ending->attractor = catalogue->id_of[d->label];
  ending->settling_time = d->periods;
  ending->precision = precision_names[d->level];
  KZ_TRY(describe_orbit(catalogue->entries + ending->attractor, ending));
  if (ending->precision && ending->period > 0) ending->error = d->error;
  if (d->other <= 0) return KZ_OK;
  ending->other = catalogue->id_of[d->other];
  memcpy(ending->other_name, catalogue->entries[ending->other].name, sizeof ending->other_name);
  return KZ_OK;
}

static kz_status describe(const asking *a, kz_ending *endings) {
  kz_catalogue catalogue;
  kz_catalogue_make(a->dynamics, a->reached, &catalogue);
  kz_status status = KZ_OK;
  for (int64_t i = 0; status == KZ_OK && i < a->n; i++) status = describe_start(a, &catalogue, i, endings + i);
  kz_catalogue_free(&catalogue);
  return status;
}

kz_status kz_where(const kz_scene *scene, int64_t n, const double *start, const double *low, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) endings[i] = (kz_ending){.attractor = -1, .error = NAN, .other = -1};
  if (!scene->has_basin && !scene->has_attractors)
    return kz_fail(KZ_REFUSED, "scene: has no window to search for attractors; add a basin or attractors study to it");
  if (n == 0 || scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  asking a = {.scene = scene, .search = kz_search_of(scene), .n = n, .start = start, .low = low};
  kz_status status = allocate(&a);
  if (status == KZ_OK) status = discover(&a);
  if (status == KZ_OK) status = ask(&a);
  if (status == KZ_OK) status = describe(&a, endings);
  if (a.dynamics) kz_dynamics_free(a.dynamics);
  free(a.state);
  free(a.found);
  free(a.decision);
  free(a.asked);
  free(a.reached);
  return status;
}

void kz_where_free(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) {
    free(endings[i].strobe_theta);
    free(endings[i].strobe_velocity);
  }
}
