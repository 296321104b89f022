/* Completions of the shells, from the tables of commands, options and keys. */
#include <string.h>

#include "commands.h"

static bool is_key(const kz_option *row) {
  return row->argument && strcmp(row->argument, "KEY=VALUE") == 0;
}

static bool is_file(const kz_option *row) {
  return row->argument && strcmp(row->argument, "FILE") == 0;
}

static bool has_choices(const kz_option *row) {
  return is_key(row) || row->words;
}

/* What the argument can be, with blanks between; `end` is written behind each key. */
static void print_choices(const kz_option *row, const char *end) {
  for (const kz_key *key = kz_scene_keys(); is_key(row) && key->path; key++)
    printf("%s%s%s", key == kz_scene_keys() ? "" : " ", key->path, end);
  for (const char *c = row->words ? row->words : ""; *c; c++) putchar(*c == '|' ? ' ' : *c);
}

static void print_options(const kz_command *command) {
  for (const kz_option *row = NULL; (row = kz_option_next(command, row));) printf(" --%s", row->name);
}

/* What may stand behind the options of a command, as cases of bash. */
static void print_bash_cases(const kz_command *command) {
  for (const kz_option *row = NULL; (row = kz_option_next(command, row));) {
    if (!row->argument) continue;
    printf("    --%s", row->name);
    if (row->letter) printf("|-%c", row->letter);
    fputs(") ", stdout);
    if (has_choices(row)) {
      printf("%sCOMPREPLY=($(compgen %s-W \"", is_key(row) ? "compopt -o nospace; " : "", is_key(row) ? "-S = " : "");
      print_choices(row, "");
      fputs("\" -- \"$word\"))", stdout);
    } else {
      fputs(is_file(row) ? "compopt -o default; COMPREPLY=()" : "COMPREPLY=()", stdout);
    }
    puts("; return ;;");
  }
}

static void print_bash(void) {
  puts(
      "# bash completion of kapitza\n_kapitza() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} "
      "options\n  case $before in");
  print_bash_cases(&(kz_command){.bit = ~0});
  fputs("  esac\n  case ${COMP_WORDS[1]} in\n", stdout);
  for (int i = 0; i < kz_command_count; i++) {
    printf("    %s) options=\"", kz_commands[i].name);
    print_options(kz_commands + i);
    puts("\" ;;");
  }
  fputs("  esac\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n    options=\"", stdout);
  for (int i = 0; i < kz_command_count; i++) printf("%s%s", i > 0 ? " " : "", kz_commands[i].name);
  print_options(&kz_program);
  puts(
      "\"\n  elif [[ $word != -* ]]; then\n    compopt -o default; COMPREPLY=(); return\n  fi\n"
      "  COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n}\ncomplete -F _kapitza kapitza");
}

/* A text in single quotes of zsh, inside brackets of _arguments. */
static void print_zsh_text(const char *text) {
  for (; *text; text++) {
    if (*text == '\'') fputs("'\\'", stdout);
    if (strchr("[]:", *text)) putchar('\\');
    putchar(*text);
  }
}

static void print_zsh_option(const kz_option *row) {
  printf(" \\\n        '%s--%s[", is_key(row) ? "*" : "", row->name);
  print_zsh_text(row->help);
  putchar(']');
  if (row->argument) {
    putchar(':');
    print_zsh_text(row->argument);
    putchar(':');
  }
  if (is_file(row)) fputs("_files", stdout);
  if (has_choices(row)) putchar('(');
  print_choices(row, "");
  fputs(has_choices(row) ? ")'" : "'", stdout);
}

static void print_zsh(void) {
  puts("#compdef kapitza\n_kapitza() {\n  local -a commands=(");
  for (int i = 0; i < kz_command_count; i++) {
    printf("    '%s:", kz_commands[i].name);
    print_zsh_text(kz_commands[i].help);
    puts("'");
  }
  puts("  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n  case $words[2] in");
  for (int i = 0; i < kz_command_count; i++) {
    printf("    %s) shift words; (( CURRENT-- )); _arguments", kz_commands[i].name);
    for (const kz_option *row = NULL; (row = kz_option_next(kz_commands + i, row));) print_zsh_option(row);
    puts(kz_commands[i].most > 0 ? " \\\n        '1:scene:_files' ;;" : " ;;");
  }
  puts("  esac\n}\n_kapitza \"$@\"");
}

/* A text in single quotes of fish. */
static void print_fish_text(const char *text) {
  putchar('\'');
  for (; *text; text++) {
    if (*text == '\'' || *text == '\\') putchar('\\');
    putchar(*text);
  }
  putchar('\'');
}

static void print_fish_option(const kz_command *command, const kz_option *row) {
  if (command == &kz_program)
    printf("complete -c kapitza -n __fish_use_subcommand -l %s", row->name);
  else
    printf("complete -c kapitza -n '__fish_seen_subcommand_from %s' -l %s", command->name, row->name);
  if (row->letter) printf(" -s %c", row->letter);
  if (row->argument) fputs(is_file(row) ? " -r -F" : " -x", stdout);
  if (has_choices(row)) {
    fputs(" -a '", stdout);
    print_choices(row, "=");
    putchar('\'');
  }
  fputs(" -d ", stdout);
  print_fish_text(row->help);
  putchar('\n');
}

static void print_fish_options(const kz_command *command) {
  for (const kz_option *row = NULL; (row = kz_option_next(command, row));) print_fish_option(command, row);
}

static void print_fish(void) {
  puts("# fish completion of kapitza\ncomplete -c kapitza -n __fish_use_subcommand -f");
  print_fish_options(&kz_program);
  for (int i = 0; i < kz_command_count; i++) {
    printf("complete -c kapitza -n __fish_use_subcommand -a %s -d ", kz_commands[i].name);
    print_fish_text(kz_commands[i].help);
    putchar('\n');
    print_fish_options(kz_commands + i);
  }
}

void kz_completion_print(const char *shell) {
  if (strcmp(shell, "bash") == 0) print_bash();
  if (strcmp(shell, "zsh") == 0) print_zsh();
  if (strcmp(shell, "fish") == 0) print_fish();
}
