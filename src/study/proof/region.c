/* The region of a proof. First the ellipses of all attractors; then rounds in which every open cell of a grid is
 * followed into the region of the round before: the result does not depend on who follows which. */
#include "proof.h"

enum { COLUMNS = 250, MOST_ROWS = 8000 };
static const double ROWS = 116;       /* a rad per drive radian */
static const double SMALLEST = 1e-28; /* rad, rad per drive radian: of a cell, well above the rounding of its centre */
static const double LOWEST = 1.5,
                    HIGHEST = 3; /* rad per drive radian: least and largest reach of the grid; attractors are slow */
static const double GAIN = 0.01; /* Share of the cells: a round that adds less is the last */

static double top_of(const kz_scene *scene) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  return fmin(fmax(kz_axis_fastest(&scene->basin->velocity), LOWEST), HIGHEST) + 0.5 * kz_stiffness(pendulum);
}

static int64_t rows_of(const kz_scene *scene) {
  return 2 * (int64_t)ceil(fmin(ROWS * top_of(scene), MOST_ROWS));
}

double kz_proof_bytes(const kz_scene *scene) {
  return 2 * (double)rows_of(scene) * COLUMNS + 2e6;
}

kz_status kz_proof_begin(const kz_scene *scene, kz_proof **proof) {
  const kz_basin_plan *plan = scene->basin;
  *proof = NULL;
  if (!(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  if (fmin(kz_axis_step(&plan->theta), kz_axis_step(&plan->velocity)) < SMALLEST)
    return kz_fail(
        KZ_REFUSED,
        "basin.proof|basin.theta.width: cells below %.0e are too small for a proof in pairs of doubles; use wider "
        "cells, or leave basin.proof out",
        SMALLEST);
  const double fastest = kz_axis_fastest(&plan->velocity);
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  const kz_status status = kz_proof_create(pendulum, COLUMNS, rows_of(scene), top_of(scene), fastest, proof);
  if (status != KZ_REFUSED) return status;
  return kz_fail(KZ_REFUSED,
                 "basin.proof|basin.velocity: speeds of %.3g rad per drive radian are too fast for a proof with this "
                 "pendulum; leave "
                 "basin.proof out, or choose slower starts",
                 fastest);
}

/* Context of the tiles of a stage. */
typedef struct {
  const kz_dynamics *dynamics;
  bool mirrored; /* the pendulum has mirror symmetry */
  kz_proof *proof;
  kz_proved *proved;
} job;

/* An attractor's first strobe point and its ellipse. */
typedef struct {
  kz_proof_ellipse ellipse;
  double theta, velocity;
  int64_t mirror;
} seed;

/* The first strobe point of an attractor of some period. */
static void first_point(const kz_dynamics *dynamics, int64_t number, int64_t period, double point[2]) {
  KZ_AUTOFREE double *points = kz_calloc(2 * (size_t)period + 2, sizeof *points);
  kz_dynamics_strobe(dynamics, number, points, points + period + 1);
  point[0] = points[0];
  point[1] = points[period + 1];
}

/* Finds the ellipse of attractor tile + 1: the first of a mirrored pair, if the other is proved its image. */
static kz_status find_seed(void *context, int64_t tile, void *record) {
  const job *j = context;
  seed *s = record;
  kz_attractor attractor;
  double point[2], other[2];
  kz_dynamics_attractor(j->dynamics, tile + 1, &attractor);
  first_point(j->dynamics, tile + 1, attractor.period, point);
  s->mirror = j->mirrored ? attractor.mirror : tile + 1;
  s->theta = point[0];
  s->velocity = point[1];
  if (attractor.period <= 0 || s->mirror < tile + 1 || s->mirror > KZ_PROOF_MOST) return KZ_OK;
  s->ellipse = kz_proof_find_ellipse(j->proof, attractor.period, s->theta, s->velocity);
  first_point(j->dynamics, s->mirror, attractor.period, other);
  if (!kz_proof_is_mirror(j->proof, attractor.period, other, point, &s->ellipse)) s->ellipse.radius = 0;
  return KZ_OK;
}

static kz_status find_ellipses(const kz_run *run, job *j) {
  const int64_t count = kz_dynamics_count(j->dynamics), n = kz_smaller(count, KZ_PROOF_MOST);
  seed seeds[KZ_PROOF_MOST];
  kz_stage stage = kz_stage_for_all("proved ellipses", n, sizeof *seeds, find_seed, j);
  KZ_TRY(kz_stage_run(run, &stage, seeds));
  for (int64_t i = 0; i < n; i++) {
    const seed *s = &seeds[i];
    if (s->mirror > KZ_PROOF_MOST) continue;
    j->proved->mirror[i + 1] = (uint8_t)s->mirror;
    if (!(s->ellipse.radius > 0)) continue;
    j->proved->any = j->proved->has[i + 1] = j->proved->has[s->mirror] = true;
    kz_proof_add(j->proof, (uint8_t)(i + 1), (uint8_t)s->mirror, s->theta, s->velocity, &s->ellipse);
  }
  return KZ_OK;
}

static kz_status follow_row(void *context, int64_t row, void *record) {
  const job *j = context;
  kz_proof_cells(j->proof, row * COLUMNS, COLUMNS, record);
  return KZ_OK;
}

/* Tiles are rows. */
static kz_status region_grow(const kz_run *run, const job *j, uint8_t *label) {
  const int64_t own = kz_proof_own(j->proof);
  for (int round = 1;; round++) {
    char name[32];
    snprintf(name, sizeof name, "proof region %d", round);
    kz_stage stage = kz_stage_for_all(name, own / COLUMNS, COLUMNS, follow_row, (void *)j);
    KZ_TRY(kz_stage_run(run, &stage, label));
    if ((double)kz_proof_adopt(j->proof, label, j->proved->mirror) <= GAIN * (double)own) return KZ_OK;
  }
}

kz_status kz_prove_regions(const kz_window_labels *labelling, kz_proof *proof, kz_proved *proved) {
  const kz_run *run = labelling->run;
  job j = {labelling->dynamics, !labelling->plan->unmirrored, proof, proved};
  KZ_TRY(find_ellipses(run, &j));
  if (!proved->any) return KZ_OK;
  KZ_AUTOFREE uint8_t *label = kz_malloc((size_t)kz_proof_own(proof));
  return region_grow(run, &j, label);
}
