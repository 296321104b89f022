/* The inside of the library: a pendulum, and how calls come in and go out. */
#pragma once

#include <pthread.h>
#include <sys/types.h>

#include "kapitza/app.h"
#include "kapitza/common_border.h"
#include "kapitza/study_atlas.h"
#include "kapitza/study_live.h"

#pragma GCC visibility push(default)
#include "kapitza.h"
#pragma GCC visibility pop

typedef struct kz_library_atlas kz_library_atlas;

struct kapitza_pendulum {
  kz_border *border;     /* around all that follows the text */
  pthread_mutex_t mutex; /* one call at a time */
  pid_t process;         /* in which it was used last */
  _Atomic int busy;      /* a call works */
  bool between;          /* whether its thread may call again: it stands between two parts */
  bool opened;           /* whether the members below are made */
  kz_scene scene;
  kz_engine *engine;
  kz_library_atlas *atlas; /* atlas of the file that was asked about last; NULL = none */
  kz_flow *flow[2];        /* forwards, backwards; NULL = not made yet */
  kz_scene_source text;    /* text of the scene, which stands behind the pendulum */
};

/* Runs `work` for a pendulum, opened, within its border, alone; its status as the caller gets it. */
typedef kz_status (*kz_work_fn)(kapitza_pendulum *pendulum, void *context);
kapitza_status kz_library_call(kapitza_pendulum *pendulum, kz_work_fn work, void *context);

/* A scene as the layers below have it; its text is the caller's. */
kz_scene_source kz_library_text(const kapitza_scene *scene);

/* The status of the last call within the border, as the caller gets it. */
kapitza_status kz_library_status(kz_status status, const kz_border *border);
/* A kz_pause_fn of this thread's kapitza_set_pause; NULL = it has none. */
kz_pause_fn kz_library_pause(void);

/* Asks the caller in the middle of a frame whether to go on: the pause of this thread, then `between`, which may call
 * again. */
kz_status kz_library_between(kapitza_pendulum *pendulum, kapitza_pause between, void *context);

/* Returns a pendulum's numbers as the caller gets them. */
kapitza_parameters kz_library_parameters(const kz_parameters *own);

/* HDF5 serves one thread at a time. kz_library_store_work runs `work` while this thread has it, and ends *store if the
 * work is left. */
kz_status kz_library_store_work(kz_status (*work)(void *context), void *context, kz_store **store);
/* The atlas of a result file, which the pendulum keeps. KZ_REFUSED: the file has none. */
kz_status kz_library_atlas_of(kapitza_pendulum *pendulum, const char *path, kz_atlas **atlas);

/* The next `bytes` of a piece of memory, from which it moves on, and their number in it. */
size_t kz_library_rounded(size_t bytes);
void *kz_library_part(char **piece, size_t bytes);

/* Attractors or cycles as one piece of memory for the caller. `attract`: all attract, else the names of unstable ones
 * say so. */
kapitza_cycles *kz_library_cycles(const kz_catalogue *catalogue, bool attract);
/* Bytes of such a list, and the list at `place`, for memory that holds more. */
size_t kz_library_cycles_bytes(const kz_catalogue *catalogue);
void kz_library_cycles_put(const kz_catalogue *catalogue, bool attract, void *place);

/* Ends of starts as one piece of memory for the caller. */
kapitza_endings *kz_library_endings(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                                    const kz_ending *own);

/* Runs `work` within a border of its own, which ends with it. */
kapitza_status kz_library_alone(kz_status (*work)(void *context), void *context);

/* Functions of kapitza.h, behind the check of the CPU (entry.c). */
kapitza_status kz_library_create(const kapitza_scene *scene, kapitza_pendulum **pendulum);
kapitza_status kz_library_where(const kapitza_scene *scene, int64_t n, const char *const *theta,
                                const char *const *velocity, kapitza_endings **endings);
kapitza_status kz_library_boundary(const kapitza_scene *scene, const char *const *theta, const char *const *velocity,
                                   int64_t digits, kapitza_boundary *boundary);
kapitza_status kz_library_run(const char *scene, const char *output, int32_t overwrite, char **summary);
