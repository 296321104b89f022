/* The manual page, kapitza(1), from the tables of the command line. */
#include <string.h>

#include "kapitza/version.h"
#include "options.h"

/* Text in which roff sees no command and no hyphen that a reader could not type. */
static void put(FILE *out, const char *text) {
  if (*text == '.' || *text == '\'') fputs("\\&", out);
  for (const char *c = text; *c; c++) {
    if (*c == '\\')
      fputs("\\e", out);
    else if (*c == '-')
      fputs("\\-", out);
    else
      fputc(*c, out);
  }
}

/* An item of a list: `name` in bold, then its argument or operand, and below it what it means. */
static void put_item(FILE *out, const char *name, const char *argument, const char *meaning) {
  fputs(".TP\n\\fB", out);
  put(out, name);
  fputs("\\fR", out);
  if (argument && argument[0]) {
    fputs("\\fI ", out);
    put(out, argument + (*argument == ' '));
    fputs("\\fR", out);
  }
  fputc('\n', out);
  put(out, meaning);
  fputs(".\n", out);
}

static void put_options(FILE *out, const kz_command_row *command) {
  for (const kz_option_row *row = kz_option_rows; row->name; row++) {
    char name[64], letter[8] = "";
    if (!(row->commands & command->bit)) continue;
    if (row->letter < 256) snprintf(letter, sizeof letter, "-%c, ", row->letter);
    snprintf(name, sizeof name, "%s--%s", letter, row->name);
    put_item(out, name, row->argument, row->help);
  }
}

static void put_commands(FILE *out) {
  fputs(".SH COMMANDS\n", out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    fputs(".SS ", out);
    put(out, command->name);
    put(out, command->operand);
    fputc('\n', out);
    put(out, command->help);
    fputs(".\n", out);
    put_options(out, command);
  }
  fputs(".SH OPTIONS\n", out);
  put_options(out, &kz_no_command);
}

static void put_exits(FILE *out) {
  fputs(".SH EXIT STATUS\n", out);
  for (const kz_exit_row *row = kz_exit_rows; row->meaning; row++) {
    char status[16];
    snprintf(status, sizeof status, "%d", row->status);
    put_item(out, status, NULL, row->meaning);
  }
}

static const struct {
  const char *name, *meaning;
} files[] = {
    {"SCENE", "YAML: the pendulum, and what to study; kapitza keys prints every key"},
    {"FILE", "the result, HDF5 that netCDF-4 tools read; it appears only when it is complete"},
    {"FILE.checkpoint", "finished work of a run that was stopped; --resume goes on from it"},
    {"FILE.truth", "labels by quad precision, for the next run on the same basin"},
};

void kz_manual_print(FILE *out) {
  fprintf(out, ".TH KAPITZA 1 \"\" \"kapitza %s\" \"User Commands\"\n.SH NAME\nkapitza \\- ", KZ_VERSION);
  put(out, kz_no_command.help);
  fputs("\n.SH SYNOPSIS\n", out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    fputs(command > kz_commands ? ".br\n\\fBkapitza " : "\\fBkapitza ", out);
    put(out, command->name);
    fputs("\\fR\\fI", out);
    put(out, command->operand);
    fputs("\\fR [OPTION]...\n", out);
  }
  put_commands(out);
  put_exits(out);
  fputs(".SH FILES\n", out);
  for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) put_item(out, files[i].name, NULL, files[i].meaning);
  fputs(".SH EXAMPLE\n.nf\nmpirun \\-n 2 kapitza run blackburn\\-fig12.yaml \\-\\-set basin.theta.count=200\n.fi\n", out);
  fputs(".SH SEE ALSO\n.BR mpirun (1),\n.BR ncdump (1)\n", out);
}
