/* The tables of the command line: help, errors, manual page and shell completions come from the same rows. */
#ifndef KAPITZA_APP_OPTIONS_H
#define KAPITZA_APP_OPTIONS_H

#include "app.h"

typedef struct {
  const char *name;
  int bit;             /* of the commands that an option belongs to */
  const char *operand; /* " SCENE", or "" */
  kz_status (*carry_out)(const kz_options *options);
  const char *help;
} kz_command_row;

typedef struct {
  const char *name;
  int letter;           /* of the short form; from 256 on: none */
  const char *argument; /* its name, or its words: "auto|always|never"; NULL: none */
  int commands;         /* bits of the commands that take it */
  kz_status (*apply)(kz_options *options, const char *argument);
  const char *help;
} kz_option_row;

typedef struct {
  int status;
  const char *meaning;
} kz_exit_row;

/* Each table ends with a row whose name, or meaning, is NULL. */
extern const kz_command_row kz_commands[];
extern const kz_command_row kz_no_command; /* kapitza without a command */
extern const kz_option_row kz_option_rows[];
extern const kz_exit_row kz_exit_rows[];

/* Prints the manual page, kapitza(1), in roff (source: man(7)). */
void kz_manual_print(FILE *out);
/* Prints the completion script of a shell: "bash", "zsh" or "fish"; `out` NULL: prints nothing. KZ_REFUSED for another shell. */
kz_status kz_completion_print(const char *shell, FILE *out);

#endif
