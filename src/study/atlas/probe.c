/* The attractors of a place: those that starts end on, as cycles of the atlas. */
#include "labelling/search.h"
#include "numerics/cells.h"
#include "numerics/steps.h"
#include "cycles.h"
#include "probe.h"

/* Starts near rest; steps a period. */
enum { NEAR_REST = 4, STEPS = 16 };
/* rad: a cycle lies so near to where it was guessed; a cycle is the same. */
static const double GUESSED = 0.1, ONE = 1e-6;
static const double FASTEST = 2.5, FEWEST_PERIODS = 600, MOST_PERIODS = 6000;

/* A closed cycle as what it is: rest, symmetric, or neither. */
static void set_symmetry(const kz_atlas *atlas, kz_cycle *cycle) {
  const int n = cycle->kind.points;
  const double *y = cycle->point[0], *half = cycle->point[n / 2];
  while (atlas->plane.half_period && kz_atlas_reduce(atlas, ONE, cycle)) continue;
  if (!atlas->plane.mirrored || cycle->kind.turns != 0) return;
  if (n == 1 && kz_atlas_apart(y, y, -1) < ONE) cycle->kind.rest = cos(y[0]) > 0 ? 1 : 2;
  if (n % 2 == 0 && kz_atlas_apart(y, half, -1) < ONE)
    cycle->kind = (kz_cycle_kind){.side = -1, .points = n / 2, .turns = (int32_t)rint((half[0] + y[0]) / (2 * M_PI))};
}

/* The trace of the map of which a cycle is a fixed point, in that of a multiplier of 1: of the half map, whose square
 * F^n is, by trace and determinant of F^n. */
static double probe_steepness(const kz_cycle_kind *kind, const double numbers[2]) {
  if (kind->side > 0) return fabs(numbers[0]) / (1 + numbers[1]);
  const double half = sqrt(numbers[1]);
  return sqrt(fmax(0, numbers[0] + 2 * half)) / (1 + half);
}

/* Lifts the angles of a cycle so that each point follows from the one before, and sets its turns. */
static bool probe_lift(const kz_plane *plane, kz_cycle *cycle) {
  const int n = cycle->kind.points;
  for (int i = 0; i < n; i++) {
    double step[4] = {cycle->point[i][0], cycle->point[i][1]}, *next = cycle->point[(i + 1) % n];
    if (!kz_curve_orbit(plane, cycle->place, 2, 1, step)) return false;
    const double whole = rint((step[2] - next[0]) / (2 * M_PI));
    if (i + 1 < n) next[0] += 2 * M_PI * whole;
    cycle->kind.turns = (int32_t)whole;
  }
  return true;
}

bool kz_atlas_identify(const kz_atlas *atlas, kz_cycle *cycle, double steepest) {
  const int n = cycle->kind.points;
  kz_cycle closed = *cycle;
  if (n > KZ_CURVE_POINTS || !probe_lift(&atlas->plane, &closed) || !kz_cycle_solve(&atlas->plane, &closed) ||
      kz_atlas_apart(closed.point[0], cycle->point[0], 1) > GUESSED)
    return false;
  const double numbers[2] = {closed.number[0], closed.number[1]};
  *cycle = closed;
  for (int d = 1; d < n; d++)
    if (n % d == 0 && kz_atlas_apart(closed.point[d], closed.point[0], 1) < ONE) {
      cycle->kind = (kz_cycle_kind){.side = 1, .points = d};
      return kz_atlas_identify(atlas, cycle, steepest);
    }
  KZ_AUTOFREE_BY(kz_atlas_seeds_free) kz_atlas_seeds one = {0};
  set_symmetry(atlas, &closed);
  if (!(probe_steepness(&closed.kind, numbers) < steepest)) return false;
  if (closed.kind.rest) {
    closed.point[0][0] = kz_kind_rest(&closed.kind), closed.point[0][1] = 0;
    *cycle = closed;
    return true;
  }
  if (!kz_atlas_add(atlas, &closed, &one)) return false;
  *cycle = one.list[0];
  return true;
}

kz_dynamics *kz_atlas_dynamics(const kz_atlas *atlas, const double place[2], int steps, kz_pendulum *pendulum) {
  kz_numerics numerics = kz_steps_plain();
  if (!kz_atlas_pendulum(atlas->scene, place, pendulum)) return NULL;
  numerics.steps_per_period = (int32_t)fmax(steps, kz_steps_by_stiffness(pendulum, steps));
  return kz_dynamics_create(pendulum, &numerics, atlas->scene->atlas->max_period);
}

/* Starts of a place, half-turns and velocity: some near rest, others over a window that gets trapping regions. */
static void probe_begin(kz_dynamics *dynamics, const kz_pendulum *pendulum, int64_t starts, int64_t seed,
                        double *state) {
  const double fastest = fmax(FASTEST, 1 + 2 * sqrt(kz_stiffness(pendulum)));
  const kz_window window = {-M_PI, M_PI, -fastest, fastest};
  const double rest[NEAR_REST] = {0.01, M_PI - 0.01, 0.3, M_PI - 0.3};
  kz_dynamics_starts(&window, seed, starts, state);
  for (int64_t i = 0; i < NEAR_REST && i < starts; i++) state[2 * i] = rest[i] / M_PI, state[2 * i + 1] = 0;
  kz_dynamics_regions(dynamics, 0, kz_dynamics_max_velocity(dynamics, &window));
}

/* The cycles that are known join those of the place. */
static void add_known(const kz_atlas *atlas, const kz_dynamics *dynamics, const double place[2],
                      kz_atlas_seeds *found) {
  for (int64_t number = 1; number <= kz_dynamics_count(dynamics); number++) {
    double theta[KZ_CURVE_POINTS], velocity[KZ_CURVE_POINTS];
    kz_attractor row;
    kz_dynamics_attractor(dynamics, number, &row);
    if (row.period < 1 || row.period > KZ_CURVE_POINTS) continue;
    kz_cycle cycle = {.kind = {.side = 1, .points = row.period}, .place = {place[0], place[1]}};
    kz_dynamics_strobe(dynamics, number, theta, velocity);
    for (int i = 0; i < row.period; i++) cycle.point[i][0] = theta[i], cycle.point[i][1] = velocity[i];
    if (kz_atlas_identify(atlas, &cycle, 1) && !kz_atlas_has(atlas, found->count, found->list, &cycle, ONE))
      kz_atlas_put(found, &cycle);
  }
}

/* From the mirror images of the attractors as starts: where a tilt or a torque breaks the mirror symmetry they often
 * lie in the basin of an attractor that few other starts reach. */
static kz_status discover_images(kz_dynamics *dynamics, int64_t most, const kz_atlas_seeds *found) {
  int64_t n = 0;
  KZ_AUTOFREE double *state = kz_malloc((size_t)(2 * KZ_CURVE_POINTS * found->count + 1) * sizeof *state);
  for (int64_t i = 0; i < found->count; i++)
    for (int j = 0; j < found->list[i].kind.points; j++, n++)
      kz_start_state(-found->list[i].point[j][0], -found->list[i].point[j][1], state + 2 * n);
  return kz_discover(NULL, dynamics, 0, most, n, state, NULL);
}

kz_status kz_atlas_probe_at(const kz_atlas *atlas, const double place[2], int64_t starts, int64_t seed,
                            kz_atlas_seeds *found) {
  kz_pendulum pendulum;
  KZ_AUTOFREE_BY(kz_dynamics_freed) kz_dynamics *dynamics = kz_atlas_dynamics(atlas, place, STEPS, &pendulum);
  *found = (kz_atlas_seeds){0};
  if (!dynamics) return KZ_OK;
  KZ_AUTOFREE double *state = kz_malloc(2 * (size_t)starts * sizeof *state);
  const int64_t most = (int64_t)fmin(MOST_PERIODS, fmax(FEWEST_PERIODS, 60 / (M_PI * pendulum.beta)));
  probe_begin(dynamics, &pendulum, starts, seed, state);
  KZ_TRY(kz_discover(NULL, dynamics, 0, most, starts, state, NULL));
  add_known(atlas, dynamics, place, found);
  if (kz_atlas_paired(atlas)) return KZ_OK;
  KZ_TRY(discover_images(dynamics, most, found));
  add_known(atlas, dynamics, place, found);
  return KZ_OK;
}
