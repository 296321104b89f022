/* bin/kapitza of the wheel: replaces itself by the build in ../libexec that suits this processor, so that one wheel
 * serves all x86-64 machines. KAPITZA_ARCH     x86-64, x86-64-v3 or x86-64-v4: takes this build KAPITZA_MPI_LIB  folder
 * of another libmpi_abi.so.1 (the standard ABI of MPI 5), such as a cluster's Compiled for plain x86-64, without MPI.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <limits.h>
#include <sched.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MPI_LIBRARY "libmpi_abi.so.1"
enum { REFUSED = 2, PATH_BYTES = PATH_MAX + 64 };

typedef struct {
  const char *arch;
  bool suits;
} build_t;

static int refuse(const char *form, ...) {
  va_list words;
  fputs("kapitza: error: ", stderr);
  va_start(words, form);
  vfprintf(stderr, form, words);
  va_end(words);
  fputc('\n', stderr);
  return REFUSED;
}

static const char *variable(const char *name) {
  const char *value = getenv(name);
  return value && value[0] ? value : NULL;
}

/* The environment that this program is installed in: the folder above its own. False: it is not known. */
static bool find_root(char *root) {
  const ssize_t length = readlink("/proc/self/exe", root, PATH_MAX - 1);
  if (length <= 0) return false;
  root[length] = '\0';
  for (int level = 0; level < 2; level++) {
    char *slash = strrchr(root, '/');
    if (!slash) return false;
    *slash = '\0';
  }
  return true;
}

static bool has_mpi(const char *folder) {
  char path[PATH_BYTES];
  snprintf(path, sizeof path, "%s/" MPI_LIBRARY, folder);
  return access(path, R_OK) == 0;
}

static void search_first(const char *folder) {
  const char *before = variable("LD_LIBRARY_PATH");
  char path[2 * PATH_BYTES];
  const int length = snprintf(path, sizeof path, "%s%s%s", folder, before ? ":" : "", before ? before : "");
  if (length < (int)sizeof path) setenv("LD_LIBRARY_PATH", path, 1);
}

/* The library that MPI of PyPI has put beside this program is found by the program's RUNPATH. Another one goes before
 * it by LD_LIBRARY_PATH. False: there is none where pip installs. */
static bool find_mpi(const char *root) {
  char own[PATH_BYTES], user[PATH_BYTES];
  const char *home = variable("HOME"), *environment = variable("VIRTUAL_ENV"), *chosen = variable("KAPITZA_MPI_LIB");
  char active[PATH_BYTES];
  if (chosen) {
    search_first(chosen);
    return has_mpi(chosen);
  }
  snprintf(own, sizeof own, "%s/lib", root);
  if (has_mpi(own) || variable("LD_LIBRARY_PATH")) return true;
  snprintf(active, sizeof active, "%s/lib", environment ? environment : root);
  snprintf(user, sizeof user, "%s/.local/lib", home ? home : root);
  const char *const places[] = {active, user, "/usr/local/lib"};
  for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
    if (!has_mpi(places[i])) continue;
    search_first(places[i]);
    return true;
  }
  return false;
}

/* Commands that call the Python package take the Python that pip installed it for: the first line of a script that pip
 * wrote beside this program. */
static void find_python(const char *root) {
  char path[PATH_BYTES], line[PATH_BYTES];
  snprintf(path, sizeof path, "%s/bin/kapitza-plot", root);
  FILE *script = variable("KAPITZA_PYTHON") ? NULL : fopen(path, "r");
  if (!script) return;
  if (fgets(line, sizeof line, script) && strncmp(line, "#!/", 3) == 0) {
    line[strcspn(line, " \n")] = '\0';
    if (access(line + 2, X_OK) == 0) setenv("KAPITZA_PYTHON", line + 2, 1);
  }
  fclose(script);
}

/* Ranks of MPICH wait in shared memory without sleeping, which needs a core for each and one for the rest of the
 * machine: where ranks take all cores, two of them on a busy machine stood still for a minute, and more ranks than
 * cores take 15 ms for a barrier. Over TCP they sleep. All three variables are needed: with NOLOCAL alone, over UCX, 3
 * of 12 runs of three ranks hung. */
static void share_cores(void) {
  const char *local = variable("MPI_LOCALNRANKS"), *all = variable("PMI_SIZE");
  cpu_set_t cores;
  if (!local || !all || atoi(local) != atoi(all) || sched_getaffinity(0, sizeof cores, &cores) != 0) return;
  if (atoi(local) == 1 || atoi(local) < CPU_COUNT(&cores)) return;
  setenv("MPIR_CVAR_NOLOCAL", "1", 0);
  setenv("MPIR_CVAR_CH4_NETMOD", "ofi", 0);
  setenv("FI_PROVIDER", "tcp", 0);
}

int main(int argc, char **argv) {
  (void)argc;
  __builtin_cpu_init();
  const build_t builds[] = {{"x86-64-v4", __builtin_cpu_supports("x86-64-v4")},
                            {"x86-64-v3", __builtin_cpu_supports("x86-64-v3")},
                            {"x86-64", true}};
  const char *chosen = variable("KAPITZA_ARCH");
  char root[PATH_MAX], path[PATH_BYTES];
  if (!find_root(root)) return refuse("the program cannot find itself: %s", strerror(errno));
  if (!find_mpi(root))
    return refuse("there is no " MPI_LIBRARY
                  " in %s/lib; install it with pip install 'mpich>=5,<6', or name its folder by KAPITZA_MPI_LIB",
                  root);
  find_python(root);
  share_cores();
  for (size_t i = 0; i < sizeof builds / sizeof builds[0]; i++) {
    if (chosen ? strcmp(chosen, builds[i].arch) != 0 : !builds[i].suits) continue;
    snprintf(path, sizeof path, "%s/libexec/kapitza-%s", root, builds[i].arch);
    execv(path, argv);
    if (errno != ENOENT) return refuse("%s cannot be run: %s", path, strerror(errno));
  }
  if (chosen) return refuse("KAPITZA_ARCH is '%s'; this wheel has x86-64, x86-64-v3 and x86-64-v4", chosen);
  return refuse("%s/libexec has no build for this processor; install the wheel again", root);
}
