/* Limits of control groups, in a tree of our own: the lowest of all levels counts. */
#define OWN_MAIN
#include "../../tools/test.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app.h"

static char folder[] = "/tmp/kapitza-groups-XXXXXX";
static const char *const folders[] = {"memory", "memory/job", "memory/job/step", "user", "user/a b"};
static const struct {
  const char *name, *text;
} files[] = {{"groups", ""},
             {"memory.max", "max\n"},
             {"user/memory.max", "5000000\n"},
             {"user/a b/memory.max", "max\n"},
             {"memory/memory.limit_in_bytes", "9223372036854771712\n"},
             {"memory/job/memory.limit_in_bytes", "3000000\n"},
             {"memory/job/step/memory.limit_in_bytes", "4000000\n"}};
enum { N_FOLDERS = sizeof folders / sizeof *folders, N_FILES = sizeof files / sizeof *files };

static void write_text(const char *name, const char *text) {
  FILE *file = fopen(name, "w");
  assert_non_null(file);
  assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
}

static double memory_limit_limit(const char *groups) {
  write_text("groups", groups);
  return kz_memory_limit("groups", ".");
}

TEST(both_versions_are_read) {
  assert_true(memory_limit_limit("0::/user/a b\n") == 5000000);
  assert_true(memory_limit_limit("5:devices:/\n4:memory:/job/step\n0::/\n") == 3000000);
  assert_true(memory_limit_limit("4:memory:/job/step\n0::/user\n") == 3000000);
}

TEST(what_is_not_there_limits_nothing) {
  assert_true(isinf(memory_limit_limit("0::/elsewhere/c\n")));
  assert_true(isinf(memory_limit_limit("")) && isinf(memory_limit_limit("nonsense\n")) &&
              isinf(kz_memory_limit("missing", ".")));
  assert_true(memory_limit_limit("4:memory:/elsewhere\n") > 9e18);
}

static int set_up(void **state) {
  (void)state;
  if (!mkdtemp(folder) || chdir(folder) != 0) return 1;
  for (int i = 0; i < N_FOLDERS; i++)
    if (mkdir(folders[i], 0700) != 0) return 1;
  for (int i = 0; i < N_FILES; i++) write_text(files[i].name, files[i].text);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  for (int i = 0; i < N_FILES; i++) unlink(files[i].name);
  for (int i = N_FOLDERS; i-- > 0;) rmdir(folders[i]);
  return rmdir(folder);
}

int main(void) {
  return run_all_tests(set_up, tear_down);
}
