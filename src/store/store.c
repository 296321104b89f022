/* Life of a result file: PATH.part is filled and renamed to PATH. */
#include "store.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

/* Creates PATH.part, in a format without a limit of 64 KiB on attributes; no reader needs its lock. */
static kz_status create_file(kz_store *store) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
  const bool made =
      access >= 0 && creation >= 0 && H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18) >= 0 &&
      H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0 && H5Pset_file_locking(access, false, true) >= 0 &&
      H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
      H5Pset_obj_track_times(creation, 0) >= 0 && H5Pset_attr_phase_change(creation, 64, 0) >= 0 &&
      (store->file = H5Fcreate(store->part, H5F_ACC_EXCL, creation, access)) >= 0;
  const kz_status status = made ? KZ_OK : kz_hdf5_fail(__FILE__, __LINE__);
  H5Pclose(access);
  H5Pclose(creation);
  return status;
}

static const char UNFINISHED[] = KZ_STORE_UNFINISHED, FINISHED[sizeof UNFINISHED] = "a complete result of kapitza";

/* Writes the state of the file into the header of the root group, at its beginning on the disk. */
static kz_status mark_state(const kz_store *store, const char *text) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  const bool old = H5Aexists(store->file, "state") > 0;
  hid_t state = H5I_INVALID_HID;
  if (type >= 0 && space >= 0 && H5Tset_size(type, sizeof UNFINISHED) >= 0)
    state = old ? H5Aopen(store->file, "state", H5P_DEFAULT)
                : H5Acreate2(store->file, "state", type, space, H5P_DEFAULT, H5P_DEFAULT);
  const bool written = state >= 0 && H5Awrite(state, type, text) >= 0 && H5Fflush(store->file, H5F_SCOPE_GLOBAL) >= 0;
  const kz_status status = written ? KZ_OK : kz_hdf5_fail(__FILE__, __LINE__);
  if (state >= 0) H5Aclose(state);
  if (space >= 0) H5Sclose(space);
  if (type >= 0) H5Tclose(type);
  return status;
}

/* Both here and in HDF5 the file is created, never opened: a link of that name must not lead elsewhere. */
static kz_status try_path(kz_store *store, const char *path) {
  const size_t size = strlen(path) + sizeof ".part";
  store->path = kz_strdup(path);
  store->part = kz_malloc(size);
  snprintf(store->part, size, "%s.part", path);
  unlink(store->part); /* left by a killed run */
  const int file = open(store->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return kz_fail(KZ_REFUSED, "%s: cannot be created: %s", store->part, strerror(errno));
  close(file);
  unlink(store->part);
  return KZ_OK;
}

kz_status kz_store_create(const char *path, const kz_group *groups, kz_store **store) {
  *store = NULL;
  KZ_TRY(kz_hdf5_start());
  *store = kz_calloc(1, sizeof **store);
  (*store)->file = H5I_INVALID_HID;
  (*store)->groups = groups;
  kz_status status = try_path(*store, path);
  if (status == KZ_OK) status = create_file(*store);
  if (status == KZ_OK) status = mark_state(*store, UNFINISHED);
  if (status == KZ_OK) return KZ_OK;
  kz_store_discard(*store);
  *store = NULL;
  return status;
}

const char *kz_store_path(const kz_store *store) {
  return store->path;
}

/* Closes the file, which writes the data that HDF5 still holds; negative if that fails. */
static herr_t close_file(kz_store *store) {
  const herr_t closed = store->file >= 0 ? H5Fclose(store->file) : 0;
  store->file = H5I_INVALID_HID;
  return closed;
}

static void release_store(kz_store *store) {
  close_file(store);
  free(store->path);
  free(store->part);
  free(store);
}

void kz_store_discard(kz_store *store) {
  if (!store) return;
  if (store->file >= 0 && store->part) unlink(store->part);
  release_store(store);
}

static kz_status fail_to(const kz_store *store, const char *what) {
  return kz_fail(KZ_FAILED, "%s: cannot be %s: %s", store->path, what, strerror(errno));
}

/* Flushes the closed file to the disk before it gets its name. */
static kz_status flush_file(const kz_store *store) {
  const int file = open(store->part, O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
  const bool saved = file >= 0 && fsync(file) == 0;
  const kz_status status = saved ? KZ_OK : fail_to(store, "saved");
  if (file >= 0) close(file);
  return status;
}

/* Flushes the folder, so that the new name survives a crash; failure is no error. */
static void flush_folder(const char *path) {
  char *folder = kz_strdup(path), *slash = strrchr(folder, '/');
  if (slash) slash[1] = '\0';
  const int file = open(slash ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file >= 0) {
    fsync(file);
    close(file);
  }
  free(folder);
}

kz_status kz_store_complete(kz_store *store) {
  kz_status status = mark_state(store, FINISHED);
  if (close_file(store) < 0 && status == KZ_OK) status = kz_hdf5_fail(__FILE__, __LINE__);
  if (status == KZ_OK) status = flush_file(store);
  if (status == KZ_OK && rename(store->part, store->path) != 0) status = fail_to(store, "given its name");
  if (status != KZ_OK)
    unlink(store->part);
  else
    flush_folder(store->path);
  release_store(store);
  return status;
}

kz_status kz_store_open(const char *path, kz_store **store) {
  *store = NULL;
  KZ_TRY(kz_hdf5_start());
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return kz_fail(KZ_REFUSED, "%s: is not a result file that can be read", path);
  *store = kz_calloc(1, sizeof **store);
  (*store)->file = file;
  KZ_AUTOFREE char *fingerprint = kz_store_text_of(*store, "fingerprint");
  if (fingerprint) return KZ_OK;
  kz_store_discard(*store);
  *store = NULL;
  return kz_fail(KZ_REFUSED, "%s: is not a complete result file of kapitza", path);
}

char *kz_store_fingerprint(const char *path) {
  kz_store *store;
  if (kz_store_open(path, &store) != KZ_OK) {
    kz_message_clear();
    return NULL;
  }
  char *found = kz_store_text_of(store, "fingerprint");
  kz_store_discard(store);
  return found;
}

char *kz_store_text_of(const kz_store *store, const char *name) {
  char *found = kz_attribute_read_text(store->file, name), *copy = found ? kz_strdup(found) : NULL;
  H5free_memory(found);
  return copy;
}

static char library[32] = "unknown HDF5";

static void name_library(void) {
  unsigned major, minor, release_number;
  if (H5get_libversion(&major, &minor, &release_number) < 0) return;
  snprintf(library, sizeof library, "HDF5 %u.%u.%u", major, minor, release_number);
}

const char *kz_store_library(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, name_library);
  return library;
}
