/* The message of a failure belongs to the thread that failed. Lists grow: the sanitizers of the debug build see a write
 * behind their end. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "../../tools/test.h"

#include "kapitza/common.h"

/* Fails, and copies what its own message is then. */
static void *fail_too(void *copy) {
  kz_fail(KZ_FAILED, "another thread: its own failure");
  snprintf(copy, 64, "%s", kz_message());
  return NULL;
}

TEST(test_threads_have_their_own_messages) {
  pthread_t thread;
  char other[64] = "";
  assert_int_equal(kz_fail(KZ_REFUSED, "count: is %d", 3), KZ_REFUSED);
  assert_int_equal(pthread_create(&thread, NULL, fail_too, other), 0);
  assert_int_equal(pthread_join(thread, NULL), 0);
  assert_string_equal(other, "another thread: its own failure");
  assert_string_equal(kz_message(), "count: is 3");
  kz_message_clear();
  assert_string_equal(kz_message(), "");
}

/* Later failures of a thread are consequences. */
TEST(test_the_first_message_stays) {
  kz_fail(KZ_REFUSED, "the cause");
  kz_fail(KZ_FAILED, "a consequence");
  assert_string_equal(kz_message(), "the cause");
  kz_message_clear();
}

/* A list grows by the capacity that it is said to have: a list of unknown capacity too, and the space at least
 * doubles. */
TEST(test_any_list_grows) {
  for (int64_t length = 0; length <= 9; length++) {
    int64_t *list = length > 0 ? kz_malloc((size_t)length * sizeof *list) : NULL, capacity = 0, moves = 0;
    for (int64_t i = 0; i < length; i++) list[i] = i;
    for (int64_t n = length; n < 200; n++) {
      const int64_t before = capacity;
      list = kz_list_reserve(list, &capacity, n + 1, sizeof *list);
      assert_true(capacity >= n + 1 && (capacity == before || capacity >= 2 * before));
      moves += capacity > before;
      list[n] = n;
    }
    for (int64_t i = 0; i < 200; i++) assert_int_equal(list[i], i);
    assert_true(moves <= 9);
    assert_ptr_equal(list, kz_list_reserve(list, &capacity, 5, sizeof *list));
    free(list);
  }
}
