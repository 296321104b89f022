/* A resident: a pendulum that the engine keeps, with its map, attractors, trapping regions and catalogue. */
#ifndef KAPITZA_STUDY_LIVE_RESIDENT_H
#define KAPITZA_STUDY_LIVE_RESIDENT_H

#include "attractors/catalogue.h"
#include "attractors/search.h"
#include "kapitza/study_live.h"
#include "window/starts.h"

/* Largest number of strays: states of unsettled cells of moving frames, near which new attractors may exist. */
enum { KZ_STRAYS = 16 };

typedef struct {
  kz_scene scene;   /* pendulum, numerics, and the basin whose window was searched; no title */
  double tolerance; /* rad: error of a period for moving frames; 0 = labels are decided */
  bool busy;        /* a frame of it is being made */
  bool smooth;      /* its cells get smooth settling times */
  int64_t used;     /* counter of its last use: larger = later */
  int64_t periods;  /* largest number of drive periods for which cells are followed */
  kz_dynamics *dynamics;
  kz_search search;
  kz_images *images;  /* of the last window that needed them; NULL = none yet */
  kz_pendulum chosen; /* the pendulum for which the numerics were chosen, */
  kz_pendulum grown;  /* and that for which the trapping regions were made */
  int age;            /* number of pendulums since the trapping regions were grown */
  int n_strays;
  double stray[2 * KZ_STRAYS]; /* [n_strays][2] half-turns and velocity */
  kz_live_catalogue catalogue;
} kz_resident;

static inline bool kz_resident_moves(const kz_resident *resident) {
  return resident->tolerance > 0;
}

/* The tolerance of moving frames of the scene's window, rad: much smaller than a cell. */
double kz_moving_tolerance(const kz_scene *scene);

/* Makes a resident: attractors of the scene's window, trapping regions, catalogue without tracks. The caller frees it in every case. */
kz_status kz_resident_make(const kz_scene *scene, double tolerance, kz_resident *resident);
void kz_resident_free(kz_resident *resident);

/* The relative distance of the scene's pendulum from that of the resident; INFINITY = too far to move the resident there. */
double kz_resident_distance(const kz_resident *resident, const kz_scene *scene);
/* Moves the resident to the scene's pendulum: its attractors are continued; trapping regions are grown anew after some pendulums only. */
void kz_resident_move(kz_resident *resident, const kz_scene *scene);

/* Looks for attractors near its strays, and forgets the strays. Returns true if it has found some. */
bool kz_resident_discover(kz_resident *resident);

/* True if the resident can be used for a frame of the scene with this tolerance. */
bool kz_resident_serves(const kz_resident *resident, const kz_scene *scene, double tolerance);

/* The catalogue once more, after attractors have joined; `version` is the new one's. Tracks come from `before` (NULL: none) where an attractor is the same
 * or has moved, else from *tracks, which counts them. */
void kz_resident_list(kz_resident *resident, int64_t version, const kz_live_catalogue *before, int64_t *tracks);

#endif
