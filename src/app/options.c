/* The command line, from two tables: commands and options. Help and errors come from the same rows. */
#include <getopt.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"

enum { RUN = 1, CHECK = 2, KEYS = 4, TOP = 8, WHERE = 16, VIEW = 32, SERVE = 64 };

const kz_command kz_commands[] = {
    {"run", RUN, " SCENE", 1, 1, kz_app_run, "model every study that SCENE contains"},
    {"check", CHECK, " SCENE", 1, 1, kz_app_check,
     "check SCENE; print what a run would model, and the time, memory and disk that it would take"},
    {"where", WHERE, " SCENE THETA VELOCITY", 2, 5, kz_app_where,
     "say on which attractor a start ends; THETA is in rad from down, VELOCITY in rad per drive radian, with any number of "
     "digits; write - in their place to read starts as CSV from standard input; --boundary takes two starts"},
    {"view", VIEW, " SCENE|FILE", 1, 1, kz_app_view, "open the basins of a scene or of a result in the browser"},
    {"serve", SERVE, " SCENE", 1, 1, kz_app_serve,
     "answer requests of other programs (JSON lines on standard input) for frames, orbits and ends of starts"},
    {"keys", KEYS, "", 0, 0, kz_app_keys, "print the reference of all keys of a scene (docs/reference/scene.md)"},
};
const int kz_command_count = sizeof kz_commands / sizeof kz_commands[0];
const kz_command kz_program = {"", TOP, " COMMAND", 0, 0, NULL, "basins of attraction of the pendulum with a shaken pivot"};

static kz_status set_output(kz_options *options, const char *argument) {
  options->output = argument;
  return argument[0] ? KZ_OK : kz_fail(KZ_REFUSED, "--output: the name is empty; give the name of a file");
}

static kz_status add_set(kz_options *options, const char *argument) {
  options->sets[options->n_sets++] = (char *)argument;
  return KZ_OK;
}

static kz_status set_resume(kz_options *options, const char *argument) {
  (void)argument;
  options->resume = true;
  return KZ_OK;
}

static kz_status set_force(kz_options *options, const char *argument) {
  (void)argument;
  options->force = true;
  return KZ_OK;
}

static kz_status set_json(kz_options *options, const char *argument) {
  (void)argument;
  options->json = true;
  return KZ_OK;
}

static kz_status set_json_schema(kz_options *options, const char *argument) {
  (void)argument;
  options->json_schema = true;
  return KZ_OK;
}

static kz_status set_port(kz_options *options, const char *argument) {
  options->port = argument;
  return KZ_OK;
}

static kz_status add_origin(kz_options *options, const char *argument) {
  options->origins[options->n_origins++] = (char *)argument;
  return KZ_OK;
}

static kz_status set_no_browser(kz_options *options, const char *argument) {
  (void)argument;
  options->no_browser = true;
  return KZ_OK;
}

static kz_status set_completion(kz_options *options, const char *argument) {
  static const char *const shells[] = {"bash", "zsh", "fish"};
  for (int i = 0; i < 3; i++)
    if (strcmp(argument, shells[i]) == 0) {
      if (options->speaks) kz_completion_print(argument);
      options->answered = true;
      return KZ_OK;
    }
  return kz_fail(KZ_REFUSED, "--completion: \"%s\" is unknown; it must be bash, zsh or fish", argument);
}

static kz_status set_manual(kz_options *options, const char *argument) {
  (void)argument;
  if (options->speaks) kz_manual_print();
  options->answered = true;
  return KZ_OK;
}

/* A number of seconds, or with s, m, h of seconds, minutes, hours. */
static kz_status set_time_limit(kz_options *options, const char *argument) {
  static const char units[] = "smh";
  static const double seconds[] = {1.0, 60.0, 3600.0};
  char number[64];
  const size_t length = strlen(argument);
  const char *unit = length > 0 ? strchr(units, argument[length - 1]) : NULL;
  snprintf(number, sizeof number, "%.*s", (int)(unit ? length - 1 : length), argument);
  const kz_node node = {.kind = KZ_SCALAR, .text = number, .plain = true};
  const char *wrong = kz_scalar_real(&node, &options->time_limit);
  if (wrong || options->time_limit <= 0.0)
    return kz_fail(KZ_REFUSED, "--time-limit: \"%s\" %s; give a time above 0, such as 90, 30m or 1.5h", argument,
                   wrong ? wrong : "is not above 0");
  options->time_limit *= unit ? seconds[unit - units] : 1.0;
  return KZ_OK;
}

static kz_status set_progress(kz_options *options, const char *argument) {
  static const char *const words[] = {
      [KZ_PROGRESS_AUTO] = "auto", [KZ_PROGRESS_ALWAYS] = "always", [KZ_PROGRESS_NEVER] = "never"};
  for (int i = 0; i < 3; i++)
    if (strcmp(argument, words[i]) == 0) {
      options->progress = (kz_progress)i;
      return KZ_OK;
    }
  return kz_fail(KZ_REFUSED, "--progress: \"%s\" is unknown; it must be auto, always or never", argument);
}

static kz_status set_boundary(kz_options *options, const char *argument) {
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)argument, .plain = true};
  const char *wrong = kz_scalar_integer(&node, &options->boundary);
  if (wrong || options->boundary < 1 || options->boundary > KZ_BOUNDARY_MOST_DIGITS)
    return kz_fail(KZ_REFUSED, "--boundary: \"%.40s\" %s; give a number of digits from 1 to %d", argument,
                   wrong ? wrong : "is out of range", KZ_BOUNDARY_MOST_DIGITS);
  return KZ_OK;
}

static kz_status set_log(kz_options *options, const char *argument) {
  options->log = argument;
  return argument[0] ? KZ_OK : kz_fail(KZ_REFUSED, "--log: the name is empty; give the name of a file");
}

static kz_status set_timings(kz_options *options, const char *argument) {
  (void)argument;
  options->timings = true;
  return KZ_OK;
}

const kz_option kz_option_rows[] = {
    {"output", 'o', "FILE", RUN, set_output,
     "name of the result; default: the base name of SCENE with .h5, in the current folder", NULL},
    {"set", 256, "KEY=VALUE", RUN | CHECK | WHERE | VIEW | SERVE, add_set,
     "change or add a key of the scene; VALUE is YAML; if a key is given twice, the last value counts", NULL},
    {"resume", 257, NULL, RUN, set_resume, "continue from FILE.checkpoint if it exists", NULL},
    {"force", 258, NULL, RUN, set_force, "overwrite FILE, discard FILE.checkpoint", NULL},
    {"time-limit", 259, "T", RUN, set_time_limit,
     "stop after T seconds (or 30m, 1.5h), save all finished work, exit with status 75", NULL},
    {"progress", 260, "WHEN", RUN, set_progress, "when to show progress: auto, always or never", "auto|always|never"},
    {"timings", 267, NULL, RUN, set_timings, "print at the end how long each stage took", NULL},
    {"log", 268, "FILE", RUN, set_log, "append progress, stages, warnings and the end to FILE, as JSON lines", NULL},
    {"json", 261, NULL, WHERE, set_json, "print JSON, one object a line", NULL},
    {"boundary", 269, "DIGITS", WHERE, set_boundary,
     "print the point between two starts at which their basins meet, correct to DIGITS decimal places", NULL},
    {"json-schema", 262, NULL, KEYS, set_json_schema, "print the keys as a JSON schema, for editors", NULL},
    {"port", 263, "N", VIEW, set_port, "port of the local server, 1024 to 65535; default: a free one", NULL},
    {"no-browser", 264, NULL, VIEW, set_no_browser, "print the address, and do not open a browser", NULL},
    {"origin", 270, "ORIGIN", VIEW, add_origin,
     "also answer pages of this origin (a proxy or a tunnel), such as https://hub.example.org", NULL},
    {"completion", 265, "SHELL", TOP, set_completion, "print the completion script for bash, zsh or fish", "bash|zsh|fish"},
    {"manual", 266, NULL, TOP, set_manual, "print the manual page; to read it, pipe it into man -l -", NULL},
    {"help", 'h', NULL, RUN | CHECK | WHERE | VIEW | SERVE | KEYS | TOP, NULL, "print this help and exit", NULL},
    {"version", 'V', NULL, TOP, NULL, "print the versions of the program and of its libraries, and exit", NULL},
};
enum { N_ROWS = sizeof kz_option_rows / sizeof kz_option_rows[0] };
const int kz_option_count = N_ROWS;

/* getopt's own description of the options of a command. */
static void describe(const kz_command *command, struct option *longs, char *shorts) {
  *shorts++ = '+';
  *shorts++ = ':';
  for (int i = 0; i < N_ROWS; i++) {
    if (!(kz_option_rows[i].commands & command->bit)) continue;
    *longs++ = (struct option){kz_option_rows[i].name, kz_option_rows[i].argument ? required_argument : no_argument, NULL,
                               kz_option_rows[i].letter};
    if (kz_option_rows[i].letter >= KZ_NO_LETTER) continue;
    *shorts++ = (char)kz_option_rows[i].letter;
    if (kz_option_rows[i].argument) *shorts++ = ':';
  }
  *longs = (struct option){NULL, 0, NULL, 0};
  *shorts = '\0';
}

static kz_status refuse_option(const kz_command *command, const char *typed, bool lacks_argument) {
  char names[256] = "", nearest[64];
  const size_t length = strcspn(typed, "=");
  const char *space = command->name[0] ? " " : "";
  if (lacks_argument)
    return kz_fail(KZ_REFUSED, "%s: needs a value; kapitza%s%s --help shows its form", typed, space, command->name);
  for (int i = 0; i < N_ROWS; i++)
    if (kz_option_rows[i].commands & command->bit)
      snprintf(names + strlen(names), sizeof names - strlen(names), "%s--%s", names[0] ? "|" : "", kz_option_rows[i].name);
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)length, typed);
  if (kz_key_suggest(name, names, nearest, sizeof nearest) && strcmp(nearest, name) != 0)
    return kz_fail(KZ_REFUSED, "%.80s: unknown option; did you mean %s?", typed, nearest);
  return kz_fail(KZ_REFUSED, "%.80s: %s; kapitza%s%s --help lists the options", typed,
                 typed[length] && strstr(names, name) ? "takes no value" : "unknown option", space, command->name);
}

/* Whether an argument is no option though it begins with '-': standard input, or a number below zero. */
static bool is_operand(const char *argument) {
  return argument[0] != '-' || argument[1] == '\0' || argument[1] == '.' || (argument[1] >= '0' && argument[1] <= '9');
}

static kz_status take_operand(const kz_command *command, char *argument, kz_options *options) {
  const char *last = options->n_sets > 0 ? options->sets[options->n_sets - 1] : "=";
  if (options->n_operands == command->most && !strchr(last, '='))
    return kz_fail(KZ_REFUSED, "--set %.80s %.80s: is two words; write --set %.80s=%.80s", last, argument, last, argument);
  if (options->n_operands == command->most)
    return kz_fail(KZ_REFUSED, "%.80s: one argument too many; kapitza %s%s", argument, command->name, command->operand);
  options->operands[options->n_operands++] = argument;
  return KZ_OK;
}

/* The next option's letter, the operands before it taken; -1 at the end. getopt stops at operands itself only where they do not
 * look like options. */
static kz_status next_option(const kz_command *command, int argc, char **argv, const char *shorts, const struct option *longs,
                             kz_options *options, int *letter) {
  bool all = false; /* behind "--" everything is an operand */
  *letter = -1;
  for (; optind < argc && (all || is_operand(argv[optind]) || strcmp(argv[optind], "--") == 0); optind++) {
    if (!all && strcmp(argv[optind], "--") == 0)
      all = true;
    else
      KZ_TRY(take_operand(command, argv[optind], options));
  }
  if (optind < argc) *letter = getopt_long(argc, argv, shorts, longs, NULL);
  return KZ_OK;
}

static kz_status read_options(const kz_command *command, int argc, char **argv, kz_options *options) {
  struct option longs[N_ROWS + 1];
  char shorts[2 * N_ROWS + 3];
  describe(command, longs, shorts);
  opterr = 0;
  optind = 1;
  for (int letter;;) {
    KZ_TRY(next_option(command, argc, argv, shorts, longs, options, &letter));
    if (letter == -1) return KZ_OK;
    if (letter == '?' || letter == ':') {
      const bool is_letter = letter == '?' && optopt > 0 && optopt < 256 && strncmp(argv[optind - 1], "--", 2) != 0;
      return refuse_option(command, is_letter ? (const char[]){'-', (char)optopt, '\0'} : argv[optind - 1], letter == ':');
    }
    int i = 0;
    while (kz_option_rows[i].letter != letter) i++;
    if (kz_option_rows[i].apply) {
      KZ_TRY(kz_option_rows[i].apply(options, optarg));
      continue;
    }
    options->answered = true;
    if (options->speaks && letter == 'h') kz_help_print(command);
    if (options->speaks && letter == 'V') kz_app_version(stdout);
    return KZ_OK;
  }
}

static kz_status check_operands(const kz_command *command, const kz_options *options) {
  if (options->n_operands == 0 && command->fewest > 0)
    return kz_fail(KZ_REFUSED, "%s: SCENE is missing; kapitza %s%s", command->name, command->name, command->operand);
  if (options->n_operands < command->fewest)
    return kz_fail(KZ_REFUSED, "%s: the start is missing; kapitza %s%s", command->name, command->name, command->operand);
  if (options->resume && options->force) return kz_fail(KZ_REFUSED, "--resume: contradicts --force; use one of them");
  return KZ_OK;
}

/* A command that takes no MPI, started by a launcher on many ranks: all must have been given it, or those that were given a run would wait
 * for ever for those that were not. */
static kz_status agree_alone(const kz_options *options) {
  kz_ranks *ranks = NULL;
  if (kz_launch_count() <= 1) return KZ_OK;
  kz_status status = kz_ranks_start(NULL, NULL, &ranks);
  if (status == KZ_OK) status = kz_options_agree(options, ranks);
  kz_ranks_end(ranks);
  return status;
}

static kz_status carry_out(const kz_command *command, int argc, char **argv, kz_options *options) {
  KZ_TRY(read_options(command, argc, argv, options));
  if (options->answered) return KZ_OK;
  KZ_TRY(check_operands(command, options));
  options->scene = options->operands[0];
  if (command->carry_out != kz_app_run) KZ_TRY(agree_alone(options));
  return command->carry_out(options);
}

/* The first word: a command, or an option of the program itself. */
static kz_status dispatch(int argc, char **argv, kz_options *options) {
  char names[128] = "", nearest[64];
  if (argc < 2) return kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  if (argv[1][0] == '-') {
    KZ_TRY(read_options(&kz_program, argc, argv, options));
    return options->answered ? KZ_OK : kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  }
  for (int i = 0; i < kz_command_count; i++) {
    if (strcmp(argv[1], kz_commands[i].name) == 0) return carry_out(&kz_commands[i], argc - 1, argv + 1, options);
    snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", names[0] ? "|" : "", kz_commands[i].name);
  }
  if (kz_key_suggest(argv[1], names, nearest, sizeof nearest))
    return kz_fail(KZ_REFUSED, "%.80s: unknown command; did you mean %s?", argv[1], nearest);
  return kz_fail(KZ_REFUSED, "%.80s: unknown command; it must be run, check, where, view, serve or keys", argv[1]);
}

/* The words of the command line, with a space between. */
static char *join(int argc, char **argv) {
  size_t bytes = 1;
  for (int i = 0; i < argc; i++) bytes += strlen(argv[i]) + 1;
  char *line = kz_malloc(bytes), *end = line;
  for (int i = 0; i < argc; i++) {
    if (i > 0) *end++ = ' ';
    end = stpcpy(end, argv[i]);
  }
  *end = '\0';
  return line;
}

/* Freed memory is kept for the next use: else half of the time of small tables goes into pages that come and go. */
static void keep_memory(void) {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 8 << 20);
  mallopt(M_TRIM_THRESHOLD, 32 << 20);
#endif
}

kz_status kz_app(int argc, char **argv) {
  keep_memory();
  const bool speaks = kz_launch_rank() <= 0;
  kz_options options = {.speaks = speaks, .progress = KZ_PROGRESS_AUTO};
  options.line = join(argc, argv);
  options.sets = kz_calloc((size_t)argc + 1, sizeof *options.sets);
  options.origins = kz_calloc((size_t)argc + 1, sizeof *options.origins);
  const kz_status status = dispatch(argc, argv, &options);
  free(options.line);
  free(options.sets);
  free(options.origins);
  if (!speaks && status != KZ_FAILED) kz_message_clear();
  return status;
}
