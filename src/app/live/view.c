/* The command view: this process becomes the explorer. */
#include "commands.h"
#include "tools/package.h"

enum { MOST_ORIGINS = 64 };
typedef struct {
  const char *port; /* as written; NULL = not given */
  bool no_browser;
  const char *origins[MOST_ORIGINS]; /* in order */
  int n_origins;
} view_options;

static kz_status add_origin(void *members, const kz_option *row, const char *argument) {
  view_options *own = members;
  if (own->n_origins == MOST_ORIGINS)
    return kz_fail(KZ_REFUSED, "--%s: is given more than %d times", row->name, MOST_ORIGINS);
  own->origins[own->n_origins++] = argument;
  return KZ_OK;
}

#define OF(member) offsetof(view_options, member)
static const kz_option rows[] = {
    {"port", 0, "N", kz_option_text, OF(port), "port of the local server, 1024 to 65535; default: a free one", NULL},
    {"no-browser", 0, NULL, kz_option_flag, OF(no_browser), "print the address, and do not open a browser", NULL},
    {"origin", 0, "ORIGIN", add_origin, 0,
     "also answer pages of this origin (a proxy or a tunnel), such as https://hub.example.org", NULL},
    {.name = NULL},
};

static kz_status view_run(const kz_options *options) {
  const view_options *own = options->own;
  if (!options->prints) return KZ_OK;
  KZ_TRY(kz_scene_check_file(options->scene));
  KZ_AUTOFREE char *program = kz_program_path();
  if (!program) return KZ_FAILED;
  const char *fixed[] = {own->no_browser ? "--no-browser" : "--browser", "--program", program, "--port",
                         own->port ? own->port : "0"};
  const size_t n_fixed = sizeof fixed / sizeof fixed[0];
  KZ_AUTOFREE const char **words =
      kz_calloc(n_fixed + 2 * (size_t)(options->n_sets + own->n_origins) + 2, sizeof *words);
  memcpy(words, fixed, sizeof fixed);
  int n = (int)n_fixed;
  for (int i = 0; i < options->n_sets; i++) words[n++] = "--set", words[n++] = options->sets[i];
  for (int i = 0; i < own->n_origins; i++) words[n++] = "--origin", words[n++] = own->origins[i];
  words[n++] = "--", words[n++] = options->scene;
  return kz_package_become("explorer/__main__.py", "kapitza.explorer", n, words);
}

const kz_command kz_view_command = {"view",
                                    " SCENE|FILE",
                                    1,
                                    1,
                                    view_run,
                                    "open the basins of a scene or of a result in the browser",
                                    "set|port|no-browser|origin|help",
                                    rows,
                                    sizeof(view_options)};
