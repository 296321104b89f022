/* Completion scripts of bash, zsh and fish, from the tables of the command line. */
#include <string.h>

#include "options.h"

/* Text inside single quotes, with a backslash before each byte of `special`. `quote` is how a shell writes ' there. */
static void put_quoted(FILE *out, const char *text, const char *special, const char *quote) {
  for (; *text; text++) {
    if (strchr(special, *text)) fputc('\\', out);
    if (*text == '\'')
      fputs(quote, out);
    else
      fputc(*text, out);
  }
}

static bool is_file(const kz_option_row *row) {
  return row->argument && strcmp(row->argument, "FILE") == 0;
}

/* Whether the argument is one of some words, "auto|always|never". */
static bool has_words(const kz_option_row *row) {
  return row->argument && strchr(row->argument, '|');
}

static void put_words(FILE *out, const kz_option_row *row) {
  for (const char *c = row->argument; *c; c++) fputc(*c == '|' ? ' ' : *c, out);
}

/* "--output -o --set ...": the options of some commands. */
static void put_names(FILE *out, int commands) {
  for (const kz_option_row *row = kz_option_rows; row->name; row++) {
    if (!(row->commands & commands)) continue;
    fprintf(out, " --%s", row->name);
    if (row->letter < 256) fprintf(out, " -%c", row->letter);
  }
}

/* A case for each option that takes an argument. */
static void put_bash_arguments(FILE *out) {
  for (const kz_option_row *row = kz_option_rows; row->name; row++) {
    if (!row->argument) continue;
    fprintf(out, "    --%s", row->name);
    if (row->letter < 256) fprintf(out, " | -%c", row->letter);
    fputs(")", out);
    if (is_file(row)) fputs(" mapfile -t COMPREPLY < <(compgen -f -- \"$word\");", out);
    if (has_words(row)) {
      fputs(" mapfile -t COMPREPLY < <(compgen -W '", out);
      put_words(out, row);
      fputs("' -- \"$word\");", out);
    }
    fputs(" return ;;\n", out);
  }
}

static void print_bash(FILE *out) {
  fputs(
      "# Completion of kapitza for bash, printed by kapitza --completion bash.\n"
      "_kapitza() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} names\n"
      "  case ${COMP_WORDS[COMP_CWORD - 1]} in\n",
      out);
  put_bash_arguments(out);
  fputs("  esac\n  case ${COMP_WORDS[1]} in\n", out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    fprintf(out, "    %s) names='", command->name);
    put_names(out, command->bit);
    fputs("' ;;\n", out);
  }
  fputs("    *) names='", out);
  put_names(out, kz_no_command.bit);
  fputs(
      "' ;;\n  esac\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then names+='",
      out);
  for (const kz_command_row *command = kz_commands; command->name; command++) fprintf(out, " %s", command->name);
  fputs(
      "'; fi\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ] || [[ $word == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$names\" -- \"$word\")\n"
      "  else\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
      "  fi\n"
      "}\n"
      "complete -o filenames -F _kapitza kapitza\n",
      out);
}

/* One specification of _arguments: '(-o --output)'{-o,--output}'[help]:FILE:_files'. */
static void put_zsh_option(FILE *out, const kz_option_row *row) {
  fputs(" \\\n      ", out);
  if (row->letter < 256)
    fprintf(out, "'(-%c --%s)'{-%c,--%s}'[", row->letter, row->name, row->letter, row->name);
  else
    fprintf(out, "'*--%s[", row->name);
  put_quoted(out, row->help, "[]:\\", "'\\''");
  fputc(']', out);
  if (row->argument) {
    fputc(':', out);
    put_quoted(out, row->argument, "[]:\\", "'\\''");
    fputs(is_file(row) ? ":_files" : has_words(row) ? ":(" : ": ", out);
    if (has_words(row)) {
      put_words(out, row);
      fputc(')', out);
    }
  }
  fputc('\'', out);
}

static void put_zsh_options(FILE *out, const kz_command_row *command) {
  fputs("_arguments", out);
  for (const kz_option_row *row = kz_option_rows; row->name; row++)
    if (row->commands & command->bit) put_zsh_option(out, row);
  if (command->operand[0] && command != &kz_no_command) fputs(" \\\n      '*::_files'", out);
}

static void print_zsh(FILE *out) {
  fputs(
      "#compdef kapitza\n# Completion of kapitza for zsh, printed by kapitza --completion zsh.\n"
      "local -a commands\ncommands=(",
      out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    fprintf(out, "\n  '%s:", command->name);
    put_quoted(out, command->help, ":\\", "'\\''");
    fputc('\'', out);
  }
  fputs("\n)\nif ((CURRENT == 2)); then\n  _describe command commands\n  ", out);
  put_zsh_options(out, &kz_no_command);
  fputs("\n  return\nfi\nlocal command=$words[2]\nshift words\n((CURRENT--))\ncase $command in\n", out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    fprintf(out, "  %s)\n    ", command->name);
    put_zsh_options(out, command);
    fputs(" ;;\n", out);
  }
  fputs("esac\n", out);
}

static void put_fish_option(FILE *out, const kz_option_row *row, const char *condition) {
  fprintf(out, "complete -c kapitza -n '%s' -l %s", condition, row->name);
  if (row->letter < 256) fprintf(out, " -s %c", row->letter);
  if (row->argument) fputs(is_file(row) ? " -r -F" : " -x", out);
  if (has_words(row)) {
    fputs(" -a '", out);
    put_words(out, row);
    fputc('\'', out);
  }
  fputs(" -d '", out);
  put_quoted(out, row->help, "\\", "\\'");
  fputs("'\n", out);
}

static void put_fish_options(FILE *out, const kz_command_row *command, const char *condition) {
  for (const kz_option_row *row = kz_option_rows; row->name; row++)
    if (row->commands & command->bit) put_fish_option(out, row, condition);
}

static void print_fish(FILE *out) {
  fputs("# Completion of kapitza for fish, printed by kapitza --completion fish.\n", out);
  for (const kz_command_row *command = kz_commands; command->name; command++) {
    char condition[96];
    snprintf(condition, sizeof condition, "__fish_seen_subcommand_from %s", command->name);
    fprintf(out, "complete -c kapitza -n __fish_use_subcommand -f -a %s -d '", command->name);
    put_quoted(out, command->help, "\\", "\\'");
    fputs("'\n", out);
    if (!command->operand[0]) fprintf(out, "complete -c kapitza -n '%s' -f\n", condition);
    put_fish_options(out, command, condition);
  }
  put_fish_options(out, &kz_no_command, "__fish_use_subcommand");
}

kz_status kz_completion_print(const char *shell, FILE *out) {
  static const struct {
    const char *name;
    void (*print)(FILE *out);
  } shells[] = {{"bash", print_bash}, {"zsh", print_zsh}, {"fish", print_fish}};
  for (size_t i = 0; i < sizeof shells / sizeof shells[0]; i++)
    if (strcmp(shell, shells[i].name) == 0) {
      if (out) shells[i].print(out);
      return KZ_OK;
    }
  return kz_fail(KZ_REFUSED, "--completion: \"%s\" is unknown; it must be bash, zsh or fish", shell);
}
