/* Trapping regions that are proved. First the ellipses of all attractors; then, on a coarse grid and two finer ones, rounds in which
 * every open cell is followed among the cells that were proved before the round: the result does not depend on who follows which. */
#include "proof.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "numerics/cells.h"

enum { COLUMNS = 250, LEVELS = 3, MOST_ROWS = 8000 };
static const double ROWS = 116;     /* of the coarse grid, a rad per drive radian */
static const double SECONDS = 2e-5; /* a cell of the finest grid: measured */
static const double SLOWEST = 1.5;  /* rad per drive radian: as far reaches the grid at least, for the attractors */
static const double GAIN = 0.002;   /* of the cells: a round that adds less is the last of its grid */

static double top_of(const kz_scene *scene) {
  const kz_pendulum *pendulum = &scene->parameters.pendulum;
  return fmax(kz_axis_fastest(&scene->basin.velocity), SLOWEST) + 0.5 * kz_stiffness(pendulum);
}

static int64_t rows_of(const kz_scene *scene) {
  return 2 * (int64_t)ceil(fmin(ROWS * top_of(scene), MOST_ROWS));
}

static double finest_cells(const kz_scene *scene) {
  return (double)rows_of(scene) * COLUMNS * pow(4, LEVELS - 1);
}

double kz_proof_bytes(const kz_scene *scene) {
  return scene->basin.proof ? 2 * finest_cells(scene) : 0;
}

double kz_proof_seconds(const kz_scene *scene) {
  return scene->basin.proof ? SECONDS * finest_cells(scene) : 0;
}

kz_status kz_proof_plan(const kz_scene *scene, kz_proof **proof) {
  *proof = NULL;
  if (!scene->basin.proof || !(scene->parameters.pendulum.beta > 0)) return KZ_OK;
  const double top = top_of(scene);
  const kz_status status = kz_proof_create(&scene->parameters.pendulum, COLUMNS, rows_of(scene), top, proof);
  if (status != KZ_REFUSED) return status;
  return kz_fail(
      KZ_REFUSED,
      "basin.proof|basin.velocity: speeds of %.3g rad per drive radian are too fast for a proof under this pendulum; leave "
      "basin.proof out, or choose slower starts",
      top);
}

/* What the tiles of a stage need. */
typedef struct {
  const kz_dynamics *dynamics;
  kz_proof *proof;
  int64_t tile_cells;
} job;

/* An attractor's first strobe point and its ellipse. */
typedef struct {
  kz_proof_ellipse ellipse;
  double theta, velocity;
  int64_t mirror;
} seed;

/* The ellipse of attractor tile + 1, for the first one of a mirrored pair. */
static kz_status find_seed(void *context, int64_t tile, void *record) {
  const job *j = context;
  seed *s = record;
  kz_attractor attractor;
  const size_t most = (size_t)kz_dynamics_packed_size(j->dynamics);
  double *point = kz_calloc(2 * most, sizeof *point);
  if (!point) return kz_fail(KZ_FAILED, "no memory for the points of a cycle");
  kz_dynamics_attractor(j->dynamics, tile + 1, &attractor, point, point + most);
  s->mirror = attractor.mirror;
  s->theta = point[0];
  s->velocity = point[most];
  free(point);
  if (attractor.period > 0 && attractor.mirror >= tile + 1 && attractor.mirror <= KZ_PROOF_MOST)
    s->ellipse = kz_proof_find_ellipse(j->proof, attractor.period, s->theta, s->velocity);
  return KZ_OK;
}

static kz_status find_ellipses(const kz_run *run, job *j, uint8_t mirror[KZ_PROOF_MOST + 1], bool *found) {
  const int64_t count = kz_dynamics_count(j->dynamics), n = count < KZ_PROOF_MOST ? count : KZ_PROOF_MOST;
  seed seeds[KZ_PROOF_MOST];
  const kz_stage stage = {.name = "proved ellipses",
                          .n_tiles = n,
                          .record_bytes = sizeof *seeds,
                          .work = find_seed,
                          .context = j,
                          .keep = true,
                          .everywhere = true};
  KZ_TRY(kz_stage_run(run, &stage, seeds));
  for (int64_t i = 0; i < n; i++) {
    const seed *s = &seeds[i];
    if (s->mirror > KZ_PROOF_MOST) continue;
    mirror[i + 1] = (uint8_t)s->mirror;
    if (!(s->ellipse.radius > 0)) continue;
    *found = true;
    kz_proof_draw(j->proof, (uint8_t)(i + 1), mirror[i + 1], s->theta, s->velocity, &s->ellipse);
  }
  return KZ_OK;
}

static kz_status follow_tile(void *context, int64_t tile, void *record) {
  const job *j = context;
  kz_proof_cells(j->proof, tile * j->tile_cells, j->tile_cells, record);
  return KZ_OK;
}

/* Rounds on a grid whose first half has n_tiles tiles. */
static kz_status run_level(const kz_run *run, job *j, int level, int64_t n_tiles, const uint8_t *mirror, uint8_t *label) {
  const int64_t own = kz_proof_own(j->proof);
  j->tile_cells = own / n_tiles;
  for (int round = 1;; round++) {
    char name[32];
    snprintf(name, sizeof name, "proof %d.%d", level + 1, round);
    const kz_stage stage = {.name = name,
                            .n_tiles = n_tiles,
                            .record_bytes = (size_t)j->tile_cells,
                            .work = follow_tile,
                            .context = j,
                            .keep = true,
                            .everywhere = true};
    KZ_TRY(kz_stage_run(run, &stage, label));
    if ((double)kz_proof_adopt(j->proof, label, mirror) <= GAIN * (double)own) return KZ_OK;
  }
}

kz_status kz_prove_regions(const kz_run *run, const kz_dynamics *dynamics, kz_proof *proof) {
  job j = {.dynamics = dynamics, .proof = proof};
  uint8_t mirror[KZ_PROOF_MOST + 1] = {0};
  const int64_t n_tiles = kz_proof_own(proof) / COLUMNS, finest = kz_proof_own(proof) << (2 * (LEVELS - 1));
  uint8_t *label = kz_malloc((size_t)finest);
  kz_status status = kz_ranks_agree(run->ranks, label ? KZ_OK : kz_fail(KZ_FAILED, "no memory for a proof"));
  bool found = false;
  if (status == KZ_OK) status = find_ellipses(run, &j, mirror, &found);
  for (int level = 0; level < LEVELS && status == KZ_OK && found; level++) {
    if (level > 0) status = kz_ranks_agree(run->ranks, kz_proof_refine(proof));
    if (status == KZ_OK) status = run_level(run, &j, level, n_tiles, mirror, label);
  }
  free(label);
  return status;
}
