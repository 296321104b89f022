/* HDF5 calls, each checked, with the library's own text. */
#ifndef KAPITZA_STORE_HDF5_CALL_H
#define KAPITZA_STORE_HDF5_CALL_H

#include <hdf5.h>

#include "kapitza/common.h"

/* The failed HDF5 call as a status; `file` and `line` are where it was made. */
kz_status kz_hdf5_fail(const char *file, int line);
/* Starts HDF5, which then prints nothing by itself. */
kz_status kz_hdf5_start(void);

/* Carries a failed call up. */
#define KZ_HDF5(call)                                        \
  do {                                                       \
    if ((call) < 0) return kz_hdf5_fail(__FILE__, __LINE__); \
  } while (0)

#endif
