/* Warnings before a scene is modelled: keys without effect, motions that hardly settle. */
#include "app.h"

void kz_warnings_print(const kz_scene *scene, FILE *out) {
  if (scene->basin.table_is_idle)
    fputs("warning: basin.icm: is not used by this basin.method; leave it out, or choose basin.method: icm\n", out);
  kz_settling_warn(scene, out);
}
