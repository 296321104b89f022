/* study: frames of basins on request; the engine keeps what the next frame can use (C; layer 3). No MPI, no files. */
#pragma once

#include "kapitza/study_where.h"

/* The engine: maps, attractors and trapping regions of the pendulums of the last requests. */
typedef struct kz_engine kz_engine;
typedef struct kz_atlas kz_atlas; /* study_atlas.h */

kz_engine *kz_engine_create(void);

/* All known attractors of a pendulum; the labels of a frame are ids of `list`. */
typedef struct {
  int64_t version; /* from 1; every other catalogue has another number */
  kz_parameters parameters;
  kz_catalogue list;
  int64_t *track; /* [count]: a number that stays with an attractor while the pendulum changes */
} kz_live_catalogue;

enum {
  KZ_PLANE_LABELS,
  KZ_PLANE_SETTLING_TIME,
  KZ_PLANE_SMOOTH_TIME,
  KZ_PLANE_DOUBT,
  KZ_PLANE_OTHER,
  KZ_PLANE_TURNS,
  KZ_PLANE_EVIDENCE,
  KZ_PLANES
};
enum { KZ_NO_LABEL = 255 }; /* not settled, or no attractor */
enum { KZ_DOUBT_NONE = 0, KZ_DOUBT_OPEN = 1, KZ_DOUBT_UNSEEN = 2 };

/* One picture of a frame: every cell whose indices go in steps of `coarseness` (`level` of docs/reference/serve.md).
 * The planes labels, other and doubt have bytes, times are float; the pointer of a plane that was not requested is
 * NULL. */
typedef struct {
  int64_t coarseness, rows, columns;
  const kz_live_catalogue *catalogue;
  const void *plane[KZ_PLANES]; /* [rows][columns] */
  double seconds;               /* processor time of this process since the frame began */
} kz_live_raster;

/* Bytes of a cell in a plane. */
size_t kz_plane_bytes(int plane);

/* How a frame is made, and where it goes. */
typedef struct {
  bool moving;                   /* true: fast, error per period well below a cell; false: as method exact */
  const kz_integers *coarseness; /* coarseness of each raster: 8, 4, 2 or 1, falling */
  bool plane[KZ_PLANES];         /* the planes to show */
  kz_atlas *atlas; /* atlas whose cycles at the point x, y of the scene's pendulum need no search; NULL: none */
  double x, y;     /* values of its two keys */
  kz_status (*pause)(void *context); /* is called every few ms; any status but KZ_OK ends the frame with it */
  kz_status (*show)(void *context, const kz_live_raster *raster);
  void *context;
} kz_frame;

/* Makes a frame of the scene's basin: its pendulum, window, cells, max_periods. Its numerics need not be resolved. */
kz_status kz_engine_frame(kz_engine *engine, const kz_scene *scene, const kz_frame *frame);

/* Centre of cell i of an axis of a frame, as files have it. */
double kz_frame_centre(const kz_axis *axis, int64_t i);

/* Uses idle time: looks for attractors from cells of the last moving frames that did not settle. Takes milliseconds. */
void kz_engine_rest(kz_engine *engine);

/* *catalogue = known attractors of the scene's pendulum, owned by the engine and valid until the next call. */
kz_status kz_engine_catalogue(kz_engine *engine, const kz_scene *scene, const kz_live_catalogue **catalogue);

/* kz_where with the attractors that the engine knows; the caller frees endings [n] by kz_where_free. */
kz_status kz_engine_where(kz_engine *engine, const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                          kz_ending *endings);

/* Labels n starts [n][2] (rad, rad per drive radian) of the scene's pendulum as method exact does, at the velocities of
 * the scene's window: label [n], whose ids are those of *catalogue (-1 = not settled, no second candidate);
 * start_error: bound of the starts' own errors, rad; error [n]: bound of the orbit's error when it was trapped, rad. */
kz_status kz_engine_labels(kz_engine *engine, const kz_scene *scene, int64_t n, const double (*start)[2],
                           double start_error, kz_label *engine_label, double *error,
                           const kz_live_catalogue **catalogue);

/* Picture of a plane of two keys: periods and centres of final states, and values of the group /plane, x fastest;
 * period KZ_NO_LABEL = not settled, or no pendulum. */
typedef struct {
  int64_t coarseness, rows, columns;
  const uint8_t *period, *centre; /* [rows][columns] */
} kz_plane_raster;
/* *points = number of points of the scene's plane. KZ_REFUSED: it has none. */
kz_status kz_plane_points(const kz_scene *scene, int64_t *points);
/* Draws where the first start of the scene's sweep.ends ends over its plane; `pause` as in kz_frame. */
kz_status kz_plane_draw(const kz_scene *scene, const kz_integers *coarseness, kz_status (*pause)(void *context),
                        kz_status (*show)(void *context, const kz_plane_raster *raster), void *context);

/* The motion of the scene's study orbit, by the pendulum itself, after its transient: theta (rad, not wrapped) and
 * velocity (rad per drive radian), each [periods * samples_per_period + 1]. `pause` as in kz_frame, every 0.1 s.
 * KZ_FAILED: it becomes too large for double precision. */
kz_status kz_orbit_record(const kz_scene *scene, kz_status (*pause)(void *context), void *context, double *theta,
                          double *velocity);
