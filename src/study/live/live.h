/* Frames on request: rasters, prepared pendulums, the engine, cells, threads. */
#pragma once

#include <pthread.h>

#include "labelling/catalogue.h"
#include "labelling/search.h"
#include "kapitza/dynamics_live.h"
#include "kapitza/study_live.h"
#include "window/window.h"

/* ---- rasters: the cells of a frame that are shown at once, one for each multiple of the coarseness along each axis.
 * All cells of a raster also belong to the finer ones. ---- */

/* Number of cells of a raster along an axis of `count` cells. */
static inline int64_t kz_raster_size(int64_t coarseness, int64_t count) {
  return (count + coarseness - 1) / coarseness;
}

/* Index of the i-th of them along the axis. */
static inline int64_t kz_raster_place(int64_t coarseness, int64_t i, int64_t count) {
  const int64_t at = coarseness * i + (coarseness == 8 ? 5 : coarseness > 1);
  return at < count ? at : count - 1;
}

/* Lists the cells of a raster that no raster has followed: number [rows * columns] takes their numbers, theta fastest.
 * A cell from `own` on is the mirror image of an own one, which is listed in its place, once. listed [own]: cells that
 * are listed, or were. Returns how many. */
int64_t kz_raster_pending(int64_t coarseness, int64_t rows, int64_t columns, int64_t own, bool *listed,
                          int64_t *number);

/* ---- a prepared pendulum, which the engine keeps, with its map, attractors, trapping regions and catalogue ---- */

/* Largest number of states of unsettled cells of moving frames, near which new attractors may exist. */
enum { KZ_MOST_UNSETTLED = 16 };

typedef struct {
  kz_scene scene;     /* pendulum, numerics, and the basin whose window was searched; no title */
  kz_release release; /* how its cells are released */
  double tolerance;   /* rad: error of a period for moving frames; 0 = labels are decided */
  bool busy;          /* a frame of it is being made */
  bool smooth;        /* its cells get smooth settling times */
  bool turns;         /* their net turns are counted */
  int64_t used;       /* counter of its last use: larger = later */
  int64_t periods;    /* largest number of drive periods for which cells are followed */
  kz_dynamics *dynamics;
  kz_search search;
  kz_images *images;   /* images of the last window that needed them; NULL = none */
  kz_pendulum chosen;  /* pendulum of the numerics */
  kz_pendulum grown;   /* pendulum of the trapping regions */
  int age;             /* number of pendulums since the trapping regions were grown */
  int64_t ended, left; /* cells of moving frames since the last search: all, and those that have not settled */
  int n_unsettled;
  double unsettled[2 * KZ_MOST_UNSETTLED]; /* [n_unsettled][2] half-turns and velocity */
  kz_live_catalogue catalogue;
} kz_prepared;

static inline bool kz_prepared_moves(const kz_prepared *prepared) {
  return prepared->tolerance > 0;
}

/* How cells of moving frames that take long are moved. */
kz_stepper kz_prepared_late_stepper(const kz_prepared *prepared);

/* The tolerance of moving frames of the scene's window, rad: much smaller than a cell. */
double kz_moving_tolerance(const kz_scene *scene);

/* Prepares a pendulum: attractors of the scene's window, or of the frame's atlas where it has one (`frame` NULL: no
 * frame), trapping regions, catalogue without tracks. The caller frees it in every case. */
kz_status kz_prepared_make(const kz_scene *scene, double tolerance, const kz_frame *frame, kz_prepared *prepared);
void kz_prepared_free(kz_prepared *prepared);

/* The relative distance of the scene's pendulum from the prepared one; INFINITY = too far to move it there. */
double kz_prepared_distance(const kz_prepared *prepared, const kz_scene *scene);
/* Moves it to the scene's pendulum: its attractors are continued, and those that the frame's atlas lists join them;
 * trapping regions are grown anew after some pendulums only. KZ_REFUSED: the atlas does not have this pendulum. */
kz_status kz_prepared_move(kz_prepared *prepared, const kz_scene *scene, const kz_frame *frame);
/* Adds unknown attractors that the frame's atlas lists. KZ_REFUSED: the atlas has another pendulum here. */
kz_status kz_prepared_take_listed(kz_prepared *prepared, const kz_frame *frame);

/* Whether so many cells of moving frames have not settled that a search for their attractors saves time. */
bool kz_prepared_misses(const kz_prepared *prepared);

/* Looks for attractors near its unsettled states, and drops these. Returns true if it has found some. */
bool kz_prepared_discover(kz_prepared *prepared);

/* True if it can be used for a frame of the scene with this tolerance. */
bool kz_prepared_serves(const kz_prepared *prepared, const kz_scene *scene, double tolerance);

/* The catalogue once more, after attractors have joined; `version` is the new one's. Tracks come from `before` (NULL:
 * none) where an attractor is the same or has moved, else from *tracks, which counts them. */
void kz_prepared_list(kz_prepared *prepared, int64_t version, const kz_live_catalogue *before, int64_t *tracks);

/* ---- the engine: the last pendulums that were prepared ---- */

enum { KZ_MOST_PREPARED = 6 };
struct kz_engine {
  pthread_rwlock_t changing; /* lock for changes of a prepared pendulum's attractors: threads that follow cells wait */
  kz_prepared prepared[KZ_MOST_PREPARED];
  kz_kept_series *series;          /* series of all: a slider goes on where it was, whatever it moves */
  int64_t calls, versions, tracks; /* counters */
  const kz_live_catalogue *shown;  /* the last catalogue: tracks go on from it */
};

/* *prepared = for a frame of a scene, or, `frame` NULL, for decided labels; made if necessary, the engine owns it. */
kz_status kz_engine_prepared(kz_engine *engine, const kz_scene *scene, const kz_frame *frame, kz_prepared **prepared);

/* Makes the catalogue of a prepared pendulum anew after new attractors were found. */
void kz_engine_list(kz_engine *engine, kz_prepared *prepared);

/* ---- cells of one frame, followed where they are pending ---- */

/* A cell of a frame. Evidence is 0 until it is followed, KZ_LEFT in a moving frame, which knows no errors. */
typedef struct {
  kz_label end;
  float smooth; /* smooth settling time, if the frame shows it */
} kz_frame_cell;

/* Largest number of cells that are followed together. */
enum { KZ_FRAME_TILE = 2048 };

/* Cells of a moving frame: states (half-turns, rad per drive radian) and the periods that they have spent. */
typedef struct {
  int64_t n, number[2 * KZ_FRAME_TILE], spent[2 * KZ_FRAME_TILE];
  double state[4 * KZ_FRAME_TILE];
} kz_travellers;

/* Makes the starts of a frame's cells, at any depth; it reuses the images of the last frame if possible. The caller
 * frees them if the status is KZ_OK. */
kz_status kz_cells_begin(kz_prepared *prepared, const kz_basin_plan *plan, const kz_frame *frame,
                         kz_window_starts *starts);

/* Follows n <= KZ_FRAME_TILE cells; number [n] = their numbers in the frame, theta fastest. Those of a moving frame
 * that take long join `late`, which holds none at first: a few slow cells would leave most lanes empty. kz_cells_finish
 * follows them to their ends. */
kz_status kz_cells_follow(kz_prepared *prepared, const kz_window_starts *starts, int64_t n, const int64_t *number,
                          kz_travellers *late, kz_frame_cell *cells);
void kz_cells_finish(kz_prepared *prepared, kz_travellers *late, kz_frame_cell *cells);

/* Samples along the curve that a deep window becomes: they label the cells of a moving frame. */
typedef struct {
  kz_window_curve curve;
  kz_frame_cell *cell; /* [curve.count] result of each sample */
  int64_t *wanted;     /* [curve.count] numbers of the samples to follow */
} kz_samples;

/* The caller frees *samples. curve.count is 0 if the window is not a curve. */
void kz_samples_make(const kz_window_starts *starts, kz_samples *samples);
void kz_samples_free(kz_samples *samples);

/* Follows any number n of cells by following their samples. */
kz_status kz_samples_follow(kz_prepared *prepared, const kz_frame *frame, kz_samples *samples, int64_t n,
                            const int64_t *number, kz_frame_cell *cells);

/* ---- cells of a frame, followed by all cores ---- */

/* Some cells of a frame to follow. */
typedef struct {
  kz_prepared *prepared;
  const kz_window_starts *starts;
  const kz_frame *frame;
  pthread_rwlock_t *changing; /* lock of the engine */
  int64_t n;
  const int64_t *number; /* [n] */
  kz_frame_cell *cells;  /* cells of the frame */
} kz_frame_task;
/* Follows the cells in tiles, which free threads take. Labels do not depend on the thread that follows a cell. */
kz_status kz_frame_follow(const kz_frame_task *task);
