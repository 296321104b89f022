/* The command line, from two tables: commands and options. Help and errors come from the same rows. */
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"

enum { RUN = 1, CHECK = 2, KEYS = 4, TOP = 8 };

const kz_command_row kz_commands[] = {
    {"run", RUN, " SCENE", kz_app_run, "model every study that SCENE contains"},
    {"check", CHECK, " SCENE", kz_app_check, "validate SCENE and print what would be modelled; runs nothing"},
    {"keys", KEYS, "", kz_app_keys, "print the reference of all keys of a scene (docs/scene.md)"},
    {NULL, 0, NULL, NULL, NULL},
};
enum { N_COMMANDS = sizeof kz_commands / sizeof kz_commands[0] - 1 };
const kz_command_row kz_no_command = {"", TOP, " COMMAND", NULL, "basins of attraction of the pendulum with a shaken pivot"};

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

/* Options that print and leave. */
static kz_status print_version(kz_options *options, const char *argument) {
  (void)argument;
  options->helped = true;
  if (options->speaks) kz_app_version(stdout);
  return KZ_OK;
}

static kz_status print_manual(kz_options *options, const char *argument) {
  (void)argument;
  options->helped = true;
  if (options->speaks) kz_manual_print(stdout);
  return KZ_OK;
}

static kz_status print_completion(kz_options *options, const char *argument) {
  options->helped = true;
  return kz_completion_print(argument, options->speaks ? stdout : NULL);
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

const kz_option_row kz_option_rows[] = {
    {"output", 'o', "FILE", RUN, set_output, "the result; default: base name of SCENE + .h5 in the current folder"},
    {"set", 256, "KEY=VALUE", RUN | CHECK, add_set, "override or create a key; VALUE is YAML flow text; the last one wins"},
    {"resume", 257, NULL, RUN, set_resume, "go on from FILE.checkpoint where there is one"},
    {"force", 258, NULL, RUN, set_force, "overwrite FILE, discard FILE.checkpoint"},
    {"time-limit", 259, "T", RUN, set_time_limit, "stop after T seconds (30m, 1.5h), all finished work saved, exit 75"},
    {"progress", 260, "auto|always|never", RUN, set_progress, "whether a bar is drawn"},
    {"timings", 261, NULL, RUN, set_timings, "print at the end where the time went, stage by stage"},
    {"log", 262, "FILE", RUN, set_log, "append progress, stages, warnings and the end to FILE, as JSON lines"},
    {"help", 'h', NULL, RUN | CHECK | KEYS | TOP, NULL, "print this and leave"},
    {"version", 'V', NULL, TOP, print_version, "print versions of the program and of what it was built with, and leave"},
    {"manual", 270, NULL, TOP, print_manual, "print the manual page, for man -l -, and leave"},
    {"completion", 271, "bash|zsh|fish", TOP, print_completion, "print the completion script of a shell, and leave"},
    {NULL, 0, NULL, 0, NULL, NULL},
};
enum { N_ROWS = sizeof kz_option_rows / sizeof kz_option_rows[0] - 1 };

const kz_exit_row kz_exit_rows[] = {
    {KZ_OK, "done"},
    {KZ_REFUSED, "refused beforehand (nothing written)"},
    {KZ_FAILED, "failed while running"},
    {KZ_STOPPED, "stopped early on request, all finished work saved"},
    {0, NULL},
};

static void print_help(const kz_command_row *command) {
  printf("Usage: kapitza%s%s%s [OPTION]...\n%s\n\n", command->name[0] ? " " : "", command->name, command->operand,
         command->help);
  for (int i = 0; command == &kz_no_command && i < N_COMMANDS; i++)
    printf("  %-30s %s\n", kz_commands[i].name, kz_commands[i].help);
  if (command == &kz_no_command) putchar('\n');
  for (int i = 0; i < N_ROWS; i++) {
    if (!(kz_option_rows[i].commands & command->bit)) continue;
    char name[64];
    snprintf(name, sizeof name, "--%s%s%s", kz_option_rows[i].name, kz_option_rows[i].argument ? " " : "",
             kz_option_rows[i].argument ? kz_option_rows[i].argument : "");
    if (kz_option_rows[i].letter < 256)
      printf("  -%c, %-26s %s\n", kz_option_rows[i].letter, name, kz_option_rows[i].help);
    else
      printf("      %-26s %s\n", name, kz_option_rows[i].help);
  }
  printf("\nExit status:");
  for (const kz_exit_row *row = kz_exit_rows; row->meaning; row++)
    printf("%s %d %s", row > kz_exit_rows ? "," : "", row->status, row->meaning);
  puts(".");
}

/* getopt's own description of the options of a command. */
static void describe(const kz_command_row *command, struct option *longs, char *shorts) {
  *shorts++ = ':';
  for (int i = 0; i < N_ROWS; i++) {
    if (!(kz_option_rows[i].commands & command->bit)) continue;
    *longs++ = (struct option){kz_option_rows[i].name, kz_option_rows[i].argument ? required_argument : no_argument, NULL,
                               kz_option_rows[i].letter};
    if (kz_option_rows[i].letter >= 256) continue;
    *shorts++ = (char)kz_option_rows[i].letter;
    if (kz_option_rows[i].argument) *shorts++ = ':';
  }
  *longs = (struct option){NULL, 0, NULL, 0};
  *shorts = '\0';
}

static kz_status refuse_option(const kz_command_row *command, const char *typed, bool lacks_argument) {
  char names[256] = "", nearest[64];
  const size_t length = strcspn(typed, "=");
  const char *space = command->name[0] ? " " : "";
  if (lacks_argument) return kz_fail(KZ_REFUSED, "%s: needs a value; kapitza%s%s --help", typed, space, command->name);
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

static kz_status read_options(const kz_command_row *command, int argc, char **argv, kz_options *options) {
  struct option longs[N_ROWS + 1];
  char shorts[2 * N_ROWS + 2];
  describe(command, longs, shorts);
  unsetenv("POSIXLY_CORRECT"); /* options may follow the scene, whatever that says */
  opterr = 0;
  optind = 0;
  for (int letter; (letter = getopt_long(argc, argv, shorts, longs, NULL)) != -1;) {
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
    options->helped = true;
    if (options->speaks) print_help(command);
    return KZ_OK;
  }
  return KZ_OK;
}

static kz_status read_operands(const kz_command_row *command, int argc, char **argv, kz_options *options) {
  const int wanted = command->operand[0] ? 1 : 0;
  if (argc - optind > wanted)
    return kz_fail(KZ_REFUSED, "%.80s: one argument too many; kapitza %s%s", argv[optind + wanted], command->name,
                   command->operand);
  if (argc - optind < wanted)
    return kz_fail(KZ_REFUSED, "%s: names no scene; kapitza %s%s", command->name, command->name, command->operand);
  if (wanted) options->scene = argv[optind];
  if (options->resume && options->force) return kz_fail(KZ_REFUSED, "--resume: contradicts --force; use one of them");
  return KZ_OK;
}

static kz_status carry_out(const kz_command_row *command, int argc, char **argv, kz_options *options) {
  KZ_TRY(read_options(command, argc, argv, options));
  if (options->helped) return KZ_OK;
  KZ_TRY(read_operands(command, argc, argv, options));
  return command->carry_out(options);
}

/* The first word: a command, or an option of the program itself. */
static kz_status dispatch(int argc, char **argv, kz_options *options) {
  char names[128] = "", nearest[64];
  if (argc < 2) return kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  if (argv[1][0] == '-') {
    KZ_TRY(read_options(&kz_no_command, argc, argv, options));
    return options->helped ? KZ_OK : kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  }
  for (int i = 0; i < N_COMMANDS; i++) {
    if (strcmp(argv[1], kz_commands[i].name) == 0) return carry_out(&kz_commands[i], argc - 1, argv + 1, options);
    snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", names[0] ? "|" : "", kz_commands[i].name);
  }
  if (kz_key_suggest(argv[1], names, nearest, sizeof nearest))
    return kz_fail(KZ_REFUSED, "%.80s: unknown command; did you mean %s?", argv[1], nearest);
  return kz_fail(KZ_REFUSED, "%.80s: unknown command; it must be run, check or keys", argv[1]);
}

/* The words of the command line, with a space between. */
static char *join(int argc, char **argv) {
  size_t bytes = 1;
  for (int i = 0; i < argc; i++) bytes += strlen(argv[i]) + 1;
  char *line = malloc(bytes), *end = line;
  if (!line) return NULL;
  for (int i = 0; i < argc; i++) {
    if (i > 0) *end++ = ' ';
    end = stpcpy(end, argv[i]);
  }
  *end = '\0';
  return line;
}

kz_status kz_app(int argc, char **argv) {
  const bool speaks = kz_launch_rank() <= 0;
  kz_options options = {.speaks = speaks, .progress = KZ_PROGRESS_AUTO};
  options.line = join(argc, argv);
  options.sets = calloc((size_t)argc + 1, sizeof *options.sets);
  kz_status status = options.line && options.sets ? dispatch(argc, argv, &options) : kz_fail(KZ_FAILED, "out of memory");
  free(options.line);
  free(options.sets);
  if (!speaks && status != KZ_FAILED) kz_message_clear();
  return status;
}
