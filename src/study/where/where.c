/* Where starts end: the catalogue of the scene's window, then every start by direct integration, in quad precision, and from
 * four starts beside it. One rank alone. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/catalogue.h"
#include "common/cells.h"
#include "common/search.h"
#include "common/starts.h"

enum {
  BESIDE = 4,        /* starts beside each one */
  RUNS = BESIDE + 1, /* states that are followed for each start */
  CHUNK = 64         /* starts that are followed at a time */
};

typedef struct {
  const kz_scene *scene;
  kz_search search;
  kz_dynamics *dynamics;
  int64_t n;
  const double *start; /* [n][2] rad, rad per drive radian */
  double *state;       /* [the larger of n and the search's starts][2] */
  int32_t *found;      /* [the same] */
  int32_t *label;      /* [n] number of kz_dynamics, 0 = not settled */
  int64_t *reached;    /* [numbers from 1] */
} asking;

static kz_status allocate(asking *a) {
  const int64_t most = a->n > a->search.starts ? a->n : a->search.starts;
  const kz_scene *scene = a->scene;
  a->dynamics = kz_dynamics_create(&scene->parameters.pendulum, &scene->numerics,
                                   scene->has_basin ? scene->basin.max_period : scene->attractors.max_period);
  a->state = malloc(2 * (size_t)most * sizeof *a->state);
  a->found = malloc((size_t)most * sizeof *a->found);
  a->label = calloc((size_t)a->n, sizeof *a->label);
  if (a->dynamics && a->state && a->found && a->label) return KZ_OK;
  return kz_fail(KZ_FAILED, "no memory for %lld starts", (long long)most);
}

/* The attractors that the window's starts, and then those asked for, end on. */
static kz_status discover(asking *a) {
  a->search.max_velocity = kz_dynamics_max_velocity(a->dynamics, &a->search.window);
  KZ_TRY(kz_search_window(NULL, a->dynamics, &a->search, a->state, a->found));
  const int64_t searched = kz_dynamics_count(a->dynamics);
  int64_t *reached = calloc((size_t)searched + 1, sizeof *reached);
  if (!reached) return kz_fail(KZ_FAILED, "no memory for the catalogue of attractors");
  for (int64_t i = 0; i < a->search.starts; i++) reached[a->found[i]]++;
  for (int64_t i = 0; i < a->n; i++) kz_start_state(a->start[2 * i], a->start[2 * i + 1], a->state + 2 * i);
  kz_status status = kz_discover(NULL, a->dynamics, a->search.max_periods, a->n, a->state, a->found);
  const int64_t known = kz_dynamics_count(a->dynamics);
  a->reached = calloc((size_t)known + 1, sizeof *a->reached);
  if (status == KZ_OK && !a->reached) status = kz_fail(KZ_FAILED, "no memory for the catalogue of attractors");
  if (status == KZ_OK) memcpy(a->reached, reached, (size_t)(searched + 1) * sizeof *reached);
  free(reached);
  kz_dynamics_update(a->dynamics);
  return status;
}

/* The start, and the nearest ones that double precision can tell from it along each axis: a rounding of one half-turn, and one
 * of a velocity of 1 or of its own. */
static void spread(const double *start, double *state) {
  kz_start_state(start[0], start[1], state);
  for (int i = 1; i < RUNS; i++) memcpy(state + 2 * i, state, 2 * sizeof *state);
  const double least[2] = {DBL_EPSILON, DBL_EPSILON * fmax(1, fabs(state[1]))};
  for (int i = 0; i < BESIDE; i++) state[2 * (i + 1) + i / 2] += i % 2 ? least[i / 2] : -least[i / 2];
  for (int i = 1; i < RUNS; i++) state[2 * i] -= 2 * rint(state[2 * i] / 2);
}

static void ask(asking *a, int64_t first, int64_t n, kz_ending *endings) {
  double state[2 * RUNS * CHUNK];
  int32_t label[RUNS * CHUNK], reference[CHUNK];
  int64_t periods[RUNS * CHUNK], reference_periods[CHUNK];
  for (int64_t i = 0; i < n; i++) spread(a->start + 2 * (first + i), state + 2 * RUNS * i);
  kz_dynamics_follow(a->dynamics, KZ_FOLLOW_DIRECT, RUNS * n, a->search.max_periods, state, label, periods);
  kz_dynamics_follow_reference(a->dynamics, KZ_REFERENCE_STEPS, n, a->search.max_periods, a->start + 2 * first, reference,
                               reference_periods);
  for (int64_t i = 0; i < n; i++) {
    const int32_t own = label[RUNS * i];
    bool decided = own > 0 && reference[i] == own;
    for (int side = 1; side < RUNS; side++) decided = decided && label[RUNS * i + side] == own;
    a->label[first + i] = own;
    a->reached[own]++;
    endings[first + i] = (kz_ending){.attractor = -1, .settling_time = periods[RUNS * i], .decided = decided};
  }
}

static kz_status describe(const asking *a, kz_ending *endings) {
  kz_catalogue catalogue;
  kz_status status = kz_catalogue_make(a->dynamics, a->reached, &catalogue);
  for (int64_t i = 0; status == KZ_OK && i < a->n; i++) {
    kz_ending *ending = endings + i;
    ending->attractor = a->label[i] > 0 ? catalogue.id_of[a->label[i]] : -1;
    if (ending->attractor < 0) continue;
    const kz_entry *entry = catalogue.entries + ending->attractor;
    const size_t bytes = (size_t)entry->row.period * sizeof(double);
    memcpy(ending->name, entry->name, sizeof ending->name);
    ending->period = entry->row.period;
    ending->winding = entry->row.winding;
    ending->strobe_theta = malloc(bytes + 1);
    ending->strobe_velocity = malloc(bytes + 1);
    if (!ending->strobe_theta || !ending->strobe_velocity) status = kz_fail(KZ_FAILED, "no memory for strobe points");
    if (status != KZ_OK) break;
    memcpy(ending->strobe_theta, entry->theta, bytes);
    memcpy(ending->strobe_velocity, entry->velocity, bytes);
  }
  kz_catalogue_free(&catalogue);
  return status;
}

kz_status kz_where(const kz_scene *scene, int64_t n, const double *start, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) endings[i] = (kz_ending){.attractor = -1};
  if (!scene->has_basin && !scene->has_attractors)
    return kz_fail(KZ_REFUSED, "scene: has no window to search for attractors; add a basin or attractors study to it");
  if (n == 0 || scene->parameters.pendulum.beta <= 0) return KZ_OK; /* without damping nothing attracts */
  asking a = {.scene = scene, .search = kz_search_of(scene), .n = n, .start = start};
  kz_status status = allocate(&a);
  if (status == KZ_OK) status = discover(&a);
  for (int64_t first = 0; status == KZ_OK && first < n; first += CHUNK)
    ask(&a, first, n - first < CHUNK ? n - first : CHUNK, endings);
  if (status == KZ_OK) status = describe(&a, endings);
  if (a.dynamics) kz_dynamics_free(a.dynamics);
  free(a.state);
  free(a.found);
  free(a.label);
  free(a.reached);
  return status;
}

void kz_where_free(int64_t n, kz_ending *endings) {
  for (int64_t i = 0; i < n; i++) {
    free(endings[i].strobe_theta);
    free(endings[i].strobe_velocity);
  }
}
