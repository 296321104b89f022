/* app: what the library takes of it: scenes as text, and runs without ranks (C; layer 4). */
#pragma once

#include "kapitza/study.h"

/* Reads the pendulum, numerics and basin of the text of a scene, with the default window where it has no basin. window: flow text of further keys of
 * the mapping `basin`, which replace the scene's; NULL = none. Numerics are not resolved. The caller frees the scene by kz_scene_free. */
kz_status kz_scene_open(const char *text, const char *window, kz_scene *scene);
void kz_scene_free(kz_scene *scene);

/* Runs a scene in this process and writes its result. Signals, checkpoints and MPI are left alone. *words = the summary, freed by the caller; NULL = there is
 * none. *store = the result while it is written, for kz_store_discard where the run is left in the middle; else NULL. */
kz_status kz_run_text(const char *text, const char *output, bool force, char **words, kz_store **store);

/* Makes the tables that a process makes once, which no border may hold. KZ_FAILED: there is no memory. */
kz_status kz_tables_make(void);
