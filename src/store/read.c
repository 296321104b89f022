/* Existing variables: numbers, rows, chunks, meanings of values. */
#include "store.h"

static hid_t open_dataset(kz_store *store, const char *group, const char *name) {
  if (H5Lexists(store->file, group, H5P_DEFAULT) <= 0) return H5I_INVALID_HID;
  const hid_t folder = H5Gopen2(store->file, group, H5P_DEFAULT);
  const bool exists = folder >= 0 && H5Lexists(folder, name, H5P_DEFAULT) > 0;
  const hid_t dataset = exists ? H5Dopen2(folder, name, H5P_DEFAULT) : H5I_INVALID_HID;
  if (folder >= 0) H5Gclose(folder);
  return dataset;
}

static kz_status open_variable(kz_store *store, const char *group, const char *name, hid_t *dataset) {
  *dataset = open_dataset(store, group, name);
  return *dataset >= 0 ? KZ_OK : kz_fail(KZ_FAILED, "the result file has no %s/%s to read", group, name);
}

kz_status kz_scale_length(hid_t scale, int64_t *length) {
  const hid_t space = H5Dget_space(scale);
  const kz_status status = KZ_HDF5_STATUS(*length = H5Sget_simple_extent_npoints(space));
  H5Sclose(space);
  return status;
}

kz_status kz_store_length(kz_store *store, const char *group, const char *dimension, int64_t *length) {
  const hid_t scale = open_dataset(store, group, dimension);
  *length = 0;
  if (scale < 0) return KZ_OK;
  const kz_status status = kz_scale_length(scale, length);
  H5Dclose(scale);
  return status;
}

/* Reads the selection of `space`, of count [rank] numbers. */
static kz_status read_selected(hid_t dataset, hid_t type, hid_t space, int rank, const hsize_t *count, void *data) {
  const hid_t memory = H5Screate_simple(rank, count, NULL);
  const kz_status status = KZ_HDF5_STATUS(H5Dread(dataset, type, memory, space, H5P_DEFAULT, data));
  if (memory >= 0) H5Sclose(memory);
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
  return read_selected(dataset, H5T_NATIVE_DOUBLE, space, 1, (hsize_t[]){1}, value);
}

kz_status kz_store_number(kz_store *store, const char *group, const char *name, const int64_t *index, double *value) {
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  const hid_t space = H5Dget_space(dataset);
  const kz_status status = space < 0 ? kz_hdf5_fail(__FILE__, __LINE__) : read_number(dataset, space, index, value);
  if (space >= 0) H5Sclose(space);
  H5Dclose(dataset);
  return status;
}

static kz_status read_rows(hid_t dataset, hid_t space, hsize_t first, hsize_t n, void *data) {
  hsize_t lengths[KZ_MAX_DIMENSIONS];
  KZ_HDF5(H5Sget_simple_extent_dims(space, lengths, NULL));
  const hsize_t start[] = {first, 0}, count[] = {n, lengths[1]};
  KZ_HDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
  const hid_t type = H5Dget_type(dataset);
  const kz_status status = read_selected(dataset, type, space, 2, count, data);
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

kz_status kz_store_numbers(kz_store *store, const char *group, const char *name, int64_t n, double *value) {
  hid_t dataset;
  int64_t there;
  KZ_TRY(open_variable(store, group, name, &dataset));
  kz_status status = kz_scale_length(dataset, &there);
  if (status == KZ_OK && there != n)
    status = kz_fail(KZ_FAILED, "the result file's %s/%s does not fit to its other variables", group, name);
  if (status == KZ_OK)
    status = KZ_HDF5_STATUS(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value));
  H5Dclose(dataset);
  return status;
}

kz_status kz_store_chunk(kz_store *store, const char *group, const char *name, const int64_t *place, const void *packed,
                         size_t bytes) {
  const hsize_t offset[] = {(hsize_t)place[0], (hsize_t)place[1]};
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  const kz_status status = KZ_HDF5_STATUS(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset, bytes, packed));
  H5Dclose(dataset);
  return status;
}

/* Writes an attribute first, first + 1, ... of the variable's own type. */
static kz_status write_integers(hid_t dataset, const char *name, int32_t first, int64_t n) {
  const hid_t type = H5Dget_type(dataset);
  int64_t *values = kz_malloc((size_t)n * sizeof *values); /* wide enough for any integer type */
  for (int64_t i = 0; i < n; i++) ((int32_t *)values)[i] = first + (int32_t)i;
  kz_status status = KZ_HDF5_STATUS(H5Tconvert(H5T_NATIVE_INT32, type, (size_t)n, values, NULL, H5P_DEFAULT));
  if (status == KZ_OK) status = kz_attribute_array(dataset, name, type, (hsize_t)n, values);
  if (type >= 0) H5Tclose(type);
  free(values);
  return status;
}

kz_status kz_store_flags(kz_store *store, const char *group, const char *name, int32_t first, int64_t n,
                         const char *meanings) {
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  kz_status status = write_integers(dataset, "flag_values", first, n);
  if (status == KZ_OK) status = kz_attribute_text(dataset, "flag_meanings", meanings);
  H5Dclose(dataset);
  return status;
}

kz_status kz_store_missing(kz_store *store, const char *group, const char *name, int32_t value) {
  hid_t dataset;
  KZ_TRY(open_variable(store, group, name, &dataset));
  const kz_status status = write_integers(dataset, "_FillValue", value, 1);
  H5Dclose(dataset);
  return status;
}
