/* app: what the library takes of it: scenes as text, and runs without ranks (C; layer 4). */
#pragma once

#include "kapitza/study.h"

/* Reads the pendulum, numerics and basin of the text of a scene, with the default window where it has no basin. change:
 * flow text of mappings, which replace the scene's, those of `basin` key by key; NULL = none. Numerics are not
 * resolved. The caller frees the scene by kz_scene_free. */
kz_status kz_scene_open(const char *text, const char *change, kz_scene *scene);
/* Reads a number of any digits, an angle ("170 deg" too) or a velocity; *number keeps the text. Returns what is wrong
 * with it, or NULL. */
const char *kz_decimal_read(const char *text, bool is_angle, kz_decimal *number);
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
