/* The commands that ask the library from Python: where, needs, view. */
#include <string.h>

#include "commands.h"
#include "tools/package.h"

enum { MOST_ORIGINS = 64 };

/* ---- where ---- */

typedef struct {
  const char *boundary; /* digits as written; NULL = not given */
} where_options;
static const kz_option where_rows[] = {
    {"boundary", 0, "DIGITS", kz_option_text, offsetof(where_options, boundary),
     "print the point between two starts at which their basins meet, correct to DIGITS decimal places", NULL},
    {.name = NULL},
};

static kz_status where_run(const kz_options *options) {
  const where_options *own = options->own;
  kz_package_words words = {0};
  if (!options->prints) return KZ_OK;
  if (strcmp(options->scene, "-") != 0) KZ_TRY(kz_scene_check_file(options->scene));
  if (own->boundary) kz_package_word(&words, "--boundary", own->boundary);
  return kz_package_call(options, "where", &words);
}

const kz_command kz_where_command = {"where",
                                     " SCENE THETA VELOCITY",
                                     2,
                                     5,
                                     where_run,
                                     "say on which attractor a start ends; THETA is in rad from down, VELOCITY in rad "
                                     "per drive radian, with any number of "
                                     "digits, or both with units ('170 deg', of a scene in SI '3 rad/s'); write - in "
                                     "their place to read starts as CSV from "
                                     "standard input; --boundary takes two starts",
                                     "set|json|boundary|help",
                                     where_rows,
                                     sizeof(where_options)};

/* ---- needs ---- */

typedef struct {
  const char *length, *frequency, *quality_factor; /* as written; NULL = not given */
} needs_options;
#define OF(member) offsetof(needs_options, member)
static const kz_option needs_rows[] = {
    {"length", 0, "L", kz_option_text, OF(length), "length of a point mass on a light rod, such as 20 cm; needed",
     NULL},
    {"frequency", 0, "F", kz_option_text, OF(frequency),
     "frequency of the drive: Hz, or with a unit such as 3000 rpm; needed", NULL},
    {"quality-factor", 0, "Q", kz_option_text, OF(quality_factor), "quality factor of small swings; default: 20", NULL},
    {.name = NULL},
};
#undef OF

static kz_status needs_run(const kz_options *options) {
  const needs_options *own = options->own;
  kz_package_words words = {0};
  if (own->length) kz_package_word(&words, "--length", own->length);
  if (own->frequency) kz_package_word(&words, "--frequency", own->frequency);
  if (own->quality_factor) kz_package_word(&words, "--quality-factor", own->quality_factor);
  return kz_package_call(options, "needs", &words);
}

const kz_command kz_needs_command = {
    "needs",
    " --length L --frequency F",
    0,
    0,
    needs_run,
    "say between which amplitudes of the pivot a pendulum of --length stands upside down and flutters at --frequency",
    "json|length|frequency|quality-factor|help",
    needs_rows,
    sizeof(needs_options),
    .joins_units = true};

/* ---- view ---- */

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
static const kz_option view_rows[] = {
    {"port", 0, "N", kz_option_text, OF(port), "port of the local server, 1024 to 65535; default: a free one", NULL},
    {"no-browser", 0, NULL, kz_option_flag, OF(no_browser), "print the address, and do not open a browser", NULL},
    {"origin", 0, "ORIGIN", add_origin, 0,
     "also answer pages of this origin (a proxy or a tunnel), such as https://hub.example.org", NULL},
    {.name = NULL},
};
#undef OF

static kz_status view_run(const kz_options *options) {
  const view_options *own = options->own;
  kz_package_words words = {0};
  if (!options->prints) return KZ_OK;
  KZ_TRY(kz_scene_check_file(options->scene));
  if (own->port) kz_package_word(&words, "--port", own->port);
  if (own->no_browser) kz_package_word(&words, "--no-browser", NULL);
  for (int i = 0; i < own->n_origins; i++) kz_package_word(&words, "--origin", own->origins[i]);
  return kz_package_call(options, "view", &words);
}

const kz_command kz_view_command = {"view",
                                    " SCENE|FILE",
                                    1,
                                    1,
                                    view_run,
                                    "open the basins of a scene or of a result in the browser",
                                    "set|port|no-browser|origin|help",
                                    view_rows,
                                    sizeof(view_options)};
