/* The resolved text of a scene. */
#pragma once

#include <stdio.h>

#include "scene/scene.h"

/* To be freed. */
static inline char *resolved_text(const kz_scene *scene) {
  char *text;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  kz_scene_write(kz_scene_keys(), scene, false, out);
  fclose(out);
  return text;
}
