/* Releases from rest: how far from inverted the pendulum may be let go and still stay there. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sweep.h"

enum {
  SHORTEST = 300,
  LONGEST = 2000,     /* drive periods that a release is followed */
  HALF_DEGREES = 359, /* releases of the whole set: 0.5, 1.0, ... 179.5 degrees */
  FINER = 4,          /* how much denser an earlier gap is looked for */
  DEPTH = 3,          /* times, at most */
  BRACKET = 63        /* angles between the ends of a bracket when an edge is located */
};
/* Transients have shrunk to exp(-this) after the periods that a release is followed. */
static const double SHRUNK = 6;
/* rad: an edge is located to this. */
static const double LOCATED = 1e-9;

/* Follows the releases period by period; one that is more than half a turn from inverted has gone over the bottom. */
kz_status kz_release_from_rest(const kz_pendulum *pendulum, const kz_numerics *numerics, int64_t n, const double *angle,
                               uint8_t *stays) {
  const double enough = pendulum->beta > 0 ? SHRUNK / (M_PI * pendulum->beta) : LONGEST;
  const int64_t periods = (int64_t)fmin(fmax(ceil(enough), SHORTEST), LONGEST);
  kz_flow *flow = kz_flow_create(pendulum, numerics);
  double *theta = kz_malloc((size_t)n * sizeof *theta), *velocity = kz_calloc((size_t)n, sizeof *velocity);
  int64_t *turns = kz_calloc((size_t)n, sizeof *turns), *number = kz_malloc((size_t)n * sizeof *number), left = n;
  const bool ready = flow && theta && velocity && turns && number;
  for (int64_t i = 0; ready && i < n; i++) {
    theta[i] = M_PI - angle[i];
    number[i] = i;
    stays[i] = 1;
  }
  for (int64_t period = 0; ready && period < periods && left > 0; period++) {
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
  if (flow) kz_flow_free(flow);
  free(theta);
  free(velocity);
  free(turns);
  free(number);
  return KZ_OK;
}

typedef struct {
  double first, scan, largest; /* rad from inverted */
  uint8_t stays[HALF_DEGREES];
} released;

static double half_degrees(int64_t i) {
  return (double)(i + 1) * (M_PI / 360);
}

/* The edge between a release that stays (inside) and one that fails (outside). Of several edges the one next to inside, or with
 * `outermost` the one next to outside. */
static kz_status locate(const kz_pendulum *pendulum, const kz_numerics *numerics, double inside, double outside, bool outermost,
                        double *edge) {
  double angle[BRACKET];
  uint8_t stays[BRACKET];
  while (outside - inside > LOCATED) {
    const double step = (outside - inside) / (BRACKET + 1), from = inside;
    int first = outermost ? BRACKET : 0; /* that fails */
    for (int i = 0; i < BRACKET; i++) angle[i] = from + step * (i + 1);
    KZ_TRY(kz_release_from_rest(pendulum, numerics, BRACKET, angle, stays));
    while (!outermost && first < BRACKET && stays[first]) first++;
    while (outermost && first > 0 && !stays[first - 1]) first--;
    if (first < BRACKET) outside = angle[first];
    if (first > 0) inside = angle[first - 1];
  }
  *edge = inside;
  return KZ_OK;
}

/* The edge that plain bisection finds between the last whole degree that stays and the first that fails: a paper's scan. */
static kz_status scan(const kz_pendulum *pendulum, const kz_numerics *numerics, const uint8_t *stays, double *edge) {
  int64_t degree = 1;
  while (2 * degree - 1 < HALF_DEGREES && stays[2 * degree - 1]) degree++;
  double inside = (double)(degree - 1) * (M_PI / 180), outside = (double)degree * (M_PI / 180);
  while (outside - inside > LOCATED) {
    const double middle = (inside + outside) / 2;
    uint8_t here;
    KZ_TRY(kz_release_from_rest(pendulum, numerics, 1, &middle, &here));
    *(here ? &inside : &outside) = middle;
  }
  *edge = inside;
  return KZ_OK;
}

/* The first failure among multiples of `step` below `outside`, or `outside` itself. */
static kz_status first_failure(const kz_pendulum *pendulum, const kz_numerics *numerics, double step, double *outside) {
  const int64_t n = (int64_t)ceil(*outside / step - 0.5) - 1;
  if (n < 1) return KZ_OK;
  double *angle = kz_malloc((size_t)n * sizeof *angle);
  uint8_t *stays = kz_malloc((size_t)n);
  kz_status status = KZ_OK;
  for (int64_t i = 0; status == KZ_OK && i < n; i++) angle[i] = (double)(i + 1) * step;
  if (status == KZ_OK) status = kz_release_from_rest(pendulum, numerics, n, angle, stays);
  for (int64_t i = n - 1; status == KZ_OK && i >= 0; i--)
    if (!stays[i]) *outside = angle[i];
  free(angle);
  free(stays);
  return status;
}

/* Where releases first fail. `outside` = the first failure of the scan; denser scans below it go on while they find earlier
 * gaps. */
static kz_status find_first(const kz_pendulum *pendulum, const kz_numerics *numerics, double outside, double *first) {
  double step = half_degrees(0), before = INFINITY;
  for (int depth = 0; depth < DEPTH && outside <= before - FINER * step; depth++) {
    before = outside;
    step /= FINER;
    KZ_TRY(first_failure(pendulum, numerics, step, &outside));
  }
  return locate(pendulum, numerics, outside - step, outside, false, first);
}

static kz_status release_tile(void *context, int64_t tile, void *record) {
  const kz_scene *scene = context;
  released *out = record;
  kz_pendulum pendulum;
  double angle[HALF_DEGREES];
  out->first = out->scan = out->largest = NAN;
  if (!kz_sweep_pendulum(scene, kz_sweep_value(&scene->sweep, tile), &pendulum)) return KZ_OK;
  for (int64_t i = 0; i < HALF_DEGREES; i++) angle[i] = half_degrees(i);
  KZ_TRY(kz_release_from_rest(&pendulum, &scene->numerics, HALF_DEGREES, angle, out->stays));
  int64_t first = 0, last = HALF_DEGREES - 1;
  while (first < HALF_DEGREES && out->stays[first]) first++;
  while (last >= 0 && !out->stays[last]) last--;
  KZ_TRY(find_first(&pendulum, &scene->numerics, half_degrees(first), &out->first));
  KZ_TRY(scan(&pendulum, &scene->numerics, out->stays, &out->scan));
  out->largest = out->first;
  if (last < 0) return KZ_OK;
  return locate(&pendulum, &scene->numerics, half_degrees(last), half_degrees(last + 1), true, &out->largest);
}

static kz_status write_set(const kz_scene *scene, const released *records, kz_store *store) {
  const int64_t n = scene->sweep.values.count;
  double angle[HALF_DEGREES];
  uint8_t *stays = kz_malloc((size_t)n * HALF_DEGREES);
  for (int64_t i = 0; i < HALF_DEGREES; i++) angle[i] = half_degrees(i);
  for (int64_t i = 0; i < n; i++) memcpy(stays + i * HALF_DEGREES, records[i].stays, HALF_DEGREES);
  kz_status status = kz_store_dimension(store, "sweep", "release", HALF_DEGREES, angle);
  if (status == KZ_OK) status = kz_store_variable(store, "sweep", "release_stays", stays);
  free(stays);
  return status;
}

#define COLUMN(name, expression) KZ_COLUMN(store, "sweep", name, scene->sweep.values.count, double, expression)

static kz_status write_release(const kz_scene *scene, const void *all, kz_store *store, FILE *summary) {
  const released *records = all;
  COLUMN("release_angle", records[i].first);
  COLUMN("release_angle_scan", records[i].scan);
  COLUMN("release_angle_largest", records[i].largest);
  KZ_TRY(write_set(scene, records, store));
  fprintf(summary, "releases from rest, degrees from inverted:\n         value  first gap  of whole degrees  last stays\n");
  for (int64_t i = 0; i < scene->sweep.values.count; i++)
    fprintf(summary, "%14.9g  %9.4f  %16.4f  %10.4f\n", kz_sweep_value(&scene->sweep, i), records[i].first * 180 / M_PI,
            records[i].scan * 180 / M_PI, records[i].largest * 180 / M_PI);
  return KZ_OK;
}

static kz_stage stage_of(const kz_scene *scene) {
  return (kz_stage){.name = "sweep releases",
                    .n_tiles = scene->sweep.values.count,
                    .record_bytes = sizeof(released),
                    .work = release_tile,
                    .context = (void *)scene,
                    .keep = true};
}

kz_status kz_sweep_release_measure(const kz_scene *scene, double *seconds) {
  const kz_stage stage = stage_of(scene);
  return kz_stage_measure(&stage, 8, 1.0, seconds);
}

kz_status kz_sweep_release(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_stage stage = stage_of(scene);
  return kz_sweep_stage(run, &stage, write_release, store, summary);
}
