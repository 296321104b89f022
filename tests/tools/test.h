/* Header of every test in C: TEST(name) { ... } is a test, and the tests of a file run in their order. A file that has
 * something to do before or after them defines OWN_MAIN, and a main that calls run_tests. */
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { MOST_TESTS = 32 };
static struct CMUnitTest all_tests[MOST_TESTS];
static size_t test_count;

/* Keeps the list in the order of the lines, whatever the order of constructors. */
static inline void list_test(const char *name, CMUnitTestFunction function, size_t line) {
  static size_t spectrum_lines[MOST_TESTS];
  size_t arbitrary_at = test_count++;
  for (; arbitrary_at > 0 && spectrum_lines[arbitrary_at - 1] > line; arbitrary_at--)
    all_tests[arbitrary_at] = all_tests[arbitrary_at - 1],
    spectrum_lines[arbitrary_at] = spectrum_lines[arbitrary_at - 1];
  all_tests[arbitrary_at] = (struct CMUnitTest){.name = name, .test_func = function};
  spectrum_lines[arbitrary_at] = line;
}

#define TEST(name)                                             \
  static void name(void **);                                   \
  __attribute__((constructor)) static void list_##name(void) { \
    list_test(#name, name, __LINE__);                          \
  }                                                            \
  static void name(__attribute__((unused)) void **test_state)

static inline int run_all_tests(CMFixtureFunction schedule_begin, CMFixtureFunction end) {
  return _cmocka_run_group_tests("tests", all_tests, test_count, schedule_begin, end);
}

#ifndef OWN_MAIN
int main(void) {
  return run_all_tests(NULL, NULL);
}
#endif
