/* Reads variables that an earlier study of the run has written to the file. */
#include "store.h"

static hid_t open_dataset(kz_store *store, const char *group, const char *name) {
  if (H5Lexists(store->file, group, H5P_DEFAULT) <= 0) return H5I_INVALID_HID;
  const hid_t folder = H5Gopen2(store->file, group, H5P_DEFAULT);
  const bool exists = folder >= 0 && H5Lexists(folder, name, H5P_DEFAULT) > 0;
  const hid_t dataset = exists ? H5Dopen2(folder, name, H5P_DEFAULT) : H5I_INVALID_HID;
  if (folder >= 0) H5Gclose(folder);
  return dataset;
}

kz_status kz_store_length(kz_store *store, const char *group, const char *dimension, int64_t *length) {
  const hid_t scale = open_dataset(store, group, dimension);
  *length = 0;
  if (scale < 0) return KZ_OK;
  hsize_t extent = 0;
  const hid_t space = H5Dget_space(scale);
  const kz_status status = H5Sget_simple_extent_dims(space, &extent, NULL) < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : KZ_OK;
  H5Sclose(space);
  H5Dclose(scale);
  *length = (int64_t)extent;
  return status;
}

static kz_status read_number(hid_t dataset, hid_t space, const int64_t *index, double *value) {
  hsize_t place[KZ_MAX_DIMENSIONS] = {0}, extent[KZ_MAX_DIMENSIONS] = {0};
  const int rank = H5Sget_simple_extent_dims(space, extent, NULL);
  for (int d = 0; d < rank; d++) {
    place[d] = (hsize_t)index[d];
    if (place[d] >= extent[d]) return kz_fail(KZ_FAILED, "a number beyond the end of a variable is asked for");
  }
  KZ_HDF5(H5Sselect_elements(space, H5S_SELECT_SET, 1, place));
  const hid_t one = H5Screate(H5S_SCALAR);
  const herr_t read = H5Dread(dataset, H5T_NATIVE_DOUBLE, one, space, H5P_DEFAULT, value);
  if (one >= 0) H5Sclose(one);
  KZ_HDF5(read);
  return KZ_OK;
}

kz_status kz_store_number(kz_store *store, const char *group, const char *name, const int64_t *index, double *value) {
  const hid_t dataset = open_dataset(store, group, name);
  if (dataset < 0) return kz_fail(KZ_FAILED, "the result file has no %s/%s to read", group, name);
  const hid_t space = H5Dget_space(dataset);
  const kz_status status = space < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : read_number(dataset, space, index, value);
  if (space >= 0) H5Sclose(space);
  H5Dclose(dataset);
  return status;
}
