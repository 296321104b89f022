/* The commands and options of the command line: parsing, help, the manual page and completions come from the same rows. */
#ifndef KAPITZA_APP_COMMANDS_H
#define KAPITZA_APP_COMMANDS_H

#include "app.h"

enum { KZ_NO_LETTER = 256 }; /* letters from here on are numbers of options without a short form */

typedef struct {
  const char *name;    /* "" = the program itself */
  int bit;             /* in kz_option.commands */
  const char *operand; /* " SCENE", or "" */
  int fewest, most;    /* operands */
  kz_status (*carry_out)(const kz_options *options);
  const char *help;
} kz_command;

typedef struct {
  const char *name;
  int letter;           /* of the short form; from KZ_NO_LETTER on: none */
  const char *argument; /* its name, or NULL */
  int commands;
  kz_status (*apply)(kz_options *options, const char *argument); /* NULL: --help and --version */
  const char *help;
  const char *words; /* what the argument can be, joined by '|'; NULL = anything */
} kz_option;

extern const kz_command kz_commands[], kz_program;
extern const kz_option kz_option_rows[];
extern const int kz_command_count, kz_option_count;

void kz_help_print(const kz_command *command);
/* The manual page, as roff. */
void kz_manual_print(void);
/* Prints the completion script of a shell: bash, zsh or fish. */
void kz_completion_print(const char *shell);

#endif
