/* Variables and their dimension scales, from the table. */
#include <hdf5_hl.h>

#include "store.h"

static const size_t SPARE_BYTES = (size_t)1 << 24; /* Memory that HDF5 may need besides the data */

/* Makes the HDF5 type of a kind. */
static hid_t memory_type(kz_kind kind) {
  const hid_t types[] = {[KZ_REAL] = H5T_NATIVE_DOUBLE, [KZ_INT8] = H5T_NATIVE_INT8,   [KZ_UINT8] = H5T_NATIVE_UINT8,
                         [KZ_INT16] = H5T_NATIVE_INT16, [KZ_INT32] = H5T_NATIVE_INT32, [KZ_UINT32] = H5T_NATIVE_UINT32};
  hid_t type = H5I_INVALID_HID;
  return kind != KZ_TEXT ? H5Tcopy(types[kind]) : kz_text_type(&type) == KZ_OK ? type : H5I_INVALID_HID;
}

/* Writes flag values, of one byte as coded variables are, and their meanings. */
static kz_status write_flags(hid_t dataset, const kz_variable *row, hid_t type) {
  char values[KZ_MAX_FLAGS];
  size_t bytes = 1;
  hsize_t n = 0;
  for (; row->flags[n]; ++n) {
    values[n] = (char)n;
    bytes += strlen(row->flags[n]) + 1;
  }
  if (n == 0) return KZ_OK;
  KZ_AUTOFREE char *meanings = kz_calloc(1, bytes);
  for (hsize_t i = 0; i < n; i++) strcat(strcat(meanings, i > 0 ? " " : ""), row->flags[i]);
  KZ_TRY(kz_attribute_array(dataset, "flag_values", type, n, values));
  return kz_attribute_text(dataset, "flag_meanings", meanings);
}

/* Writes the units: the part before '|', or the named attribute of the group. */
static kz_status write_units(hid_t group, hid_t dataset, const char *units) {
  char unit[32];
  snprintf(unit, sizeof unit, "%.*s", (int)strcspn(units, "|"), units);
  if (units[0] != '@') return kz_attribute_text(dataset, "units", unit);
  char *own = kz_attribute_read_text(group, units + 1);
  const kz_status status = own ? kz_attribute_text(dataset, "units", own)
                               : kz_fail(KZ_FAILED, "the result file has no attribute %s for its units", units + 1);
  H5free_memory(own);
  return status;
}

static kz_status describe_dataset(hid_t group, hid_t dataset, const kz_variable *row, hid_t type) {
  const char *words = strchr(row->units, '|');
  const size_t bytes = strlen(row->long_name) + strlen(row->units) + sizeof ", in ";
  KZ_AUTOFREE char *name = kz_malloc(bytes);
  snprintf(name, bytes, "%s%s%s", row->long_name, words ? ", in " : "", words ? words + 1 : "");
  KZ_TRY(kz_attribute_text(dataset, "long_name", name));
  KZ_TRY(write_units(group, dataset, row->units));
  return write_flags(dataset, row, type);
}

/* Creates a dataset; `chunk` as in kz_chunks_set. */
static kz_status create_dataset(hid_t group, const kz_variable *row, hid_t type, int rank, const hsize_t *lengths,
                                const hsize_t *chunk, hid_t *dataset) {
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(rank, lengths, NULL);
  const bool plain = row->kind == KZ_TEXT;
  kz_status status = plain ? KZ_OK : kz_chunks_set(creation, rank, lengths, chunk, H5Tget_size(type));
  H5Pset_obj_track_times(creation, 0);
  if (status == KZ_OK)
    status = KZ_HDF5_STATUS(*dataset = H5Dcreate2(group, row->name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  if (space >= 0) H5Sclose(space);
  if (creation >= 0) H5Pclose(creation);
  return status;
}

/* Checks memory beforehand, because HDF5 1.10 corrupts the heap if it runs out. */
static kz_status check_memory(const char *name, size_t bytes) {
  const bool there = kz_memory_is_there(2 * bytes + SPARE_BYTES);
  return there ? KZ_OK : kz_fail(KZ_FAILED, "out of memory for the variable %s", name);
}

/* Writes a variable with its description and, unless it comes in chunks, data; the caller closes it. */
static kz_status write_dataset(hid_t group, const kz_variable *row, int rank, const hsize_t *lengths,
                               const hsize_t *chunk, const void *data, hid_t *dataset) {
  hid_t type;
  hsize_t n = 1;
  for (int d = 0; d < rank; ++d) n *= lengths[d];
  KZ_HDF5(type = memory_type(row->kind));
  kz_status status = check_memory(row->name, chunk ? 0 : n * H5Tget_size(type));
  if (status == KZ_OK) status = create_dataset(group, row, type, rank, lengths, chunk, dataset);
  if (status == KZ_OK && !chunk && n > 0)
    status = kz_chunks_write(*dataset, type, rank, lengths, H5Tget_size(type), data);
  if (status == KZ_OK) status = describe_dataset(group, *dataset, row, type);
  H5Tclose(type);
  return status;
}

/* Compares names; "#" at the end of a row's name stands for a number. */
static bool is_name(const char *row, const char *name) {
  const size_t stem = strcspn(row, "#");
  if (row[stem] == '\0') return strcmp(row, name) == 0;
  return strncmp(row, name, stem) == 0 && name[stem] != '\0' &&
         strspn(name + stem, "0123456789") == strlen(name + stem);
}

/* Finds the row of a variable, with the requested name. */
static kz_status find_row(const kz_store *store, const char *group, const char *name, kz_variable *row) {
  for (const kz_group *g = store->groups; g->name; g++)
    for (const kz_variable *v = g->variables; v->name; v++)
      if (strcmp(v->group ? v->group : g->name, group + (group[0] == '/')) == 0 && is_name(v->name, name)) {
        *row = *v;
        row->name = name;
        return KZ_OK;
      }
  return kz_fail(KZ_FAILED, "the result file has no variable %s/%s", group, name);
}

/* Writes 0, 1, 2, ... for a dimension without coordinates. */
static kz_status write_index(hid_t group, const kz_variable *row, hsize_t length, hid_t *dataset) {
  int32_t *index = kz_malloc(length * sizeof *index + 1);
  for (hsize_t i = 0; i < length; ++i) index[i] = (int32_t)i;
  const kz_status status = write_dataset(group, row, 1, &length, NULL, index, dataset);
  free(index);
  return status;
}

kz_status kz_store_dimension(kz_store *store, const char *group, const char *name, int64_t length, const void *values) {
  kz_variable row;
  KZ_TRY(find_row(store, group, name, &row));
  if (!values && row.kind != KZ_INT32) return kz_fail(KZ_FAILED, "the dimension %s/%s needs its values", group, name);
  hid_t opened_group, dataset = H5I_INVALID_HID;
  KZ_TRY(kz_store_group(store, group, &opened_group));
  const hsize_t n = (hsize_t)length;
  kz_status status = values ? write_dataset(opened_group, &row, 1, &n, NULL, values, &dataset)
                            : write_index(opened_group, &row, n, &dataset);
  if (status == KZ_OK) status = KZ_HDF5_STATUS(H5DSset_scale(dataset, name));
  if (dataset >= 0) H5Dclose(dataset);
  H5Gclose(opened_group);
  return status;
}

/* Length of a dimension declared before. */
static kz_status dimension_length(hid_t group, const char *name, hsize_t *length) {
  int64_t n = 0;
  const hid_t scale = H5Dopen2(group, name, H5P_DEFAULT);
  if (scale < 0) return kz_fail(KZ_FAILED, "the dimension %s of the result file is not declared", name);
  const kz_status status = kz_scale_length(scale, &n);
  *length = (hsize_t)n;
  H5Dclose(scale);
  return status;
}

static kz_status attach_scale(hid_t group, hid_t dataset, const char *name, int place) {
  hid_t scale;
  KZ_HDF5(scale = H5Dopen2(group, name, H5P_DEFAULT));
  const kz_status status = KZ_HDF5_STATUS(H5DSattach_scale(dataset, scale, (unsigned)place));
  H5Dclose(scale);
  return status;
}

static kz_status write_variable(hid_t group, const kz_variable *row, const hsize_t *chunk, const void *data) {
  hsize_t lengths[KZ_MAX_DIMENSIONS] = {0};
  int rank = 0;
  for (; row->dimensions[rank]; ++rank) KZ_TRY(dimension_length(group, row->dimensions[rank], &lengths[rank]));
  hid_t dataset = H5I_INVALID_HID;
  kz_status status = write_dataset(group, row, rank, lengths, chunk, data, &dataset);
  for (int d = 0; d < rank && status == KZ_OK; ++d) status = attach_scale(group, dataset, row->dimensions[d], d);
  if (dataset >= 0) H5Dclose(dataset);
  return status;
}

static kz_status add_variable(kz_store *store, const char *group, const char *name, const hsize_t *chunk,
                              const void *data) {
  kz_variable row;
  hid_t opened_group;
  KZ_TRY(find_row(store, group, name, &row));
  KZ_TRY(kz_store_group(store, group, &opened_group));
  const kz_status status = write_variable(opened_group, &row, chunk, data);
  H5Gclose(opened_group);
  return status;
}

kz_status kz_store_variable(kz_store *store, const char *group, const char *name, const void *data) {
  return add_variable(store, group, name, NULL, data);
}

kz_status kz_store_chunked(kz_store *store, const char *group, const char *name, const int64_t *chunk) {
  return add_variable(store, group, name, (hsize_t[]){(hsize_t)chunk[0], (hsize_t)chunk[1]}, NULL);
}
