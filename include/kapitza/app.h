/* app: what the library takes of it: scenes as text, and runs without ranks (C; layer 4). */
#pragma once

#include "kapitza/study.h"

/* The text of a scene, the name of its file in messages, and changes "KEY=VALUE". */
typedef struct {
  const char *text, *name;
  int n_sets;
  char *const *sets;
} kz_scene_source;

/* Reads the pendulum, numerics and basin of a scene, with the default window where it has no basin. change: flow text
 * of mappings, which replace the scene's, those of `basin` key by key; NULL = none. Numerics are not resolved. The
 * caller frees the scene by kz_scene_free. */
kz_status kz_scene_open(const kz_scene_source *given, const char *change, kz_scene *scene);
/* Reads the whole scene, checks all studies, and has it answered; a message says where in the text its key stands. */
kz_status kz_scene_ask(const kz_scene_source *given, kz_status (*answer)(const kz_scene *scene, void *context),
                       void *context);
/* Reads start `i` (from 0) of a list: an angle and a velocity of any digits; pivot_frequency: of velocities per second,
 * rad/s, NaN = none. all: all digits count; else those of a number with more than a double has. The texts must outlive
 * *start. */
kz_status kz_start_read(const char *theta, const char *velocity, int64_t i, double pivot_frequency, bool all,
                        kz_coordinate start[2]);
/* Reads the text of a scene (scene/scene.h). */
kz_status kz_scene_read(const char *text, size_t length, const char *file, int n_sets, char *const *sets,
                        kz_scene *scene);
void kz_scene_free(kz_scene *scene);

/* Runs a scene in this process and writes its result. Signals, checkpoints and MPI are left alone. *words = the
 * summary, freed by the caller; NULL = there is none. *store = the result while it is written, for kz_store_discard
 * where the run is left in the middle; else NULL. */
kz_status kz_run_text(const char *text, const char *output, bool force, char **words, kz_store **store);

/* Makes the tables that a process makes once, which no border may hold. KZ_FAILED: there is no memory. */
kz_status kz_tables_make(void);
