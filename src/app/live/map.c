#include "map.h"

#include <errno.h>
#include <sys/stat.h>

static kz_status read_scene(kz_store *store, const char *path, kz_scene *scene) {
  KZ_AUTOFREE char *text = kz_store_text_of(store, "scene_resolved");
  if (!text) return kz_fail(KZ_REFUSED, "%s: has no scene", path);
  return kz_scene_read(text, strlen(text), path, 0, NULL, scene);
}

static kz_status read_file(kz_map *map, const char *path) {
  kz_store *store;
  KZ_TRY(kz_store_open(path, &store));
  kz_status status = read_scene(store, path, &map->scene);
  if (status == KZ_OK) {
    status = kz_atlas_open(&map->scene, store, &map->atlas);
    if (status != KZ_OK) kz_scene_free(&map->scene);
  }
  kz_store_discard(store);
  return status;
}

kz_status kz_map_open(kz_map *map, const char *path) {
  struct stat now;
  if (stat(path, &now) != 0)
    return kz_fail(KZ_REFUSED, "request: atlas: %s: cannot be opened: %s", path, strerror(errno));
  if (map->path && strcmp(map->path, path) == 0 && memcmp(&map->changed, &now.st_mtim, sizeof now.st_mtim) == 0)
    return KZ_OK;
  kz_map_close(map);
  KZ_TRY(kz_scene_check_file(path));
  KZ_TRY(read_file(map, path));
  map->path = kz_strdup(path);
  map->changed = now.st_mtim;
  return KZ_OK;
}

void kz_map_close(kz_map *map) {
  if (!map->path) return;
  kz_atlas_close(map->atlas);
  kz_scene_free(&map->scene);
  free(map->path);
  *map = (kz_map){0};
}
