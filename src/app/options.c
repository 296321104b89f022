/* The command line, from two tables: commands and options. Help and errors come from the same rows. */
#include <getopt.h>

#include "commands.h"

#define HELP "|help"
static const kz_command commands[] = {
    {"run", " SCENE", 1, 1, kz_app_run, "model every study that SCENE contains",
     "output|set|resume|force|time-limit|progress|timings|log" HELP},
    {"check", " SCENE", 1, 1, kz_app_check,
     "check SCENE; print what a run would model, and the memory and disk that it would take", "set|json|all" HELP},
    {"keys", "", 0, 0, kz_app_keys, "print the reference of all keys of a scene (docs/reference/scene.md)",
     "json-schema|layout" HELP},
};
_Static_assert(sizeof commands / sizeof *commands == 3, "the commands of the core below");
#define DECLARE(name) extern const kz_command kz_##name##_command;
#define REFER(name) &kz_##name##_command,
KZ_POWER_COMMANDS(DECLARE)
/* clang-format off */
const kz_command *const kz_commands[] = {commands, commands + 1, commands + 2, KZ_POWER_COMMANDS(REFER) NULL};
/* clang-format on */
const kz_command kz_program = {"",
                               " COMMAND",
                               0,
                               0,
                               NULL,
                               "basins of attraction of the pendulum with a shaken pivot",
                               "completion|complete|manual" HELP "|version"};

/* The member that a row sets. */
#define MEMBER(type) (*(type *)((char *)members + row->member))

kz_status kz_option_flag(void *members, const kz_option *row, const char *argument) {
  (void)argument;
  MEMBER(bool) = true;
  return KZ_OK;
}

kz_status kz_option_text(void *members, const kz_option *row, const char *argument) {
  MEMBER(const char *) = argument;
  return KZ_OK;
}

static kz_status set_file(void *members, const kz_option *row, const char *argument) {
  MEMBER(const char *) = argument;
  return argument[0] ? KZ_OK : kz_fail(KZ_REFUSED, "--%s: the name is empty; give the name of a file", row->name);
}

static kz_status add_set(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  (void)row;
  options->sets[options->n_sets++] = (char *)argument;
  return KZ_OK;
}

/* The place of the argument among the words of the row. */
static kz_status find_word(const kz_option *row, const char *argument, int64_t *index) {
  char most[64], list[64];
  const char *last = strrchr(row->words, '|');
  *index = kz_word_find(row->words, argument);
  if (*index >= 0) return KZ_OK;
  snprintf(most, sizeof most, "%.*s", (int)(last - row->words), row->words);
  kz_key_list(most, list, sizeof list);
  return kz_fail(KZ_REFUSED, "--%s: \"%s\" is unknown; it must be %s or %s", row->name, argument, list, last + 1);
}

static kz_status set_progress(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  int64_t index;
  KZ_TRY(find_word(row, argument, &index));
  options->progress = (kz_progress)index;
  return KZ_OK;
}

static kz_status set_completion(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  int64_t index;
  KZ_TRY(find_word(row, argument, &index));
  if (options->prints) kz_completion_print(argument);
  options->answered = true;
  return KZ_OK;
}

static kz_status set_complete(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  (void)row;
  if (options->prints) kz_completion_answer(argument);
  options->answered = true;
  return KZ_OK;
}

static kz_status set_manual(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  (void)row, (void)argument;
  if (options->prints) kz_manual_print();
  options->answered = true;
  return KZ_OK;
}

/* A number of seconds, or with s, m, h of seconds, minutes, hours. */
static kz_status set_time_limit(void *members, const kz_option *row, const char *argument) {
  kz_options *options = members;
  static const char units[] = "smh";
  static const double seconds[] = {1.0, 60.0, 3600.0};
  char number[64];
  const size_t length = strlen(argument);
  const char *unit = length > 0 ? strchr(units, argument[length - 1]) : NULL;
  snprintf(number, sizeof number, "%.*s", (int)(unit ? length - 1 : length), argument);
  const char *wrong = kz_text_real(number, &options->time_limit);
  if (wrong || options->time_limit <= 0.0)
    return kz_fail(KZ_REFUSED, "--%s: \"%s\" %s; give a time above 0, such as 90, 30m or 1.5h", row->name, argument,
                   wrong ? wrong : "is not above 0");
  options->time_limit *= unit ? seconds[unit - units] : 1.0;
  return KZ_OK;
}

#define OF(member) offsetof(kz_options, member)
const kz_option kz_option_rows[] = {
    {"output", 'o', "FILE", set_file, OF(output),
     "name of the result; default: the base name of SCENE with .h5, in the current folder", NULL},
    {"set", 0, "KEY=VALUE", add_set, 0,
     "change or add a key of the scene; VALUE is YAML; if a key is given twice, the last value counts", NULL},
    {"resume", 0, NULL, kz_option_flag, OF(resume), "continue from FILE.checkpoint if it exists", NULL},
    {"force", 0, NULL, kz_option_flag, OF(force), "overwrite FILE, discard FILE.checkpoint", NULL},
    {"time-limit", 0, "T", set_time_limit, 0,
     "stop after T seconds (or 30m, 1.5h), save all finished work, exit with status 75", NULL},
    {"progress", 0, "WHEN", set_progress, 0, "when to show progress: auto, always or never", "auto|always|never"},
    {"timings", 0, NULL, kz_option_flag, OF(timings), "print at the end how long each stage took", NULL},
    {"log", 0, "FILE", set_file, OF(log), "append progress, stages, warnings and the end to FILE, as JSON lines", NULL},
    {"json", 0, NULL, kz_option_flag, OF(json), "print JSON, one object a line", NULL},
    {"all", 0, NULL, kz_option_flag, OF(all), "print the scene with every default, too", NULL},
    {"json-schema", 0, NULL, kz_option_flag, OF(json_schema), "print the keys as a JSON schema, for editors", NULL},
    {"layout", 0, NULL, kz_option_flag, OF(layout),
     "print the variables of the result file, with their group, dimensions, type and units, as JSON lines", NULL},
    {"completion", 0, "SHELL", set_completion, 0, "print the completion script for bash, zsh or fish", "bash|zsh|fish"},
    {"complete", 0, "LINE", set_complete, 0,
     "print the words that may end LINE, a command line, with their descriptions: what these scripts ask for", NULL},
    {"manual", 0, NULL, set_manual, 0, "print the manual page; to read it, pipe it into man -l -", NULL},
    {"help", 'h', NULL, NULL, 0, "print this help and exit", NULL},
    {"version", 'V', NULL, NULL, 0, "print the versions of the program and of its libraries, and exit", NULL},
    {.name = NULL},
};
enum { MOST_OPTIONS = 16 /* Options of a command at most */, NO_LETTER = 256 };

/* Describes a command's options for getopt: letter = the row's, or NO_LETTER + its index in row [MOST_OPTIONS]. */
static void options_describe(const kz_command *command, const kz_option **row, struct option *longs, char *shorts) {
  shorts = stpcpy(shorts, "+:");
  const char *names = command->options;
  for (int i = 0; (row[i] = kz_option_next(command, &names)); i++) {
    const kz_option *r = row[i];
    *longs++ = (struct option){r->name, r->argument ? required_argument : no_argument, NULL,
                               r->letter ? r->letter : NO_LETTER + i};
    if (!r->letter) continue;
    *shorts++ = (char)r->letter;
    if (r->argument) *shorts++ = ':';
  }
  *longs = (struct option){NULL, 0, NULL, 0};
  *shorts = '\0';
}

static const kz_option *row_of(const kz_option *const *row, int letter) {
  if (letter >= NO_LETTER) return row[letter - NO_LETTER];
  while ((*row)->letter != letter) row++;
  return *row;
}

/* Whether an option is how other programs are told the number of their ranks. */
static bool is_number_of_ranks(const char *name) {
  static const char *const names[] = {"-n", "-np", "-j", "--np", "--ranks", "--jobs"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(name, names[i]) == 0) return true;
  return false;
}

static kz_status refuse_option(const kz_command *command, const char *typed, bool lacks_argument) {
  char names[256] = "", nearest[64];
  const size_t length = strcspn(typed, "=");
  const char *space = command->name[0] ? " " : "";
  if (lacks_argument)
    return kz_fail(KZ_REFUSED, "%s: needs a value; kapitza%s%s --help shows its form", typed, space, command->name);
  char name[64];
  const char *rest = command->options;
  for (const kz_option *row; (row = kz_option_next(command, &rest));) {
    snprintf(name, sizeof name, "--%s", row->name);
    kz_words_add(names, sizeof names, name);
  }
  snprintf(name, sizeof name, "%.*s", (int)length, typed);
  if (command->carry_out == kz_app_run && is_number_of_ranks(name))
    return kz_fail(KZ_REFUSED, "%.80s: unknown option; several ranks: mpirun -n 4 kapitza run SCENE", typed);
  if (kz_key_suggest(name, names, nearest, sizeof nearest) && strcmp(nearest, name) != 0)
    return kz_fail(KZ_REFUSED, "%.80s: unknown option; did you mean %s?", typed, nearest);
  return kz_fail(KZ_REFUSED, "%.80s: %s; kapitza%s%s --help lists the options", typed,
                 typed[length] && strstr(names, name) ? "takes no value" : "unknown option", space, command->name);
}

/* Whether an argument is no option though it begins with '-': standard input, or a number below zero. */
static bool is_operand(const char *argument) {
  return argument[0] != '-' || argument[1] == '\0' || argument[1] == '.' || (argument[1] >= '0' && argument[1] <= '9');
}

/* Refuses an operand of a --set written with blanks: "KEY VALUE", "KEY= VALUE", "KEY =VALUE", "KEY = VALUE". */
static kz_status check_set(const kz_command *command, char *const *argument, const kz_options *options) {
  if (options->n_sets == 0) return KZ_OK;
  const char *last = options->sets[options->n_sets - 1], *equals = strchr(last, '=');
  const bool is_apart = !equals && argument[0][0] == '=';
  if (!is_apart && (options->n_operands < command->most || (equals && equals[1]))) return KZ_OK;
  const bool is_alone = is_apart && !argument[0][1];
  const char *value = is_alone ? argument[1] ? argument[1] : "VALUE" : argument[0] + is_apart;
  return kz_fail(KZ_REFUSED, "--set %.80s %.80s%s%.80s: is %s words; write --set %.*s=%.80s", last, argument[0],
                 is_alone ? " " : "", is_alone ? value : "", is_alone ? "three" : "two", (int)strcspn(last, "="), last,
                 value);
}

/* Takes the operand at `argument`, which the others of the command line follow. */
static kz_status take_operand(const kz_command *command, char **argument, kz_options *options) {
  KZ_TRY(check_set(command, argument, options));
  if (options->n_operands == command->most)
    return kz_fail(KZ_REFUSED, "%.80s: one argument too many; kapitza %s%s", *argument, command->name,
                   command->operand);
  options->operands[options->n_operands++] = *argument;
  return KZ_OK;
}

/* The next option's letter, the operands before it taken; -1 at the end. getopt stops at operands itself only where
 * they do not look like options. */
static kz_status next_option(const kz_command *command, int argc, char **argv, const char *shorts,
                             const struct option *longs, kz_options *options, int *letter) {
  bool all = false; /* behind "--" everything is an operand */
  *letter = -1;
  for (; optind < argc && (all || is_operand(argv[optind]) || strcmp(argv[optind], "--") == 0); optind++) {
    if (!all && strcmp(argv[optind], "--") == 0)
      all = true;
    else
      KZ_TRY(take_operand(command, argv + optind, options));
  }
  if (optind < argc) *letter = getopt_long(argc, argv, shorts, longs, NULL);
  return KZ_OK;
}

static bool is_own(const kz_command *command, const kz_option *row) {
  for (const kz_option *own = command->own; own && own->name; own++)
    if (own == row) return true;
  return false;
}

kz_status kz_options_read(const kz_command *command, int argc, char **argv, kz_options *options) {
  const kz_option *list[MOST_OPTIONS + 1];
  struct option longs[MOST_OPTIONS + 1];
  char shorts[2 * MOST_OPTIONS + 3];
  options_describe(command, list, longs, shorts);
  opterr = 0;
  optind = 1;
  for (int letter;;) {
    KZ_TRY(next_option(command, argc, argv, shorts, longs, options, &letter));
    if (letter == -1) return KZ_OK;
    if (letter == '?' || letter == ':') {
      const bool is_letter = letter == '?' && optopt > 0 && optopt < 256 && strncmp(argv[optind - 1], "--", 2) != 0;
      return refuse_option(command, is_letter ? (const char[]){'-', (char)optopt, '\0'} : argv[optind - 1],
                           letter == ':');
    }
    const kz_option *row = row_of(list, letter);
    if (row->apply) {
      KZ_TRY(row->apply(is_own(command, row) ? options->own : options, row, optarg));
      continue;
    }
    options->answered = true;
    if (options->prints && letter == 'h') kz_help_print(command);
    if (options->prints && letter == 'V') kz_app_version(stdout);
    return KZ_OK;
  }
}

kz_status kz_operands_check(const kz_command *command, const kz_options *options) {
  const char *first = command->operand + 1; /* SCENE, SCENE|FILE, ... */
  const int length = command->fewest > 0 ? (int)strcspn(first, " |") : 0;
  if (options->n_operands == 0 && command->fewest > 0)
    return kz_fail(KZ_REFUSED, "%s: %.*s is missing; kapitza %s%s", command->name, length, first, command->name,
                   command->operand);
  if (options->n_operands > 0 && !options->operands[0][0])
    return kz_fail(KZ_REFUSED, "%s: the name of %.*s is empty; kapitza %s%s", command->name, length, first,
                   command->name, command->operand);
  if (options->n_operands < command->fewest)
    return kz_fail(KZ_REFUSED, "%s: the start is missing; kapitza %s%s", command->name, command->name,
                   command->operand);
  if (options->resume && options->force) return kz_fail(KZ_REFUSED, "--resume: contradicts --force; use one of them");
  return KZ_OK;
}
