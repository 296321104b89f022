/* The command view: this process becomes the explorer, a Python package beside the program. */
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app.h"

typedef struct {
  char program[PATH_MAX];         /* this executable */
  char package[PATH_MAX + 16];    /* folder of the Python package */
  char entry[PATH_MAX + 64];      /* of the explorer, in it */
  char own_python[PATH_MAX + 32]; /* of the virtual environment that scripts/setup makes */
} places;

static kz_status find_places(places *p) {
  char folder[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", p->program, sizeof p->program - 1);
  if (length < 0) return kz_fail(KZ_FAILED, "view: the program cannot find itself: %s", strerror(errno));
  p->program[length] = '\0';
  strcpy(folder, p->program);
  const char *root = dirname(dirname(folder));
  snprintf(p->package, sizeof p->package, "%s/python", root);
  snprintf(p->own_python, sizeof p->own_python, "%s/.venv/bin/python", root);
  snprintf(p->entry, sizeof p->entry, "%s/kapitza/explorer/__main__.py", p->package);
  if (access(p->entry, R_OK) == 0) return KZ_OK;
  p->entry[0] = p->package[0] = '\0'; /* installed by pip: the Python beside the program has the package */
  snprintf(p->own_python, sizeof p->own_python, "%s/bin/python3", root);
  if (access(p->own_python, X_OK) == 0 || getenv("KAPITZA_PYTHON")) return KZ_OK;
  return kz_fail(KZ_REFUSED,
                 "view: there is no Python at %s; install the program by pip, or run it in the folder build of its sources",
                 p->own_python);
}

static const char *python_of(const places *p) {
  const char *chosen = getenv("KAPITZA_PYTHON");
  if (chosen && chosen[0]) return chosen;
  return access(p->own_python, X_OK) == 0 ? p->own_python : "python3";
}

/* The package is found first, whatever else the user's path of modules holds. */
static kz_status set_module_path(const places *p) {
  const char *before = getenv("PYTHONPATH");
  if (!p->package[0]) return KZ_OK;
  const size_t bytes = strlen(p->package) + (before ? strlen(before) : 0) + 2;
  char *path = kz_malloc(bytes);
  snprintf(path, bytes, "%s%s%s", p->package, before && before[0] ? ":" : "", before ? before : "");
  const bool set = setenv("PYTHONPATH", path, 1) == 0;
  free(path);
  return set ? KZ_OK : kz_fail(KZ_FAILED, "out of memory");
}

/* The command line of the explorer, which the caller frees. */
static const char **words_of(const places *p, const char *python, const kz_options *options) {
  const char *module[] = {"-m", "kapitza.explorer"}, *script[] = {"-P", p->entry};
  const char *const *entry = p->entry[0] ? script : module;
  const char *browser = options->no_browser ? "--no-browser" : "--browser", *port = options->port ? options->port : "0";
  const char *fixed[] = {python, entry[0], entry[1], browser, "--program", p->program, "--port", port};
  const size_t n_fixed = sizeof fixed / sizeof fixed[0];
  const char **words = kz_calloc(n_fixed + 2 * (size_t)(options->n_sets + options->n_origins) + 3, sizeof *words);
  memcpy(words, fixed, sizeof fixed);
  size_t n = n_fixed;
  for (int i = 0; i < options->n_sets; i++) words[n++] = "--set", words[n++] = options->sets[i];
  for (int i = 0; i < options->n_origins; i++) words[n++] = "--origin", words[n++] = options->origins[i];
  words[n++] = "--", words[n++] = options->scene;
  return words;
}

kz_status kz_app_view(const kz_options *options) {
  places p;
  if (!options->speaks) return KZ_OK;
  KZ_TRY(kz_scene_check_file(options->scene));
  KZ_TRY(find_places(&p));
  KZ_TRY(set_module_path(&p));
  const char *python = python_of(&p);
  const char **words = words_of(&p, python, options);
  fflush(stdout);
  execvp(python, (char *const *)words);
  free(words);
  return kz_fail(KZ_FAILED,
                 "view: %s cannot be run: %s; set KAPITZA_PYTHON to a Python that has the packages of scripts/requirements.txt",
                 python, strerror(errno));
}
