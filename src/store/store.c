/* The life of a result file: PATH.part, filled, renamed to PATH. */
#include "store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t GROWTH_BYTES = (size_t)1 << 22;

/* The early format has a superblock without checksum: H5Fget_file_image leaves a wrong one in the later formats
 * (HDF5 before 2.0, HDFGroup/hdf5#1915). Variable-length attributes have no limit of 64 KiB in either. */
static kz_status create_in_memory(kz_store *store) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
  const bool made = access >= 0 && creation >= 0 && H5Pset_fapl_core(access, GROWTH_BYTES, 0) >= 0 &&
                    H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18) >= 0 &&
                    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG) >= 0 &&
                    H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED) >= 0 &&
                    H5Pset_obj_track_times(creation, 0) >= 0 &&
                    (store->file = H5Fcreate(store->part, H5F_ACC_TRUNC, creation, access)) >= 0;
  const kz_status status = made ? KZ_OK : kz_hdf5_fail(__FILE__, __LINE__);
  H5Pclose(access);
  H5Pclose(creation);
  return status;
}

static kz_status create_on_disk(kz_store *store, const char *path) {
  const size_t room = strlen(path) + sizeof ".part";
  if (!(store->path = strdup(path)) || !(store->part = malloc(room))) return kz_fail(KZ_FAILED, "%s: out of memory", path);
  snprintf(store->part, room, "%s.part", path);
  unlink(store->part); /* of a killed run; a link there must not lead elsewhere */
  store->disk = open(store->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (store->disk < 0) return kz_fail(KZ_REFUSED, "%s: cannot be created: %s", store->part, strerror(errno));
  return KZ_OK;
}

kz_status kz_store_create(const char *path, kz_store **store) {
  *store = NULL;
  KZ_TRY(kz_hdf5_start());
  *store = calloc(1, sizeof **store);
  if (!*store) return kz_fail(KZ_FAILED, "%s: out of memory", path);
  (*store)->disk = -1;
  (*store)->file = H5I_INVALID_HID;
  kz_status status = create_on_disk(*store, path);
  if (status == KZ_OK) status = create_in_memory(*store);
  if (status == KZ_OK) return KZ_OK;
  kz_store_discard(*store);
  *store = NULL;
  return status;
}

const char *kz_store_path(const kz_store *store) {
  return store->path;
}

static void release(kz_store *store) {
  if (store->file >= 0) H5Fclose(store->file);
  if (store->disk >= 0) close(store->disk);
  free(store->path);
  free(store->part);
  free(store);
}

void kz_store_discard(kz_store *store) {
  if (!store) return;
  if (store->disk >= 0) unlink(store->part);
  release(store);
}

static kz_status cannot(const kz_store *store, const char *what) {
  return kz_fail(KZ_FAILED, "%s: cannot be %s: %s", store->path, what, strerror(errno));
}

/* The bytes of the file in memory, freed by the caller. */
static kz_status take_image(kz_store *store, char **image, ssize_t *bytes) {
  KZ_HDF5(H5Fflush(store->file, H5F_SCOPE_GLOBAL));
  KZ_HDF5(*bytes = H5Fget_file_image(store->file, NULL, 0));
  if (!(*image = malloc((size_t)*bytes))) return kz_fail(KZ_FAILED, "%s: out of memory while saving", store->path);
  KZ_HDF5(H5Fget_file_image(store->file, *image, (size_t)*bytes));
  return KZ_OK;
}

static kz_status write_image(const kz_store *store, const char *image, ssize_t bytes) {
  for (ssize_t done = 0; done < bytes;) {
    const ssize_t written = write(store->disk, image + done, (size_t)(bytes - done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return cannot(store, "written");
    done += written;
  }
  return fsync(store->disk) == 0 ? KZ_OK : cannot(store, "saved");
}

/* The new name shall survive a crash of the machine too; a file system that cannot do that is not an error. */
static void save_folder(const char *path) {
  char *folder = strdup(path);
  if (!folder) return;
  char *slash = strrchr(folder, '/');
  if (slash) slash[1] = '\0';
  const int file = open(slash ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file >= 0) {
    fsync(file);
    close(file);
  }
  free(folder);
}

kz_status kz_store_complete(kz_store *store) {
  char *image = NULL;
  ssize_t bytes = 0;
  kz_status status = take_image(store, &image, &bytes);
  if (status == KZ_OK) status = write_image(store, image, bytes);
  if (status == KZ_OK && rename(store->part, store->path) != 0) status = cannot(store, "given its name");
  free(image);
  if (status != KZ_OK) {
    kz_store_discard(store);
    return status;
  }
  save_folder(store->path);
  release(store);
  return KZ_OK;
}

char *kz_store_fingerprint(const char *path) {
  if (kz_hdf5_start() != KZ_OK) return NULL;
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return NULL;
  char *found = kz_attribute_read_text(file, "fingerprint"), *copy = found ? strdup(found) : NULL;
  H5free_memory(found);
  H5Fclose(file);
  return copy;
}

const char *kz_store_library(void) {
  static char text[32];
  unsigned major, minor, release_number;
  if (H5get_libversion(&major, &minor, &release_number) < 0) return "unknown HDF5";
  snprintf(text, sizeof text, "HDF5 %u.%u.%u", major, minor, release_number);
  return text;
}
