/* One pendulum that stays: its map, its attractors, its trapping regions, its catalogue. */
#ifndef KAPITZA_STUDY_LIVE_RESIDENT_H
#define KAPITZA_STUDY_LIVE_RESIDENT_H

#include "attractors/catalogue.h"
#include "attractors/search.h"
#include "kapitza/study_live.h"
#include "window/starts.h"

/* States of cells of moving frames that have not settled: attractors may have been born there. */
enum { KZ_STRAYS = 16 };

typedef struct {
  kz_scene scene;   /* pendulum, numerics, and the basin whose window was searched; no title */
  double tolerance; /* rad: error of a period, of moving frames; 0: labels are decided */
  bool busy;        /* a frame is being made of it */
  int64_t used;     /* the larger, the later */
  int64_t periods;  /* that cells are followed at most */
  kz_dynamics *dynamics;
  kz_search search;
  kz_images *images;  /* of the last window whose cells they served; NULL: none yet */
  kz_pendulum chosen; /* that the numerics were chosen for */
  int age;            /* pendulums since the trapping regions were grown */
  int n_strays;
  double stray[2 * KZ_STRAYS]; /* [n_strays][2] half-turns and velocity */
  kz_live_catalogue catalogue;
} kz_resident;

static inline bool kz_resident_moves(const kz_resident *resident) {
  return resident->tolerance > 0;
}

/* Of moving frames of the scene's window: small beside a cell. */
double kz_moving_tolerance(const kz_scene *scene);

/* Attractors of the scene's window, trapping regions, catalogue without tracks. To be freed in every case. */
kz_status kz_resident_make(const kz_scene *scene, double tolerance, kz_resident *resident);
void kz_resident_free(kz_resident *resident);

/* How far the scene's pendulum is from that of a moving one, a relative number; INFINITY: too far to be carried there. */
double kz_resident_distance(const kz_resident *resident, const kz_scene *scene);
/* Carries it there: attractors continued, trapping regions of up to some pendulums before. */
void kz_resident_move(kz_resident *resident, const kz_scene *scene);

/* Looks for attractors that its strays are on, and forgets these. Returns whether some have joined. */
bool kz_resident_discover(kz_resident *resident);

/* Whether it serves a frame of the scene to this tolerance. */
bool kz_resident_serves(const kz_resident *resident, const kz_scene *scene, double tolerance);

/* The catalogue once more, after attractors have joined; `version` is the new one's. Tracks come from `before` (NULL: none) where an attractor is the same
 * or has moved, else from *tracks, which counts them. */
void kz_resident_list(kz_resident *resident, int64_t version, const kz_live_catalogue *before, int64_t *tracks);

#endif
