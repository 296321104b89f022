/* The atlas of a result file that requests of serve ask about; it stays in memory until a request names another file.
 */
#pragma once

#include <time.h>

#include "../scene/scene.h"
#include "kapitza/study_atlas.h"

typedef struct {
  char *path; /* NULL: none is open */
  struct timespec changed;
  kz_scene scene; /* of the file */
  kz_atlas *atlas;
} kz_map;

/* Opens the atlas of a file unless it is open already and the file has not changed since. KZ_REFUSED if it has none. */
kz_status kz_map_open(kz_map *map, const char *path);
void kz_map_close(kz_map *map);
