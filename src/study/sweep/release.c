/* Releases from rest: how far from inverted the pendulum may be let go and still stay there. */
#include "sweep.h"

enum {
  SHORTEST = 300,
  LONGEST = 2000,     /* drive periods that a release is followed */
  HALF_DEGREES = 359, /* releases of the whole set: 0.5, 1.0, ... 179.5 degrees */
  FINER = 4,          /* how much denser an earlier gap is looked for */
  DEPTH = 3,          /* times, at most */
  BRACKET = 63        /* angles between the ends of a bracket when an edge is located, at most */
};
/* Transients have shrunk to exp(-this) after the periods that a release is followed. */
static const double SHRUNK = 6;
/* rad: an edge is located to this. */
static const double LOCATED = 1e-9;

/* Follows the releases period by period; one that is more than half a turn from inverted has gone over the bottom. */
void kz_sweep_releases(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *angle,
                       uint8_t *stays) {
  const double enough = pendulum->beta > 0 ? SHRUNK / (M_PI * pendulum->beta) : LONGEST;
  const int64_t periods = (int64_t)fmin(fmax(ceil(enough), SHORTEST), LONGEST);
  kz_flow *flow = kz_flow_create(pendulum, numerics);
  KZ_AUTOFREE double *theta = kz_malloc((size_t)n * sizeof *theta), *velocity = kz_calloc((size_t)n, sizeof *velocity);
  KZ_AUTOFREE int64_t *turns = kz_calloc((size_t)n, sizeof *turns), *number = kz_malloc((size_t)n * sizeof *number);
  int64_t left = n;
  for (int64_t i = 0; i < n; i++) {
    theta[i] = M_PI - angle[i];
    number[i] = i;
    stays[i] = 1;
  }
  for (int64_t period = 0; period < periods && left > 0; period++) {
    kz_advance(flow, left, 1, theta, velocity, turns);
    int64_t kept = 0;
    for (int64_t i = 0; i < left; i++) {
      if (fabs(theta[i] + 2 * M_PI * (double)turns[i] - M_PI) >= M_PI) {
        stays[number[i]] = 0;
        continue;
      }
      theta[kept] = theta[i];
      velocity[kept] = velocity[i];
      turns[kept] = turns[i];
      number[kept++] = number[i];
    }
    left = kept;
  }
  kz_flow_free(flow);
}

typedef struct {
  double first, scan, largest; /* rad from inverted */
  uint8_t stays[HALF_DEGREES];
} released;

static double half_degrees(int64_t i) {
  return (double)(i + 1) * (M_PI / 360);
}

/* The edge between a release that stays (inside) and one that fails (outside). Of several edges the one next to inside,
 * or with `outermost` the one next to outside. */
static double release_locate(const kz_pendulum *pendulum, const kz_numerics *numerics, double inside, double outside,
                             int points, bool outermost) {
  double angle[BRACKET];
  uint8_t stays[BRACKET];
  while (outside - inside > LOCATED) {
    const double step = (outside - inside) / (points + 1), from = inside;
    int first = outermost ? points : 0; /* index of the failing one */
    for (int i = 0; i < points; i++) angle[i] = from + step * (i + 1);
    kz_sweep_releases(pendulum, numerics, points, angle, stays);
    while (!outermost && first < points && stays[first]) first++;
    while (outermost && first > 0 && !stays[first - 1]) first--;
    if (first < points) outside = angle[first];
    if (first > 0) inside = angle[first - 1];
  }
  return inside;
}

/* The edge that plain bisection finds between the last whole degree that stays and the first that fails. */
static double release_scan(const kz_pendulum *pendulum, const kz_numerics *numerics, const uint8_t *stays) {
  int64_t degree = 1;
  while (2 * degree - 1 < HALF_DEGREES && stays[2 * degree - 1]) degree++;
  const double inside = (double)(degree - 1) * (M_PI / 180), outside = (double)degree * (M_PI / 180);
  return release_locate(pendulum, numerics, inside, outside, 1, false);
}

/* The first failure among multiples of `step` below `outside`, or `outside` itself. */
static double first_failure(const kz_pendulum *pendulum, const kz_numerics *numerics, double step, double outside) {
  const int64_t n = (int64_t)ceil(outside / step - 0.5) - 1;
  if (n < 1) return outside;
  KZ_AUTOFREE double *angle = kz_malloc((size_t)n * sizeof *angle);
  KZ_AUTOFREE uint8_t *stays = kz_malloc((size_t)n);
  for (int64_t i = 0; i < n; i++) angle[i] = (double)(i + 1) * step;
  kz_sweep_releases(pendulum, numerics, n, angle, stays);
  for (int64_t i = 0; i < n; i++)
    if (!stays[i]) return angle[i];
  return outside;
}

/* Where releases first fail. `outside` = the first failure of the scan; denser scans below it go on while they find
 * earlier gaps. */
static double find_first(const kz_pendulum *pendulum, const kz_numerics *numerics, double outside) {
  double step = half_degrees(0), before = INFINITY;
  for (int depth = 0; depth < DEPTH && outside <= before - FINER * step; depth++) {
    before = outside;
    step /= FINER;
    outside = first_failure(pendulum, numerics, step, outside);
  }
  return release_locate(pendulum, numerics, outside - step, outside, BRACKET, false);
}

static kz_status release_tile(void *context, int64_t tile, void *record) {
  const kz_scene *scene = context;
  released *out = record;
  kz_pendulum pendulum;
  double angle[HALF_DEGREES];
  out->first = out->scan = out->largest = NAN;
  if (!kz_sweep_pendulum(scene, kz_sweep_value(scene->sweep, tile), &pendulum)) return KZ_OK;
  for (int64_t i = 0; i < HALF_DEGREES; i++) angle[i] = half_degrees(i);
  kz_sweep_releases(&pendulum, &scene->numerics, HALF_DEGREES, angle, out->stays);
  int64_t first = 0, last = HALF_DEGREES - 1;
  while (first < HALF_DEGREES && out->stays[first]) first++;
  while (last >= 0 && !out->stays[last]) last--;
  out->first = find_first(&pendulum, &scene->numerics, half_degrees(first));
  out->scan = release_scan(&pendulum, &scene->numerics, out->stays);
  out->largest =
      last < 0 ? out->first
               : release_locate(&pendulum, &scene->numerics, half_degrees(last), half_degrees(last + 1), BRACKET, true);
  return KZ_OK;
}

#define COLUMN(name, expression) KZ_COLUMN(store, "sweep", name, n, double, expression)

static kz_status write_release(const kz_scene *scene, const void *all, kz_store *store, FILE *summary) {
  const released *records = all;
  const int64_t n = scene->sweep->values.count;
  COLUMN("release_angle", records[i].first);
  COLUMN("release_angle_scan", records[i].scan);
  COLUMN("release_angle_largest", records[i].largest);
  KZ_SCALE(store, "sweep", "release", HALF_DEGREES, half_degrees(i));
  KZ_COLUMN(store, "sweep", "release_stays", n * HALF_DEGREES, uint8_t,
            records[i / HALF_DEGREES].stays[i % HALF_DEGREES]);
  fprintf(summary,
          "releases from rest, degrees from inverted:\n         value  first gap  of whole degrees  last stays\n");
  for (int64_t i = 0; i < n; i++)
    fprintf(summary, "%14.9g  %9.4f  %16.4f  %10.4f\n",
            kz_axis_written(&scene->sweep->values, kz_sweep_value(scene->sweep, i)), records[i].first * 180 / M_PI,
            records[i].scan * 180 / M_PI, records[i].largest * 180 / M_PI);
  return KZ_OK;
}

kz_status kz_sweep_release(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_stage stage =
      kz_stage_for_rank0("sweep releases", scene->sweep->values.count, sizeof(released), release_tile, (void *)scene);
  return kz_sweep_stage(run, &stage, write_release, store, summary);
}
