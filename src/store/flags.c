/* The meanings of the values of a variable, as attributes of CF. */
#include <stdlib.h>

#include "store.h"

kz_status kz_store_flags(kz_store *store, const char *group, const char *name, int32_t first, int64_t n, const char *meanings) {
  hid_t folder, dataset = H5I_INVALID_HID, type = H5I_INVALID_HID;
  int64_t *values = kz_malloc((size_t)n * sizeof *values); /* wide enough for any integer type */
  for (int64_t i = 0; i < n; i++) ((int32_t *)values)[i] = first + (int32_t)i;
  kz_status status = kz_store_group(store, group, &folder);
  if (status == KZ_OK) {
    dataset = H5Dopen2(folder, name, H5P_DEFAULT);
    if (dataset >= 0) type = H5Dget_type(dataset);
    const bool converted = type >= 0 && H5Tconvert(H5T_NATIVE_INT32, type, (size_t)n, values, NULL, H5P_DEFAULT) >= 0;
    status =
        converted ? kz_attribute_array(dataset, "flag_values", type, (hsize_t)n, values) : kz_hdf5_fail(__FILE__, __LINE__);
    H5Gclose(folder);
  }
  if (status == KZ_OK) status = kz_attribute_text(dataset, "flag_meanings", meanings);
  if (type >= 0) H5Tclose(type);
  if (dataset >= 0) H5Dclose(dataset);
  free(values);
  return status;
}
