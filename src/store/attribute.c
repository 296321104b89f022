/* Attributes of the root, of groups and of variables. */
#include "store.h"

kz_status kz_text_type(hid_t *type) {
  KZ_HDF5(*type = H5Tcopy(H5T_C_S1));
  KZ_HDF5(H5Tset_size(*type, H5T_VARIABLE));
  KZ_HDF5(H5Tset_cset(*type, H5T_CSET_UTF8));
  return KZ_OK;
}

/* An attribute of `type` over `space` (closed here); an older one of that name is replaced. */
static kz_status write_attribute(hid_t object, const char *name, hid_t type, hid_t space, const void *values) {
  if (space >= 0 && H5Aexists(object, name) > 0) H5Adelete(object, name);
  const hid_t attribute = space < 0 ? space : H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  const kz_status status = KZ_HDF5_STATUS(attribute < 0 ? attribute : H5Awrite(attribute, type, values));
  if (attribute >= 0) H5Aclose(attribute);
  if (space >= 0) H5Sclose(space);
  return status;
}

kz_status kz_attribute_text(hid_t object, const char *name, const char *value) {
  hid_t type;
  KZ_TRY(kz_text_type(&type));
  const kz_status status = write_attribute(object, name, type, H5Screate(H5S_SCALAR), &value);
  H5Tclose(type);
  return status;
}

kz_status kz_attribute_array(hid_t object, const char *name, hid_t type, hsize_t n, const void *values) {
  return write_attribute(object, name, type, H5Screate_simple(1, &n, NULL), values);
}

char *kz_attribute_read_text(hid_t object, const char *name) {
  hid_t type;
  char *text = NULL;
  if (H5Aexists(object, name) <= 0 || kz_text_type(&type) != KZ_OK) return NULL;
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute >= 0) {
    if (H5Aread(attribute, type, &text) < 0) text = NULL;
    H5Aclose(attribute);
  }
  H5Tclose(type);
  return text;
}

static hid_t make_group(hid_t file, const char *name) {
  const hid_t creation = H5Pcreate(H5P_GROUP_CREATE);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  H5Pset_obj_track_times(creation, 0);
  const hid_t group = H5Gcreate2(file, name, H5P_DEFAULT, creation, H5P_DEFAULT);
  H5Pclose(creation);
  return group;
}

kz_status kz_store_group(kz_store *store, const char *group, hid_t *opened) {
  const bool is_root = strcmp(group, "/") == 0, exists = is_root || H5Lexists(store->file, group, H5P_DEFAULT) > 0;
  KZ_HDF5(*opened = exists ? H5Gopen2(store->file, group, H5P_DEFAULT) : make_group(store->file, group));
  return KZ_OK;
}

kz_status kz_store_text(kz_store *store, const char *group, const char *name, const char *value) {
  hid_t object;
  KZ_TRY(kz_store_group(store, group, &object));
  const kz_status status = kz_attribute_text(object, name, value);
  H5Gclose(object);
  return status;
}

static kz_status write_number(kz_store *store, const char *group, const char *name, hid_t type, const void *value) {
  hid_t object;
  KZ_TRY(kz_store_group(store, group, &object));
  const kz_status status = write_attribute(object, name, type, H5Screate(H5S_SCALAR), value);
  H5Gclose(object);
  return status;
}

kz_status kz_store_real(kz_store *store, const char *group, const char *name, double value) {
  return write_number(store, group, name, H5T_NATIVE_DOUBLE, &value);
}

kz_status kz_store_integer(kz_store *store, const char *group, const char *name, int64_t value) {
  return write_number(store, group, name, H5T_NATIVE_INT64, &value);
}
