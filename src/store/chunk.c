/* Chunks of a variable, written as they are packed, and rows of it read back. */
#include "store.h"

static kz_status open_variable(kz_store *store, const char *group, const char *name, hid_t *dataset) {
  hid_t folder;
  KZ_TRY(kz_store_group(store, group, &folder));
  *dataset = H5Dopen2(folder, name, H5P_DEFAULT);
  const kz_status status = *dataset < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : KZ_OK;
  H5Gclose(folder);
  return status;
}

kz_status kz_store_chunk(kz_store *store, const char *group, const char *name, const int64_t *place, const void *packed,
                         size_t bytes) {
  const hsize_t offset[] = {(hsize_t)place[0], (hsize_t)place[1]};
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  const herr_t written = H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset, bytes, packed);
  const kz_status status = written < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : KZ_OK;
  H5Dclose(dataset);
  return status;
}

static kz_status read_rows(hid_t dataset, hid_t space, hsize_t first, hsize_t n, void *data) {
  hsize_t lengths[KZ_MAX_DIMENSIONS];
  KZ_HDF5(H5Sget_simple_extent_dims(space, lengths, NULL));
  const hsize_t start[] = {first, 0}, count[] = {n, lengths[1]};
  KZ_HDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
  const hid_t memory = H5Screate_simple(2, count, NULL), type = H5Dget_type(dataset);
  const herr_t read = H5Dread(dataset, type, memory, space, H5P_DEFAULT, data);
  const kz_status status = read < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : KZ_OK;
  if (memory >= 0) H5Sclose(memory);
  if (type >= 0) H5Tclose(type);
  return status;
}

kz_status kz_store_rows(kz_store *store, const char *group, const char *name, int64_t first, int64_t n, void *data) {
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  const hid_t space = H5Dget_space(dataset);
  const kz_status status =
      space < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : read_rows(dataset, space, (hsize_t)first, (hsize_t)n, data);
  if (space >= 0) H5Sclose(space);
  H5Dclose(dataset);
  return status;
}
