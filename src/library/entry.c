/* Calls that come first, compiled for the first instruction set of the processor: they look at the CPU before anything
 * that was built for a newer one runs. */
#include "library.h"

#include "kapitza/app_instructions.h"

static kapitza_status entry_check(void) {
  const char *missing = kz_missing_instruction();
  if (!missing) return KAPITZA_OK;
  kz_message_clear();
  kz_fail(KZ_REFUSED,
          "this library was built for %s, which this CPU lacks; build it with -DKAPITZA_ARCH=" KZ_FIRST_INSTRUCTIONS,
          missing);
  return KAPITZA_REFUSED;
}

kapitza_status kapitza_pendulum_open(const kapitza_scene *scene, kapitza_pendulum **pendulum) {
  const kapitza_status status = entry_check();
  return status == KAPITZA_OK ? kz_library_create(scene, pendulum) : status;
}

kapitza_status kapitza_pendulum_create(const char *scene, kapitza_pendulum **pendulum) {
  return kapitza_pendulum_open(&(kapitza_scene){scene, "scene", NULL, 0}, pendulum);
}

kapitza_status kapitza_where_of(const kapitza_scene *scene, int64_t n, const char *const *theta,
                                const char *const *velocity, kapitza_endings **endings) {
  const kapitza_status status = entry_check();
  return status == KAPITZA_OK ? kz_library_where(scene, n, theta, velocity, endings) : status;
}

kapitza_status kapitza_boundary_of(const kapitza_scene *scene, const char *const *theta, const char *const *velocity,
                                   int64_t digits, kapitza_boundary *boundary) {
  const kapitza_status status = entry_check();
  return status == KAPITZA_OK ? kz_library_boundary(scene, theta, velocity, digits, boundary) : status;
}

kapitza_status kapitza_run(const char *scene, const char *output, int32_t overwrite, char **summary) {
  const kapitza_status status = entry_check();
  return status == KAPITZA_OK ? kz_library_run(scene, output, overwrite, summary) : status;
}
