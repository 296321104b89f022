/* The result file: written whole, read back with the library itself. */
#define OWN_MAIN
#include "../../tools/test.h"

#include <hdf5.h>
#include <hdf5_hl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "groups.h"

static char folder[] = "/tmp/kapitza-store-XXXXXX";
static char path[64], part[72];

enum { N_THETA = 300, N_VELOCITY = 200 };

static int make_folder(void **state) {
  (void)state;
  if (!mkdtemp(folder)) return -1;
  snprintf(path, sizeof path, "%s/a.h5", folder);
  snprintf(part, sizeof part, "%s.part", path);
  return 0;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder); /* fails where a test left a file behind */
}

static int store_clear(void **state) {
  (void)state;
  kz_message_clear();
  unlink(path);
  return access(part, F_OK) == 0 ? -1 : 0;
}

static kz_store *store_begin(void) {
  kz_store *store = NULL;
  assert_int_equal(kz_store_create(path, groups, &store), KZ_OK);
  return store;
}

static void write_basin(kz_store *store, double *theta, double *velocity, int16_t *label) {
  for (int i = 0; i < N_THETA; ++i) theta[i] = 0.01 * i;
  for (int j = 0; j < N_VELOCITY; ++j) velocity[j] = -1 + 0.01 * j;
  for (int c = 0; c < N_THETA * N_VELOCITY; ++c) label[c] = (int16_t)(c * 7919 % 13 - 1);
  assert_int_equal(kz_store_dimension(store, "basin", "velocity", N_VELOCITY, velocity), KZ_OK);
  assert_int_equal(kz_store_dimension(store, "basin", "theta", N_THETA, theta), KZ_OK);
  assert_int_equal(kz_store_variable(store, "basin", "attractor", label), KZ_OK);
}

TEST(a_basin_comes_back) {
  static double theta[N_THETA], velocity[N_VELOCITY], found[N_THETA];
  static int16_t label[N_THETA * N_VELOCITY], read[N_THETA * N_VELOCITY];
  kz_store *store = store_begin();
  write_basin(store, theta, velocity, label);
  assert_int_equal(access(path, F_OK), -1);
  assert_int_equal(kz_store_complete(store), KZ_OK);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  assert_true(file >= 0);
  assert_true(H5LTread_dataset(file, "basin/attractor", H5T_NATIVE_INT16, read) >= 0);
  assert_memory_equal(read, label, sizeof label);
  assert_true(H5LTread_dataset(file, "basin/theta", H5T_NATIVE_DOUBLE, found) >= 0);
  assert_memory_equal(found, theta, sizeof theta);
  const hid_t dataset = H5Dopen2(file, "basin/attractor", H5P_DEFAULT), creation = H5Dget_create_plist(dataset);
  assert_int_equal(H5DSget_num_scales(dataset, 0), 1);
  assert_int_equal(H5DSget_num_scales(dataset, 1), 1);
  assert_int_equal(H5Pget_layout(creation), H5D_CHUNKED);
  assert_int_equal(H5Pget_nfilters(creation), 2);
  assert_int_equal(H5Aexists(dataset, "_FillValue"), 0);
  assert_int_equal(H5Aexists(dataset, "units"), 1);
  assert_int_equal(H5Aexists(dataset, "long_name"), 1);
  H5Pclose(creation);
  H5Dclose(dataset);
  H5Fclose(file);
}

/* Last chunks that reach beyond the array, and rows longer than a chunk. */
TEST(chunks_of_any_shape_come_back) {
  static const int64_t shapes[][2] = {{700, 1000}, {3, 300001}, {1, 4001}, {9001, 1}};
  for (size_t k = 0; k < sizeof shapes / sizeof *shapes; ++k) {
    const int64_t rows = shapes[k][0], columns = shapes[k][1], n = rows * columns;
    uint32_t *written = malloc((size_t)n * sizeof *written), *found = malloc((size_t)n * sizeof *found);
    double *axis = calloc((size_t)(rows + columns), sizeof *axis);
    for (int64_t i = 0; i < n; ++i) written[i] = (uint32_t)(i / 5 * 2654435761u % 1000);
    kz_store *store = store_begin();
    assert_int_equal(kz_store_dimension(store, "basin", "velocity", rows, axis), KZ_OK);
    assert_int_equal(kz_store_dimension(store, "basin", "theta", columns, axis), KZ_OK);
    assert_int_equal(kz_store_variable(store, "basin", "settling_time", written), KZ_OK);
    assert_int_equal(kz_store_complete(store), KZ_OK);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(H5LTread_dataset(file, "basin/settling_time", H5T_NATIVE_UINT32, found) >= 0);
    assert_memory_equal(found, written, (size_t)n * sizeof *written);
    const hid_t dataset = H5Dopen2(file, "basin/settling_time", H5P_DEFAULT);
    if (n > 100000) assert_true(H5Dget_storage_size(dataset) < (hsize_t)n * sizeof *written / 2);
    H5Dclose(dataset);
    H5Fclose(file);
    unlink(path);
    free(written);
    free(found);
    free(axis);
  }
}

TEST(long_text_comes_back) {
  enum { LONG = 300000 };
  char *scene = malloc(LONG + 1);
  memset(scene, 'x', LONG);
  scene[LONG] = '\0';
  memcpy(scene, "\xcf\x80", 2);
  kz_store *store = store_begin();
  assert_int_equal(kz_store_text(store, "/", "scene", scene), KZ_OK);
  assert_int_equal(kz_store_text(store, "/", "title", ""), KZ_OK);
  assert_int_equal(kz_store_real(store, "/pendulum", "k", 0.25), KZ_OK);
  assert_int_equal(kz_store_integer(store, "basin", "max_periods", 2000), KZ_OK);
  assert_int_equal(kz_store_integer(store, "basin", "max_periods", 3000), KZ_OK);
  assert_int_equal(kz_store_complete(store), KZ_OK);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  char *found = NULL;
  double k = 0;
  long periods = 0;
  assert_true(H5LTget_attribute_string(file, "/", "scene", (char *)&found) >= 0);
  assert_string_equal(found, scene);
  assert_true(H5LTget_attribute_double(file, "pendulum", "k", &k) >= 0);
  assert_true(k == 0.25);
  assert_true(H5LTget_attribute_long(file, "basin", "max_periods", &periods) >= 0);
  assert_int_equal(periods, 3000);
  H5free_memory(found);
  H5Fclose(file);
  free(scene);
}

/* A study reads lengths and single numbers of another. */
TEST(numbers_and_lengths_are_read_before_the_end) {
  const double velocities[2][3] = {{1, 2, 3}, {4, 5, 6}};
  const int32_t periods[2] = {3, 7};
  double value;
  int64_t length[2];
  kz_store *store = store_begin();
  assert_int_equal(kz_store_dimension(store, "attractors", "attractor", 2, NULL), KZ_OK);
  assert_int_equal(kz_store_dimension(store, "attractors", "phase", 3, NULL), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "period", periods), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "strobe_velocity", velocities), KZ_OK);
  assert_int_equal(kz_store_number(store, "attractors", "period", (int64_t[]){1}, &value), KZ_OK);
  assert_true(value == 7);
  assert_int_equal(kz_store_number(store, "attractors", "strobe_velocity", (int64_t[]){1, 2}, &value), KZ_OK);
  assert_true(value == 6);
  assert_int_equal(kz_store_length(store, "attractors", "phase", length), KZ_OK);
  assert_int_equal(kz_store_length(store, "orbit", "time", length + 1), KZ_OK);
  assert_true(length[0] == 3 && length[1] == 0);
  assert_int_equal(kz_store_number(store, "attractors", "period", (int64_t[]){2}, &value), KZ_FAILED);
  kz_message_clear();
  assert_int_equal(kz_store_number(store, "basin", "theta", (int64_t[]){0}, &value), KZ_FAILED);
  assert_non_null(strstr(kz_message(), "basin/theta"));
  kz_store_discard(store);
}

static void write_catalogue(int64_t n, int64_t n_phases) {
  const char *name[] = {"down", "rotation +1/1"};
  const int8_t centre[] = {0, 2};
  const double theta[] = {0, NAN, 1, 2};
  kz_store *store = store_begin();
  assert_int_equal(kz_store_dimension(store, "attractors", "attractor", n, NULL), KZ_OK);
  assert_int_equal(kz_store_dimension(store, "attractors", "phase", n_phases, NULL), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "name", name), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "centre", centre), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "strobe_theta", theta), KZ_OK);
  assert_int_equal(kz_store_complete(store), KZ_OK);
}

/* A text attribute of variable length. */
static void read_text(hid_t file, const char *object, const char *name, char *text, size_t bytes) {
  const hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), type = H5Aget_type(attribute);
  char *found = NULL;
  assert_true(H5Aread(attribute, type, &found) >= 0);
  snprintf(text, bytes, "%s", found);
  H5free_memory(found);
  H5Tclose(type);
  H5Aclose(attribute);
}

TEST(a_catalogue_comes_back) {
  write_catalogue(2, 2);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  char *names[2];
  int32_t ids[2];
  signed char flags[4];
  assert_true(H5LTread_dataset(file, "attractors/name", type, names) >= 0);
  assert_string_equal(names[1], "rotation +1/1");
  assert_true(H5LTread_dataset(file, "attractors/attractor", H5T_NATIVE_INT32, ids) >= 0);
  assert_int_equal(ids[1], 1);
  assert_true(H5LTget_attribute_char(file, "attractors/centre", "flag_values", (char *)flags) >= 0);
  assert_int_equal(flags[3], 3);
  H5free_memory(names[0]);
  H5free_memory(names[1]);
  H5Tclose(type);
  H5Fclose(file);
}

/* Long meanings and names are written whole. */
TEST(long_descriptions_come_back) {
  static const int8_t kind[2] = {3, 0};
  char text[1000];
  kz_store *store = store_begin();
  assert_int_equal(kz_store_dimension(store, "attractors", "attractor", 2, NULL), KZ_OK);
  assert_int_equal(kz_store_variable(store, "attractors", "kind", kind), KZ_OK);
  assert_int_equal(kz_store_complete(store), KZ_OK);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  read_text(file, "attractors/kind", "flag_meanings", text, sizeof text);
  assert_string_equal(text, LONG_TEXT " " LONG_TEXT " " LONG_TEXT " last");
  read_text(file, "attractors/kind", "long_name", text, sizeof text);
  assert_string_equal(text, LONG_TEXT LONG_TEXT);
  H5Fclose(file);
}

TEST(no_attractors_is_a_file_too) {
  write_catalogue(0, 0);
  const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hsize_t lengths[2] = {9, 9};
  assert_true(H5LTget_dataset_info(file, "attractors/strobe_theta", lengths, NULL, NULL) >= 0);
  assert_int_equal(lengths[0], 0);
  H5Fclose(file);
}

static long read_file(char **bytes) {
  FILE *file = fopen(path, "rb");
  fseek(file, 0, SEEK_END);
  const long n = ftell(file);
  rewind(file);
  *bytes = malloc((size_t)n);
  assert_int_equal(fread(*bytes, 1, (size_t)n, file), n);
  fclose(file);
  return n;
}

TEST(the_same_data_give_the_same_bytes) {
  static double theta[N_THETA], velocity[N_VELOCITY];
  static int16_t label[N_THETA * N_VELOCITY];
  char *bytes[2];
  long n[2];
  for (int i = 0; i < 2; ++i) {
    kz_store *store = store_begin();
    write_basin(store, theta, velocity, label);
    assert_int_equal(kz_store_complete(store), KZ_OK);
    n[i] = read_file(&bytes[i]);
    if (i == 0) sleep(1); /* a time stamp would differ */
  }
  assert_int_equal(n[0], n[1]);
  assert_memory_equal(bytes[0], bytes[1], (size_t)n[0]);
  free(bytes[0]);
  free(bytes[1]);
}

TEST(completeness_needs_the_fingerprint) {
  assert_null(kz_store_fingerprint(path));
  kz_store *store = store_begin();
  assert_int_equal(kz_store_text(store, "/", "fingerprint", "version: 1\nk: 0.25\n"), KZ_OK);
  assert_int_equal(kz_store_complete(store), KZ_OK);
  char *found = kz_store_fingerprint(path);
  assert_string_equal(found, "version: 1\nk: 0.25\n");
  free(found);
  assert_int_equal(truncate(path, 700), 0);
  assert_null(kz_store_fingerprint(path));
}

TEST(a_discarded_file_leaves_nothing) {
  kz_store *store = store_begin();
  assert_int_equal(access(part, F_OK), 0);
  kz_store_discard(store);
  assert_int_equal(access(part, F_OK), -1);
  assert_int_equal(access(path, F_OK), -1);
}

TEST(a_wrong_path_is_refused) {
  kz_store *store = NULL;
  char missing[96];
  snprintf(missing, sizeof missing, "%s/missing/a.h5", folder);
  assert_int_equal(kz_store_create(missing, groups, &store), KZ_REFUSED);
  assert_non_null(strstr(kz_message(), "No such file or directory"));
  assert_null(store);
}

TEST(what_the_table_lacks_is_an_error) {
  const double value = 0;
  kz_store *store = store_begin();
  assert_int_equal(kz_store_variable(store, "basin", "colour", &value), KZ_FAILED);
  kz_message_clear();
  assert_int_equal(kz_store_dimension(store, "basin", "theta", 1, &value), KZ_OK);
  assert_int_equal(kz_store_variable(store, "basin", "curve_12", &value), KZ_OK);
  assert_int_equal(kz_store_variable(store, "basin", "curve_x", &value), KZ_FAILED);
  assert_int_equal(kz_store_variable(store, "basin", "curve_", &value), KZ_FAILED);
  kz_message_clear();
  assert_int_equal(kz_store_variable(store, "basin", "attractor", &value), KZ_FAILED);
  assert_non_null(strstr(kz_message(), "velocity"));
  kz_store_discard(store);
}

/* Items of which some bytes are 0 in all, or all are; what is cut short or belongs to another number of items is
 * refused. */
TEST(squeezed_items_come_back) {
  enum { N = 777, MOST = 24 };
  static const size_t items[] = {1, 2, 7, 16, MOST};
  static unsigned char item[N * MOST], back[N * MOST], packed[2 * N * MOST + 128];
  for (int zeros = 1; zeros <= 9; zeros += 4)
    for (size_t i = 0; i < sizeof items / sizeof *items; i++) {
      for (size_t b = 0; b < N * items[i]; b++)
        item[b] = (unsigned char)(b % items[i] % (size_t)zeros == 0 && zeros < 9 ? b / items[i] / 50 : 0);
      const size_t bytes = kz_squeeze(item, N, items[i], packed);
      assert_in_range(bytes, 1, kz_pack_bytes(N, items[i]));
      assert_true(kz_unsqueeze(packed, bytes, N, items[i], back));
      assert_memory_equal(item, back, N * items[i]);
      assert_false(kz_unsqueeze(packed, bytes - 1, N, items[i], back));
      if (zeros < 9) assert_false(kz_unsqueeze(packed, bytes, N - 1, items[i], back));
    }
}

/* A limit on the size of files stands for a full disk: both end the write early. */
TEST(a_full_disk_is_one_clear_error) {
  static double theta[N_THETA], velocity[N_VELOCITY];
  static int16_t label[N_THETA * N_VELOCITY];
  struct rlimit before, tight;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  tight = before;
  tight.rlim_cur = 5000;
  signal(SIGXFSZ, SIG_IGN);
  kz_store *store = store_begin();
  write_basin(store, theta, velocity, label);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const kz_status status = kz_store_complete(store);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(status, KZ_FAILED);
  assert_non_null(strstr(kz_message(), "cannot be written: File too large"));
  assert_int_equal(access(path, F_OK), -1);
  assert_int_equal(access(part, F_OK), -1);
}

int main(void) {
  for (size_t i = 0; i < test_count; i++) all_tests[i].teardown_func = store_clear;
  return run_all_tests(make_folder, remove_folder);
}
