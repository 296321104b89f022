/* The attractors of a place: starts are followed until they repeat themselves, and Newton's method finds their cycles. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "numerics/steps.h"
#include "atlas.h"

/* Drive periods between two looks; starts near rest; steps a period. */
enum { STRETCH = 60, NEAR_REST = 4, STEPS = 16 };
/* rad: a motion that returns so near has settled; it ends on a cycle that is so near; a cycle lies so near to where it was guessed; a cycle is
 * the same. */
static const double SETTLED = 1e-4, ENDS = 3e-3, GUESSED = 0.1, ONE = 1e-6;
static const double FASTEST = 2.5, FEWEST_PERIODS = 600, MOST_PERIODS = 6000;

/* The kind of a cycle of period n whose points are y: rest, symmetric, or neither. */
static kz_atlas_kind kind_of(const kz_atlas *atlas, int n, const double *y, const double *image) {
  kz_atlas_kind kind = {{1, n, 0, (int32_t)rint((image[0] - y[0]) / (2 * M_PI)), 0}, -1};
  if (!atlas->plane.mirrored || kind.of.turns != 0) return kind;
  if (n == 1 && kz_atlas_apart(y, y, -1) < ONE) kind.rest = cos(y[0]) > 0 ? 0 : 1;
  if (n % 2 == 0 && kz_atlas_apart(y, y + n, -1) < ONE)
    kind.of = (kz_curve_kind){-1, n / 2, 0, (int32_t)rint((y[n] + y[0]) / (2 * M_PI)), 0};
  return kind;
}

bool kz_atlas_identify(const kz_atlas *atlas, const double place[2], const double *state, int n, double steepest,
                       kz_atlas_seed *cycle) {
  double y[2 * KZ_CURVE_POINTS + 4] = {state[0], state[1]}, numbers[2], image[2];
  if (n > KZ_CURVE_POINTS || !kz_curve_orbit(&atlas->plane, place, n, y)) return false;
  const kz_curve_kind closed = {1, n, 0, (int32_t)rint((y[2 * n] - y[0]) / (2 * M_PI)), 0};
  y[2 * n] = place[0], y[2 * n + 1] = place[1];
  if (!kz_curve_solve(&atlas->plane, &closed, y, numbers) || kz_atlas_apart(y, state, 1) > GUESSED) return false;
  for (int d = 1; d < n; d++)
    if (n % d == 0 && kz_atlas_apart(y + 2 * d, y, 1) < ONE) return kz_atlas_identify(atlas, place, y, d, steepest, cycle);
  if (!(fabs(numbers[0]) < steepest * (1 + numbers[1]))) return false;
  image[0] = y[0] + 2 * M_PI * closed.turns, image[1] = y[1];
  const kz_atlas_kind kind = kind_of(atlas, n, y, image);
  kz_atlas_seeds one = {0};
  const int m = 2 * kind.of.points;
  y[m] = place[0], y[m + 1] = place[1];
  if (kind.rest >= 0)
    *cycle = (kz_atlas_seed){kind, {M_PI * kind.rest, 0, place[0], place[1]}};
  else if (kz_atlas_add(atlas, kind, y, &one))
    *cycle = one.list[0];
  else
    return false;
  kz_atlas_seeds_free(&one);
  return true;
}

/* The motions that are followed. */
typedef struct {
  int64_t n, *turns;
  double *theta, *velocity, *from;
} motions;

static void begin(const kz_pendulum *pendulum, int64_t starts, int64_t seed, motions *m) {
  const double fastest = fmax(FASTEST, 1 + 2 * sqrt(kz_stiffness(pendulum)));
  const kz_window window = {-M_PI, M_PI, -fastest, fastest};
  const double rest[NEAR_REST] = {0.01, M_PI - 0.01, 0.3, M_PI - 0.3};
  *m = (motions){starts, kz_calloc((size_t)starts, sizeof *m->turns), kz_malloc((size_t)starts * sizeof *m->theta),
                 kz_malloc((size_t)starts * sizeof *m->velocity), kz_malloc(2 * (size_t)starts * sizeof *m->from)};
  kz_dynamics_starts(&window, seed, starts, m->from);
  for (int64_t i = 0; i < starts; i++) {
    m->theta[i] = i < NEAR_REST ? rest[i] : M_PI * m->from[2 * i];
    m->velocity[i] = i < NEAR_REST ? 0 : m->from[2 * i + 1];
  }
}

static void end(motions *m) {
  free(m->turns);
  free(m->theta);
  free(m->velocity);
  free(m->from);
}

/* What a motion that returns after n periods ends on joins the cycles of the probe; true if it is one of them. */
static bool add_end(const kz_atlas *atlas, const double state[2], int n, kz_atlas_probe *probe) {
  kz_atlas_seed cycle;
  kz_atlas_seeds *found = &probe->found;
  for (int64_t i = 0; i < found->count; i++)
    if (n % kz_kind_period(&found->list[i].kind) == 0 && kz_atlas_same(atlas, found->list + i, state, ENDS)) return true;
  if (!kz_atlas_identify(atlas, probe->place, state, n, 1, &cycle)) return false;
  for (int64_t i = 0; i < found->count; i++)
    if (kz_atlas_same(atlas, found->list + i, cycle.y, ONE)) return true;
  kz_atlas_put(found, &cycle);
  return true;
}

/* Motions that repeat themselves within the longest period leave. */
static void look(const kz_atlas *atlas, const kz_flow *flow, motions *m, kz_atlas_probe *probe) {
  const int64_t longest = atlas->scene->atlas->max_period;
  int64_t left = 0;
  KZ_FREED int8_t *period = kz_calloc((size_t)m->n + 1, 1);
  KZ_FREED double *theta = kz_malloc((size_t)(m->n + 1) * sizeof *theta);
  KZ_FREED double *velocity = kz_malloc((size_t)(m->n + 1) * sizeof *velocity);
  memcpy(theta, m->theta, (size_t)m->n * sizeof *theta);
  memcpy(velocity, m->velocity, (size_t)m->n * sizeof *velocity);
  for (int n = 1; n <= longest; n++) {
    kz_advance(flow, m->n, 1, theta, velocity, m->turns);
    for (int64_t i = 0; i < m->n; i++)
      if (period[i] == 0 && hypot(remainder(theta[i] - m->theta[i], 2 * M_PI), velocity[i] - m->velocity[i]) < SETTLED)
        period[i] = (int8_t)n;
  }
  for (int64_t i = 0; i < m->n; i++) {
    const double state[2] = {m->theta[i], m->velocity[i]};
    if (period[i] > 0 && add_end(atlas, state, period[i], probe)) continue;
    m->theta[left] = m->theta[i];
    m->velocity[left++] = m->velocity[i];
  }
  m->n = left;
}

/* Follows motions until all have settled, for `most` periods at the longest. */
static void follow(const kz_atlas *atlas, const kz_flow *flow, double most, motions *m, kz_atlas_probe *probe) {
  for (double done = 0; done < most && m->n > 0; done += STRETCH) {
    kz_advance(flow, m->n, STRETCH, m->theta, m->velocity, m->turns);
    look(atlas, flow, m, probe);
  }
}

/* The mirror images of the attractors as starts: where a tilt or a torque breaks the mirror symmetry they often lie in the basin of an
 * attractor that few other starts reach. */
static void begin_images(const kz_atlas_probe *probe, motions *m) {
  size_t n = 1;
  for (int64_t i = 0; i < probe->found.count; i++) n += (size_t)probe->found.list[i].kind.of.points;
  *m = (motions){0, kz_calloc(n, sizeof *m->turns), kz_malloc(n * sizeof *m->theta), kz_malloc(n * sizeof *m->velocity), NULL};
  for (int64_t i = 0; i < probe->found.count; i++) {
    const kz_atlas_seed *cycle = probe->found.list + i;
    for (int j = 0; j < cycle->kind.of.points; j++, m->n++) {
      m->theta[m->n] = remainder(-cycle->y[2 * j], 2 * M_PI);
      m->velocity[m->n] = -cycle->y[2 * j + 1];
    }
  }
}

kz_status kz_atlas_probe_at(const kz_atlas *atlas, const double place[2], int64_t starts, int64_t seed, kz_atlas_probe *probe) {
  kz_pendulum pendulum;
  kz_numerics numerics = kz_steps_plain();
  KZ_FREED_BY(end) motions m = {0};
  KZ_FREED_BY(end) motions images = {0};
  *probe = (kz_atlas_probe){.place = {place[0], place[1]}, .starts = starts};
  if (!kz_atlas_pendulum(atlas->scene, place, &pendulum)) return KZ_OK;
  numerics.steps_per_period = (int32_t)fmax(STEPS, kz_steps_by_stiffness(&pendulum, STEPS));
  kz_flow *flow = kz_flow_create(&pendulum, &numerics);
  const double most = fmin(MOST_PERIODS, fmax(FEWEST_PERIODS, 60 / (M_PI * pendulum.beta)));
  begin(&pendulum, starts, seed, &m);
  follow(atlas, flow, most, &m, probe);
  if (!atlas->plane.mirrored) begin_images(probe, &images);
  follow(atlas, flow, most, &images, probe);
  kz_flow_free(flow);
  probe->unsettled = m.n;
  return KZ_OK;
}
