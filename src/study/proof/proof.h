/* Labels that are proved, for basin.proof. */
#pragma once

#include "basin/basin.h"
#include "kapitza/dynamics_proof.h"

/* Evidence of the file's cells. */
enum { KZ_PROVED = 6, KZ_PROVED_IN_PAIRS = 10, KZ_PROVED_IN_TRIPLES = 11 };
/* The levels KZ_ENCLOSE_DOUBLES, ... */
extern const kz_level kz_proof_levels[KZ_ENCLOSURES];

/* The attractors that are proved to exist: numbers of kz_dynamics, mirror [0] = 0. */
typedef struct {
  bool any, has[KZ_PROOF_MOST + 1];
  uint8_t mirror[KZ_PROOF_MOST + 1];
} kz_proved;

/* Random real starts of the window. */
typedef struct {
  int64_t starts, unproved;
  double high; /* upper bound of the share of the window's area that is not proved, with KZ_PROOF_CONFIDENCE */
} kz_proof_sample;
#define KZ_PROOF_CONFIDENCE 0.95

/* Result of a proof for a cell: the attractor on which it ends, 0 = nothing, and the evidence. */
typedef struct {
  uint8_t number, evidence;
} kz_proof_mark;
/* The marks of a tile, as kz_squeeze has them. */
typedef struct {
  size_t bytes; /* 0: no cell is proved */
  void *marks;
} kz_proof_tile;

/* The proof of a run. */
typedef struct {
  kz_proof *proof;
  kz_tiles tiles;
  kz_proof_tile *tile; /* [tiles.own] those of this rank; NULL = none */
  kz_proof_sample sample;
} kz_proof_work;
extern const kz_basin_part kz_proof_part;

/* Bytes of memory that a proof takes on a rank. */
double kz_proof_bytes(const kz_scene *scene);
/* *proof = an empty proof for the scene's basin, or NULL without damping; the caller frees it with kz_proof_free in
 * every case. KZ_REFUSED if the window is too fast for a proof, or its cells too small. */
kz_status kz_proof_begin(const kz_scene *scene, kz_proof **proof);
/* Proves the regions of the known attractors, in kept stages, with the same result on every rank. Collective. */
kz_status kz_prove_regions(const kz_window_labels *labelling, kz_proof *proof, kz_proved *proved);
/* Proves regions, cells and the sample, one after the other. Collective. */
kz_status kz_prove_window(kz_proof_work *run, kz_window_labels *labelling);
/* The marks of the cells of a tile of this rank replace their labels. */
kz_status kz_proof_take(const kz_proof_work *run, int64_t tile, kz_label *cell);
