#include "store.h"

enum { TEXT_BYTES = 512 };

/* The deepest entry of HDF5's error stack is the cause. */
static herr_t keep_cause(unsigned depth, const H5E_error2_t *error, void *text) {
  (void)depth;
  if (error->desc) snprintf(text, TEXT_BYTES, "%s", error->desc);
  return 0;
}

kz_status kz_hdf5_fail(const char *file, int line) {
  char text[TEXT_BYTES] = "unknown error";
  int number;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_cause, text);
  const char *base = strrchr(file, '/'), *cause = strstr(text, "errno = ");
  if (cause &&
      sscanf(cause, "errno = %d", &number) == 1) /* the text itself is a line of offsets, clocks and addresses */
    snprintf(text, sizeof text, "the result cannot be written: %s", strerror(number));
  return kz_fail(KZ_FAILED, "HDF5: %s (%s:%d)", text, base ? base + 1 : file, line);
}

/* Starts HDF5 without its exit handler, which would try again to write to a full disk, and complain. */
kz_status kz_hdf5_start(void) {
  H5dont_atexit(); /* fails, without harm, where HDF5 has started before */
  if (H5open() >= 0 && H5Eset_auto2(H5E_DEFAULT, NULL, NULL) >= 0) return KZ_OK;
  return kz_fail(KZ_FAILED, "HDF5 cannot be started, probably because memory ran out");
}
