/* The scene parser under libFuzzer (tests/fuzz/run): any bytes are read or refused, and what is read comes back from its own
 * text. */
#include "scene/scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static char *resolve(const kz_scene *scene) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) abort();
  kz_scene_write(kz_keys, scene, false, out);
  if (fclose(out) != 0) abort();
  return text;
}

/* What is read from the resolved text has the same resolved text. */
static void check_fixed_point(kz_scene *scene) {
  kz_scene again;
  char *once = resolve(scene);
  if (kz_scene_read(once, strlen(once), "resolved.yaml", 0, NULL, &again) != KZ_OK) abort();
  char *twice = resolve(&again);
  if (strcmp(once, twice) != 0) abort();
  kz_scene_free(&again);
  free(once);
  free(twice);
}

/* The message names the file and says what would be accepted (the program's entry prints it as one line). */
static void check_refusal(void) {
  const char *message = kz_message();
  if (strncmp(message, "scene.yaml:", 11) != 0 || !strchr(message, ';')) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  kz_scene scene;
  char *text = malloc(size + 1); /* as kz_scene_load gives it */
  if (!text) abort();
  memcpy(text, data, size);
  text[size] = '\0';
  kz_message_clear();
  if (kz_scene_read(text, size, "scene.yaml", 0, NULL, &scene) == KZ_OK) {
    check_fixed_point(&scene);
    kz_scene_free(&scene);
  } else {
    check_refusal();
  }
  free(text);
  return 0;
}
