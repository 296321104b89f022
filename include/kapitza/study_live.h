/* study: frames of basins on request, from an engine that keeps what the next frame can use (C; layer 3). No MPI, no files. */
#ifndef KAPITZA_STUDY_LIVE_H
#define KAPITZA_STUDY_LIVE_H

#include <stdbool.h>
#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/study_where.h"

/* Pendulums of the last requests: their maps, attractors and trapping regions. */
typedef struct kz_engine kz_engine;

kz_engine *kz_engine_create(void);
void kz_engine_free(kz_engine *engine);

/* An attractor as users see it. */
typedef struct {
  kz_attractor row;
  char name[KZ_NAME_LENGTH];
  int32_t mirror;           /* id of the mirror image */
  double fraction;          /* of the grid's cells; NaN without a grid */
  double *theta, *velocity; /* [period] strobe points */
} kz_entry;

/* In the order of the file: id = index. */
typedef struct {
  int64_t count;
  kz_entry *entries;
  int32_t *id_of; /* [numbers from 1]: id of a number of kz_dynamics, -1 = not in the catalogue */
} kz_catalogue;

/* All attractors that are known of a pendulum; a frame's labels are ids of `list`. */
typedef struct {
  int64_t version; /* from 1; another number wherever it is another catalogue */
  kz_parameters parameters;
  kz_catalogue list;
  int64_t *track; /* [count] a number that stays with an attractor while the pendulum changes */
} kz_live_catalogue;

enum { KZ_PLANE_LABELS, KZ_PLANE_SETTLING_TIME, KZ_PLANE_DOUBT, KZ_PLANE_OTHER, KZ_PLANES };
enum { KZ_NO_LABEL = 255 }; /* not settled, or no attractor */
enum { KZ_DOUBT_NONE = 0, KZ_DOUBT_OPEN = 1, KZ_DOUBT_UNSEEN = 2 };

/* A level of a frame: every so many cells (docs/reference/serve.md). plane: labels, other and doubt are bytes, settling times float; NULL where
 * not asked for. */
typedef struct {
  int64_t level, rows, columns;
  const kz_live_catalogue *catalogue;
  const void *plane[KZ_PLANES]; /* [rows][columns] */
  double seconds;               /* of this process's processor time since the frame began */
} kz_live_level;

/* Bytes of a cell. */
size_t kz_plane_bytes(int plane);

/* What a frame is made for. */
typedef struct {
  bool moving;                       /* quickly, to a tolerance a period that is small beside a cell; else as method exact */
  const kz_integers *levels;         /* 8, 4, 2 or 1, falling */
  bool plane[KZ_PLANES];             /* which are shown */
  kz_status (*pause)(void *context); /* called every few milliseconds; anything but KZ_OK ends the frame with that status */
  kz_status (*show)(void *context, const kz_live_level *level);
  void *context;
} kz_frame;

/* A frame of the scene's study basin: pendulum, window, cells, max_periods. The scene's numerics need not be resolved. */
kz_status kz_engine_frame(kz_engine *engine, const kz_scene *scene, const kz_frame *frame);

/* When nothing is asked: looks for attractors where cells of the last moving frames have not settled. Takes milliseconds at most of the time. */
void kz_engine_rest(kz_engine *engine);

/* What is known of the scene's pendulum; it belongs to the engine and holds until the next call. */
kz_status kz_engine_catalogue(kz_engine *engine, const kz_scene *scene, const kz_live_catalogue **catalogue);

/* kz_where with the attractors that the engine knows; endings [n] to be freed as there. */
kz_status kz_engine_where(kz_engine *engine, const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                          kz_ending *endings);

/* A level of a chart: the periods and centres (as in /chart) of its points, x fastest; period KZ_NO_LABEL = not settled, or no pendulum. */
typedef struct {
  int64_t level, rows, columns;
  const uint8_t *period, *centre; /* [rows][columns] */
} kz_chart_level;
/* The scene's study chart for its first start; pause as of a frame. */
kz_status kz_chart_draw(const kz_scene *scene, const kz_integers *levels, kz_status (*pause)(void *context),
                        kz_status (*show)(void *context, const kz_chart_level *level), void *context);

/* The motion of the study orbit, from its start, after its transient: theta (rad, not wrapped) and velocity [samples], at the scene's
 * samples_per_period. The caller frees both in every case. */
kz_status kz_orbit_record(const kz_scene *scene, int64_t *samples, double **theta, double **velocity);

#endif
