/* Commands and options of the command line: parsing, help, manual page and completions share these rows. */
#pragma once

#include "app.h"

typedef struct kz_option {
  const char *name;
  int letter;                                                                           /* short form; 0: none */
  const char *argument;                                                                 /* its name, or NULL */
  kz_status (*apply)(void *members, const struct kz_option *row, const char *argument); /* NULL: --help and --version */
  size_t member; /* Offset of the field that it sets, in kz_options or in the command's own, bytes */
  const char *help;
  const char *words; /* Words allowed as argument, joined by '|'; NULL = anything */
} kz_option;

typedef struct {
  const char *name;    /* "" = the program itself */
  const char *operand; /* " SCENE", or "" */
  int fewest, most;    /* operands */
  kz_status (*carry_out)(const kz_options *options);
  const char *help;
  const char *options;  /* names of its options, joined by '|', in the order of its help */
  const kz_option *own; /* Options that no other command has, ended by a row without name; NULL = none */
  size_t own_bytes;     /* Bytes of the fields that these set: kz_options.own, zeros before */
  bool passes_words;    /* the package reads the words behind it */
  bool joins_units;     /* a number and a unit behind it are one word */
} kz_command;

extern const kz_command kz_program;
extern const kz_command kz_program;
/* Commands, then those of this build's powers (cmake/Powers.cmake), each kz_NAME_command; NULL ends the list. */
extern const kz_command *const kz_commands[];
extern const kz_option kz_option_rows[]; /* options of the core, ended by a row without name */
static inline const kz_option *kz_option_find(const kz_option *list, const char *name, int length) {
  for (; list && list->name; list++)
    if (strncmp(list->name, name, (size_t)length) == 0 && list->name[length] == '\0') return list;
  return NULL;
}
/* The option that stands first in *options, which moves behind it; NULL at the end of the list. */
static inline const kz_option *kz_option_next(const kz_command *command, const char **options) {
  int length;
  const char *name = kz_words_next(options, &length);
  const kz_option *own = name ? kz_option_find(command->own, name, length) : NULL;
  return own || !name ? own : kz_option_find(kz_option_rows, name, length);
}

/* For rows: sets the member, a bool or a text, of kz_options or of the command's own. */
kz_status kz_option_flag(void *members, const kz_option *row, const char *argument);
kz_status kz_option_text(void *members, const kz_option *row, const char *argument);

/* Reads the words behind the name of a command. argv is permuted. KZ_REFUSED names the word. */
kz_status kz_options_read(const kz_command *command, int argc, char **argv, kz_options *options);
/* KZ_REFUSED if operands are missing, or options contradict each other. */
kz_status kz_operands_check(const kz_command *command, const kz_options *options);

void kz_help_print(const kz_command *command);
/* The manual page, as roff. */
void kz_manual_print(void);
/* Prints the completion script of a shell: bash, zsh or fish. */
void kz_completion_print(const char *shell);
/* Prints what may stand in place of the last word of a command line, for these scripts. */
void kz_completion_answer(const char *line);
