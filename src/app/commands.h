/* The commands and options of the command line: parsing, help, the manual page and completions come from the same rows. */
#pragma once

#include "app.h"

/* Bits of the commands. */
enum { KZ_FIT = 128, KZ_NEEDS = 256, KZ_PLOT = 512 };

typedef struct {
  const char *name;    /* "" = the program itself */
  int bit;             /* in kz_option.commands */
  const char *operand; /* " SCENE", or "" */
  int fewest, most;    /* operands */
  kz_status (*carry_out)(const kz_options *options);
  const char *help;
} kz_command;

typedef struct kz_option {
  const char *name;
  int letter;           /* of the short form; 0: none */
  const char *argument; /* its name, or NULL */
  int commands;
  kz_status (*apply)(kz_options *options, const struct kz_option *row, const char *argument); /* NULL: --help and --version */
  size_t member;                                                                              /* of kz_options that it sets */
  const char *help;
  const char *words; /* what the argument can be, joined by '|'; NULL = anything */
} kz_option;

extern const kz_command kz_commands[], kz_program;
extern const int kz_command_count;
extern const kz_option kz_option_rows[]; /* ended by a row without name */
/* The option of a command that comes after `row` (NULL: the first); NULL if there is none. */
static inline const kz_option *kz_option_next(const kz_command *command, const kz_option *row) {
  for (row = row ? row + 1 : kz_option_rows; row->name; row++)
    if (row->commands & command->bit) return row;
  return NULL;
}

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
