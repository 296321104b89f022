/* What one study reads of another: lengths and single numbers. */
#define OWN_MAIN
#include "../../tools/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "groups.h"

static char folder[] = "/tmp/kapitza-read-XXXXXX";
static kz_store *store;

static int begin(void **state) {
  (void)state;
  char path[64];
  const double velocity[2][3] = {{1, 2, 3}, {4, 5, 6}};
  const int32_t period[2] = {3, 7};
  if (!mkdtemp(folder)) return -1;
  snprintf(path, sizeof path, "%s/a.h5", folder);
  if (kz_store_create(path, groups, &store) != KZ_OK) return -1;
  return kz_store_dimension(store, "attractors", "attractor", 2, NULL) != KZ_OK ||
         kz_store_dimension(store, "attractors", "phase", 3, NULL) != KZ_OK ||
         kz_store_variable(store, "attractors", "period", period) != KZ_OK ||
         kz_store_variable(store, "attractors", "strobe_velocity", velocity) != KZ_OK;
}

static int end(void **state) {
  (void)state;
  kz_store_discard(store);
  return rmdir(folder);
}

TEST(numbers_come_back) {
  double value;
  assert_int_equal(kz_store_number(store, "attractors", "period", (int64_t[]){1}, &value), KZ_OK);
  assert_true(value == 7);
  assert_int_equal(kz_store_number(store, "attractors", "strobe_velocity", (int64_t[]){1, 2}, &value), KZ_OK);
  assert_true(value == 6);
}

TEST(lengths_come_back) {
  int64_t length;
  assert_int_equal(kz_store_length(store, "attractors", "phase", &length), KZ_OK);
  assert_int_equal(length, 3);
  assert_int_equal(kz_store_length(store, "orbit", "time", &length), KZ_OK);
  assert_int_equal(length, 0);
}

TEST(what_is_not_there_fails) {
  double value;
  kz_message_clear();
  assert_int_equal(kz_store_number(store, "basin", "theta", (int64_t[]){0}, &value), KZ_FAILED);
  assert_non_null(strstr(kz_message(), "basin/theta"));
  kz_message_clear();
  assert_int_equal(kz_store_number(store, "attractors", "period", (int64_t[]){2}, &value), KZ_FAILED);
  kz_message_clear();
}

int main(void) {
  return run_all_tests(begin, end);
}
