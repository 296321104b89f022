/* Help and the manual page, from the tables of commands and options. */
#include <ctype.h>

#include "commands.h"
#include "kapitza/version.h"

static const struct {
  int status;
  const char *meaning;
} statuses[] = {{KZ_OK, "done"},
                {KZ_FAILED, "failed while running"},
                {KZ_REFUSED, "refused beforehand (nothing written)"},
                {KZ_STOPPED, "stopped early on request, all finished work saved"}};
enum { N_STATUSES = sizeof statuses / sizeof statuses[0] };

void kz_help_print(const kz_command *command) {
  const char *space = command->name[0] ? " " : "";
  printf("Usage: kapitza%s%s%s [OPTION]...\n%s\n\n", space, command->name, command->operand, command->help);
  for (int i = 0; command == &kz_program && kz_commands[i]; i++)
    printf("  %-24s %s\n", kz_commands[i]->name, kz_commands[i]->help);
  if (command == &kz_program) putchar('\n');
  const char *names = command->options;
  for (const kz_option *row; (row = kz_option_next(command, &names));) {
    char name[64];
    snprintf(name, sizeof name, "--%s%s%s", row->name, row->argument ? " " : "", row->argument ? row->argument : "");
    if (row->letter)
      printf("  -%c, %-20s %s\n", row->letter, name, row->help);
    else
      printf("      %-20s %s\n", name, row->help);
  }
  printf("\nExit status:");
  for (int i = 0; i < N_STATUSES; i++) printf("%s %d %s", i > 0 ? "," : "", statuses[i].status, statuses[i].meaning);
  puts(".");
}

/* Text as roff takes it: hyphens of options and backslashes stay what they are. */
static void print_roff(const char *text) {
  for (; *text; text++) {
    if (*text == '-' || *text == '\\') putchar('\\');
    putchar(*text == '\\' ? 'e' : *text);
  }
}

static void print_options(const kz_command *command) {
  const char *names = command->options;
  for (const kz_option *row; (row = kz_option_next(command, &names));) {
    fputs(".TP\n", stdout);
    if (row->letter) printf("\\fB\\-%c\\fR, ", row->letter);
    fputs("\\fB\\-\\-", stdout);
    print_roff(row->name);
    fputs("\\fR", stdout);
    if (row->argument) printf(" \\fI%s\\fR", row->argument);
    putchar('\n');
    print_roff(row->help);
    putchar('\n');
  }
}

static void print_command(const kz_command *command) {
  fputs(".SH KAPITZA ", stdout);
  for (const char *c = command->name; *c; c++) putchar(toupper((unsigned char)*c));
  printf("\n.B kapitza %s\n.I \"%s [OPTION]...\"\n.PP\n", command->name,
         command->operand[0] ? command->operand + 1 : "");
  print_roff(command->help);
  puts(".");
  print_options(command);
}

void kz_manual_print(void) {
  printf(".TH KAPITZA 1 \"\" \"kapitza %s\" \"User Commands\"\n.SH NAME\nkapitza \\- ", KZ_VERSION);
  print_roff(kz_program.help);
  puts("\n.SH SYNOPSIS\n.B kapitza\n.I COMMAND\n[\\fIOPTION\\fR]...");
  puts(
      ".SH DESCRIPTION\nMaps the basins of attraction of a rigid pendulum whose pivot is shaken up and down, and finds "
      "the "
      "attractors by itself. A scene (a YAML file) says which pendulum, and what to study; the result is one HDF5 file "
      "that "
      "netCDF "
      "tools read. A SCENE of \\- is standard input.");
  print_options(&kz_program);
  for (int i = 0; kz_commands[i]; i++) print_command(kz_commands[i]);
  puts(".SH EXIT STATUS");
  for (int i = 0; i < N_STATUSES; i++) printf(".TP\n.B %d\n%s\n", statuses[i].status, statuses[i].meaning);
  puts(
      ".SH ENVIRONMENT\n.TP\n.B KAPITZA_PYTHON\nPython of \\fBkapitza view\\fR, instead of .venv/bin/python beside the "
      "program.");
  puts(".SH SEE ALSO\n.BR mpirun (1),\n.BR ncdump (1)");
}
