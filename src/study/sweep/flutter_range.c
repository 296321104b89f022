/* The upper end of the flutter zone (BSG Fig. 4, dots) at each value: the drive m is raised from where flutter begins, once along
 * the cycle to its true end, once by releases from rest as the paper did. */
#include <math.h>

#include "sweep.h"

/* The drive is searched up to TOP, in steps of STEP; releases in steps of RELEASE_STEP. */
static const double TOP = 2, STEP = 0.01, RELEASE_STEP = 0.0005;
static const double RELEASE_ANGLE = M_PI / 180;
/* Locates the release limit to this. */
static const double LOCATED = 1e-6;

typedef struct {
  kz_flutter_drives cycle;
  double release_end; /* m; NaN = none */
} flutter_range;

/* The pendulum of a value with another drive. */
static bool pendulum_of_drive(const void *context, double m, kz_pendulum *pendulum) {
  *pendulum = *(const kz_pendulum *)context;
  pendulum->m = m;
  return true;
}

/* The direction (unit vector) in which the inverted state leaves by its most negative multiplier; false where it has none. */
static bool leaving_direction(const kz_pendulum *pendulum, double direction[2]) {
  kz_numerics fine;
  double theta = M_PI, velocity = 0, matrix[4];
  int64_t turns = 0;
  kz_numerics_fine(pendulum, &fine);
  kz_flow *flow = kz_flow_create(pendulum, &fine);
  if (!flow) return false;
  kz_advance_tangent(flow, 1, 1, &theta, &velocity, &turns, matrix);
  kz_flow_free(flow);
  const double half = (matrix[0] + matrix[3]) / 2, root = half * half - exp(-2 * M_PI * pendulum->beta);
  if (root < 0) return false;
  const double leaving = half - sqrt(root), length = hypot(matrix[1], leaving - matrix[0]);
  direction[0] = matrix[1] / length;
  direction[1] = (leaving - matrix[0]) / length;
  return leaving < -1 && length > 0;
}

bool kz_flutter_find(const kz_pendulum *pendulum, kz_attractor *flutter) {
  double direction[2];
  if (!leaving_direction(pendulum, direction)) return false;
  for (double size = 1e-3; size < 1.5; size *= 1.2) {
    const double guess[2] = {M_PI + size * direction[0], size * direction[1]};
    *flutter = (kz_attractor){.period = 2, .symmetric = 1};
    if (kz_cycle_near(pendulum, guess, size / 2, flutter) && flutter->centre == 1) return true;
  }
  return false;
}

/* The lowest drive at which a stable inverted state loses its stability by multiplier -1. */
static double find_onset(const kz_path *path) {
  double critical = NAN;
  for (double m = 0; m < TOP && isnan(critical); m += STEP) critical = kz_flutter_critical(path, m, m + STEP);
  return critical;
}

static bool find_flutter(const kz_path *path, double onset, double *m, kz_attractor *flutter) {
  kz_pendulum pendulum;
  for (double above = 1e-4; above < 2e-2; above *= 2) {
    *m = onset + above;
    if (path->pendulum(path->context, *m, &pendulum) && kz_flutter_find(&pendulum, flutter)) return true;
  }
  return false;
}

/* One of the two asymmetric cycles that replace a symmetric one just above m: searched from points displaced by growing
 * distances in eight directions. */
static bool find_asymmetric(const kz_path *path, double m, const kz_attractor *symmetric, double *at, kz_attractor *found) {
  kz_pendulum pendulum;
  for (double above = 1e-5; above < 5e-3; above *= 2)
    for (double size = 1e-3; size < 0.3; size *= 1.3)
      for (int i = 0; i < 8; i++) {
        const double guess[2] = {symmetric->theta + size * cos(i * M_PI / 4), symmetric->velocity + size * sin(i * M_PI / 4)};
        *found = (kz_attractor){.period = symmetric->period};
        *at = m + above;
        path->pendulum(path->context, *at, &pendulum);
        if (kz_cycle_near(&pendulum, guess, size, found)) return true; /* the symmetric one repels there */
      }
  return false;
}

/* The drive up to which the cycle at m exists and attracts, in steps so short that it is not taken for another one far above. */
static double walk_up(const kz_path *path, double m, kz_attractor *cycle, int32_t *end_kind) {
  for (double next = m; m == next && m < TOP;) {
    next = fmin(m + STEP, TOP);
    m = kz_walk(path, m, next, cycle, end_kind);
  }
  return m;
}

/* Along the cycle: where it loses its mirror symmetry, and where the cycles that take over end. */
static void follow_cycle(const kz_path *path, kz_flutter_drives *range) {
  kz_attractor flutter, asymmetric;
  int32_t end_kind;
  double m;
  if (!find_flutter(path, range->onset, &m, &flutter)) return;
  const double last = walk_up(path, m, &flutter, &end_kind);
  if (last == TOP || end_kind != KZ_END_SYMMETRY_BREAKING) return;
  range->asymmetry = last;
  if (!find_asymmetric(path, last, &flutter, &m, &asymmetric)) return;
  range->end = walk_up(path, m, &asymmetric, &end_kind);
}

static bool release_stays(const kz_path *path, const kz_numerics *numerics, double m) {
  kz_pendulum pendulum;
  uint8_t stays;
  path->pendulum(path->context, m, &pendulum);
  kz_release_from_rest(&pendulum, numerics, 1, &RELEASE_ANGLE, &stays);
  return stays;
}

/* Raises the drive from the onset until a release fails, then halves the bracket. */
static void follow_releases(const kz_path *path, const kz_numerics *numerics, flutter_range *range) {
  double inside = range->cycle.onset, outside = RELEASE_STEP * ceil(inside / RELEASE_STEP);
  for (; outside < TOP && release_stays(path, numerics, outside); outside += RELEASE_STEP) inside = outside;
  if (outside >= TOP) return;
  while (outside - inside > LOCATED) {
    const double middle = (inside + outside) / 2;
    *(release_stays(path, numerics, middle) ? &inside : &outside) = middle;
  }
  range->release_end = outside;
}

kz_flutter_drives kz_flutter_drives_find(const kz_pendulum *pendulum) {
  const kz_path path = {pendulum_of_drive, pendulum};
  kz_flutter_drives drives = {NAN, NAN, NAN};
  if (pendulum->beta <= 0) return drives;
  drives.onset = find_onset(&path);
  if (!isnan(drives.onset)) follow_cycle(&path, &drives);
  return drives;
}

static kz_status flutter_range_tile(void *context, int64_t tile, void *record) {
  const kz_scene *scene = context;
  flutter_range *range = record;
  kz_pendulum pendulum;
  const kz_path path = {pendulum_of_drive, &pendulum};
  *range = (flutter_range){{NAN, NAN, NAN}, NAN};
  if (!kz_sweep_pendulum(scene, kz_sweep_value(scene->sweep, tile), &pendulum)) return KZ_OK;
  range->cycle = kz_flutter_drives_find(&pendulum);
  if (!isnan(range->cycle.onset)) follow_releases(&path, &scene->numerics, range);
  return KZ_OK;
}

static void print_cell(FILE *summary, int width, int digits, double value) {
  if (isnan(value))
    fprintf(summary, "  %*s", width, "-");
  else
    fprintf(summary, "  %*.*f", width, digits, value);
}

#define COLUMN(name, expression) KZ_COLUMN(store, "sweep", name, n, double, expression)

static kz_status write_ranges(const kz_scene *scene, const void *records, kz_store *store, FILE *summary) {
  const flutter_range *ranges = records;
  const int64_t n = scene->sweep->values.count;
  COLUMN("flutter_onset", ranges[i].cycle.onset);
  COLUMN("flutter_asymmetry", ranges[i].cycle.asymmetry);
  COLUMN("flutter_end", ranges[i].cycle.end);
  COLUMN("flutter_release_end", ranges[i].release_end);
  fprintf(summary, "flutter zone over m    value        begins  1 deg release fails  asymmetric from  period doubles at\n");
  for (int64_t i = 0; i < n; i++) {
    fprintf(summary, "%28.9g", kz_axis_written(&scene->sweep->values, kz_sweep_value(scene->sweep, i)));
    print_cell(summary, 12, 9, ranges[i].cycle.onset);
    print_cell(summary, 19, 6, ranges[i].release_end);
    print_cell(summary, 15, 9, ranges[i].cycle.asymmetry);
    print_cell(summary, 17, 9, ranges[i].cycle.end);
    fputc('\n', summary);
  }
  return KZ_OK;
}

kz_status kz_sweep_flutter_range(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary) {
  const kz_stage stage = kz_stage_for_rank0("sweep flutter zone", scene->sweep->values.count, sizeof(flutter_range),
                                            flutter_range_tile, (void *)scene);
  return kz_sweep_stage(run, &stage, write_ranges, store, summary);
}
