/* The whole program but its entry: which command is wanted, and that it is carried out. */
#include <malloc.h>

#include "commands.h"

/* Makes one word of a number and a unit behind it, as in --length 20 cm. Returns the number of words. */
static int join_units(int argc, char **argv, kz_options *options) {
  int n = 0;
  for (int i = 0; i < argc; i++) {
    kz_written_unit unit;
    double number;
    if (n == 0 || kz_text_real(argv[n - 1], &number) || kz_unit_find(argv[i], "", &unit)) {
      argv[n++] = argv[i];
      continue;
    }
    const size_t bytes = strlen(argv[n - 1]) + strlen(argv[i]) + 2;
    char *joined = options->joined[options->n_joined++] = kz_malloc(bytes);
    snprintf(joined, bytes, "%s %s", argv[n - 1], argv[i]);
    argv[n - 1] = joined;
  }
  return n;
}

/* A command or an answer that takes no MPI, started by a launcher on many ranks: all must have been given it, or those
 * that were given a run would wait for ever for those that were not. */
static kz_status agree_alone(kz_options *options) {
  kz_ranks *ranks = NULL;
  options->compared = true;
  if (kz_launch_count() <= 1) return KZ_OK;
  kz_status status = kz_ranks_start(NULL, NULL, &ranks);
  if (status == KZ_OK) status = kz_ranks_compare(ranks, options->words, "command line");
  kz_ranks_end(ranks);
  return status;
}

static kz_status carry_out(const kz_command *command, int argc, char **argv, kz_options *options) {
  const bool asks = argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0);
  if (command->passes_words && !asks) {
    options->n_words = argc - 1;
    options->plot_words = argv + 1;
    KZ_TRY(agree_alone(options));
    return command->carry_out(options);
  }
  if (command->joins_units) argc = join_units(argc, argv, options);
  if (command->own_bytes > 0) options->own = kz_calloc(1, command->own_bytes);
  KZ_TRY(kz_options_read(command, argc, argv, options));
  if (options->answered) return agree_alone(options);
  KZ_TRY(kz_operands_check(command, options));
  options->scene = options->operands[0];
  if (command->carry_out != kz_app_run) KZ_TRY(agree_alone(options));
  options->compared = true;
  return command->carry_out(options);
}

/* Refuses a command line before ranks are compared: rank 0 may have another one and say nothing of this. */
static kz_status refuse_together(kz_options *options) {
  char message[KZ_MESSAGE_BYTES];
  snprintf(message, sizeof message, "%s", kz_message());
  kz_message_clear();
  KZ_TRY(agree_alone(options));
  return kz_fail(KZ_REFUSED, "%s", message);
}

/* Finds the command of the first word; *command = NULL where an option of the program has been answered. */
static kz_status find_command(int argc, char **argv, kz_options *options, const kz_command **command) {
  char names[128] = "", nearest[64];
  if (argc < 2) return kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  if (argv[1][0] == '-') {
    KZ_TRY(kz_options_read(&kz_program, argc, argv, options));
    return options->answered ? agree_alone(options)
                             : kz_fail(KZ_REFUSED, "no command; kapitza run SCENE, or kapitza --help");
  }
  for (int i = 0; kz_commands[i]; i++) {
    if (strcmp(argv[1], kz_commands[i]->name) == 0) *command = kz_commands[i];
    kz_words_add(names, sizeof names, kz_commands[i]->name);
  }
  if (*command) return KZ_OK;
#define MISSING(name, power) \
  if (strcmp(argv[1], #name) == 0) return kz_fail(KZ_REFUSED, "%s: " KZ_MISSING_POWER, #name, #power);
  KZ_MISSING_COMMANDS(MISSING)
  if (strcmp(argv[1], "serve") == 0)
    return kz_fail(KZ_REFUSED,
                   "serve: is gone; libkapitza.so answers in the process of who asks (docs/howto/other-languages.md)");
  if (kz_key_suggest(argv[1], names, nearest, sizeof nearest))
    return kz_fail(KZ_REFUSED, "%.80s: unknown command; did you mean %s?", argv[1], nearest);
  return kz_fail(KZ_REFUSED, "%.80s: unknown command; kapitza --help lists the commands", argv[1]);
}

/* The words of the command line, with a space between. */
static char *program_join(int argc, char **argv) {
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
  const bool prints = kz_launch_rank() <= 0;
  kz_options options = {.prints = prints, .progress = KZ_PROGRESS_AUTO};
  options.line = program_join(argc, argv);
  options.words = options.line + strcspn(options.line, " ");
  options.sets = kz_calloc((size_t)argc + 1, sizeof *options.sets);
  options.joined = kz_calloc((size_t)argc + 1, sizeof *options.joined);
  char *asked[] = {argv[0], argc > 2 ? argv[2] : "--help", "--help", NULL}; /* kapitza help [COMMAND] */
  if (argc > 1 && strcmp(argv[1], "help") == 0) {
    argc = argc > 2 ? 3 : 2;
    argv = asked;
  }
  const kz_command *command = NULL;
  kz_status status = find_command(argc, argv, &options, &command);
  if (command) status = carry_out(command, argc - 1, argv + 1, &options);
  if (status == KZ_REFUSED && !options.compared) status = refuse_together(&options);
  while (options.n_joined > 0) free(options.joined[--options.n_joined]);
  free(options.joined);
  free(options.line);
  free(options.sets);
  free(options.own);
  if (!prints && status != KZ_FAILED) kz_message_clear();
  return status;
}
