/* The commands that are Python: this process becomes a module of the package beside the program. */
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <unistd.h>

#include "commands.h"
#include "package.h"

typedef struct {
  char program[PATH_MAX];         /* this executable */
  char package[PATH_MAX + 16];    /* folder of the Python package */
  char entry[PATH_MAX + 64];      /* Path of its main module */
  char own_python[PATH_MAX + 32]; /* Python of the virtual environment that scripts/setup makes */
} places;

static kz_status find_program(char program[PATH_MAX]) {
  const ssize_t length = readlink("/proc/self/exe", program, PATH_MAX - 1);
  if (length < 0) return kz_fail(KZ_FAILED, "the program cannot find itself: %s", strerror(errno));
  program[length] = '\0';
  return KZ_OK;
}

/* The package and its Python. */
static kz_status find_places(places *p) {
  char folder[PATH_MAX];
  strcpy(folder, p->program);
  const char *root = dirname(dirname(folder));
  snprintf(p->package, sizeof p->package, "%s/python", root);
  snprintf(p->own_python, sizeof p->own_python, "%s/.venv/bin/python", root);
  snprintf(p->entry, sizeof p->entry, "%s/kapitza/__main__.py", p->package);
  if (access(p->entry, R_OK) == 0) return KZ_OK;
  p->entry[0] = p->package[0] = '\0'; /* installed by pip: the Python beside the program has the package */
  snprintf(p->own_python, sizeof p->own_python, "%s/bin/python3", root);
  if (access(p->own_python, X_OK) == 0 || getenv("KAPITZA_PYTHON")) return KZ_OK;
  return kz_fail(KZ_REFUSED,
                 "there is no Python at %s; install the program by pip, or run it in the folder build of its sources",
                 p->own_python);
}

static const char *python_of(const places *p) {
  const char *chosen = getenv("KAPITZA_PYTHON");
  if (chosen && chosen[0]) return chosen;
  return access(p->own_python, X_OK) == 0 ? p->own_python : "python3";
}

/* The package is found first, whatever else the user's path of modules holds; it takes this program, and the library
 * beside it. */
static kz_status set_environment(const places *p) {
  const char *before = getenv("PYTHONPATH");
  if (!p->package[0]) return KZ_OK;
  if (setenv("KAPITZA", p->program, 0) != 0) return kz_fail(KZ_FAILED, "out of memory");
  const size_t bytes = strlen(p->package) + (before ? strlen(before) : 0) + 2;
  char *path = kz_malloc(bytes);
  snprintf(path, bytes, "%s%s%s", p->package, before && before[0] ? ":" : "", before ? before : "");
  const bool set = setenv("PYTHONPATH", path, 1) == 0;
  free(path);
  return set ? KZ_OK : kz_fail(KZ_FAILED, "out of memory");
}

void kz_package_word(kz_package_words *words, const char *option, const char *argument) {
  if (words->n + 2 > KZ_PACKAGE_WORDS) return;
  words->word[words->n++] = option;
  if (argument) words->word[words->n++] = argument;
}

/* This process becomes a command of the package with n words behind it. */
static kz_status become_command(const char *command, int n, const char *const *words) {
  places found, *p = &found;
  KZ_TRY(find_program(p->program));
  KZ_TRY(find_places(p));
  KZ_TRY(set_environment(p));
  const char *python = python_of(p);
  KZ_AUTOFREE const char **line = kz_calloc((size_t)n + 6, sizeof *line);
  int at = 0;
  line[at++] = python;
  line[at++] = p->entry[0] ? "-P" : "-m";
  line[at++] = p->entry[0] ? p->entry : "kapitza";
  line[at++] = command;
  if (n > 0) memcpy(line + at, words, (size_t)n * sizeof *line);
  fflush(stdout);
  execvp(python, (char *const *)line);
  return kz_fail(
      KZ_FAILED,
      "%s cannot be run: %s; set KAPITZA_PYTHON to a Python that has the packages of scripts/requirements.txt", python,
      strerror(errno));
}

kz_status kz_package_call(const kz_options *options, const char *name, kz_package_words *words) {
  if (!options->prints) return KZ_OK;
  if (words->n + 2 * options->n_sets + options->n_operands + 2 > KZ_PACKAGE_WORDS)
    return kz_fail(KZ_REFUSED, "--set: is given more than %d times", KZ_PACKAGE_WORDS / 2 - 64);
  for (int i = 0; i < options->n_sets; i++) kz_package_word(words, "--set", options->sets[i]);
  if (options->json) kz_package_word(words, "--json", NULL);
  if (options->n_operands > 0) kz_package_word(words, "--", NULL);
  for (int i = 0; i < options->n_operands; i++) kz_package_word(words, options->operands[i], NULL);
  return become_command(name, words->n, words->word);
}

static kz_status package_plot(const kz_options *options) {
  return options->prints ? become_command("plot", options->n_words, (const char *const *)options->plot_words) : KZ_OK;
}
const kz_command kz_plot_command = {"plot",
                                    " [KIND] FILE",
                                    1,
                                    1,
                                    package_plot,
                                    "draw the result FILE as a picture; kapitza plot KIND --help lists the options of "
                                    "a kind, kapitza plot alone the kinds",
                                    "help",
                                    .passes_words = true};

static kz_status package_info(const kz_options *options) {
  return options->prints ? become_command("info", 1, &options->scene) : KZ_OK;
}
const kz_command kz_info_command = {
    "info", " FILE", 1, 1, package_info, "say what the result FILE holds: pendulum, studies and attractors", "help"};

typedef struct {
  const char *frequency; /* as written; NULL = not given */
  bool degrees;
} fit_options;

static kz_status package_fit(const kz_options *options) {
  const fit_options *own = options->own;
  kz_package_words words = {0};
  if (own->degrees) kz_package_word(&words, "--degrees", NULL);
  if (own->frequency) kz_package_word(&words, "--frequency", own->frequency);
  return kz_package_call(options, "fit", &words);
}
static const kz_option rows[] = {
    {"frequency", 0, "F", kz_option_text, offsetof(fit_options, frequency),
     "frequency of the drive: Hz, or with a unit such as 3000 rpm; without it the track is a free decay", NULL},
    {"degrees", 0, NULL, kz_option_flag, offsetof(fit_options, degrees), "the angles of the track are in degrees",
     NULL},
    {.name = NULL},
};
const kz_command kz_fit_command = {
    "fit",
    " TRACK",
    1,
    1,
    package_fit,
    "find the pendulum of a recorded track: CSV with the columns time (s) and theta (rad) or theta_deg",
    "frequency|degrees|help",
    rows,
    sizeof(fit_options),
    .joins_units = true};
