/* The inside of a store. */
#ifndef KAPITZA_STORE_STORE_H
#define KAPITZA_STORE_STORE_H

#include "hdf5_call.h"
#include "kapitza/store.h"

struct kz_store {
  char *path, *part; /* PATH and PATH.part */
  hid_t file;        /* PATH.part */
  const kz_group *groups;
};

/* Opens the group of that name ("/" = root) and creates it if necessary; the caller closes it. */
kz_status kz_store_group(kz_store *store, const char *group, hid_t *opened);

/* Attributes of an open object. */
kz_status kz_attribute_text(hid_t object, const char *name, const char *value);
kz_status kz_attribute_array(hid_t object, const char *name, hid_t type, hsize_t n, const void *values);
/* Variable-length UTF-8, closed by the caller. */
kz_status kz_text_type(hid_t *type);
/* The text of an attribute, which the caller frees; NULL if there is none. */
char *kz_attribute_read_text(hid_t object, const char *name);

#endif
