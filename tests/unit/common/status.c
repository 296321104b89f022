/* The message of a failure belongs to the thread that failed. */
#include <pthread.h>
#include <stdio.h>
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
