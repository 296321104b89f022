/* Completions of shells: each script asks the program for the next words, known from tables of commands and keys. */
#include "commands.h"

/* A word and its description a line; FILE where the name of a file may stand. */
static const struct {
  const char *shell, *script;
} scripts[] = {
    {"bash",
     "# bash completion of kapitza\n"
     "_kapitza() {\n"
     "  local found word=${COMP_WORDS[COMP_CWORD]}\n"
     "  found=$(\"${COMP_WORDS[0]/#\\~/$HOME}\" --complete \"${COMP_WORDS[*]:0:COMP_CWORD+1}\" 2>/dev/null | cut -f "
     "1)\n"
     "  if [ \"$found\" = FILE ]; then compopt -o default; COMPREPLY=(); return; fi\n"
     "  case $found in *=) compopt -o nospace ;; esac\n"
     "  COMPREPLY=($(compgen -W \"$found\" -- \"$word\"))\n"
     "}\n"
     "complete -F _kapitza kapitza"},
    {"zsh",
     "#compdef kapitza\n"
     "_kapitza() {\n"
     "  local -a found=(\"${(@f)$(${~words[1]} --complete \"${words[1,CURRENT]}\" 2>/dev/null)}\") suffix=()\n"
     "  if [[ $found == FILE ]]; then _files; return; fi\n"
     "  found=(\"${(@)found//:/\\\\:}\")\n"
     "  found=(\"${(@)found/$'\\t'/:}\")\n"
     "  [[ $found[1] == *=:* ]] && suffix=(-S '')\n"
     "  _describe kapitza found $suffix\n"
     "}\n"
     "_kapitza \"$@\""},
    {"fish",
     "function __kapitza\n"
     "  set -l words (commandline -opc)\n"
     "  set -l found (eval $words[1] --complete (string escape -- \"$words \"(commandline -ct)) 2>/dev/null)\n"
     "  if test \"$found\" = FILE\n"
     "    __fish_complete_path (commandline -ct)\n"
     "  else\n"
     "    printf '%s\\n' $found\n"
     "  end\n"
     "end\n"
     "complete -c kapitza -f -a '(__kapitza)'"},
};

void kz_completion_print(const char *shell) {
  for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; i++)
    if (strcmp(shell, scripts[i].shell) == 0) puts(scripts[i].script);
}

static void print_options(const kz_command *command) {
  const char *names = command->options;
  for (const kz_option *row; (row = kz_option_next(command, &names));) printf("--%s\t%s\n", row->name, row->help);
}

/* Words that the argument of an option can be. */
static void print_arguments(const kz_option *row) {
  const char *words = row->words ? row->words : "", *word;
  int length;
  if (strcmp(row->argument, "FILE") == 0) puts("FILE");
  for (const kz_key *key = kz_scene_keys(); strcmp(row->argument, "KEY=VALUE") == 0 && key->path; key++)
    printf("%s=\t%s\n", key->path, key->help);
  while ((word = kz_words_next(&words, &length))) printf("%.*s\n", length, word);
}

/* The option of a command that takes an argument and is written so; NULL if there is none. */
static const kz_option *option_of(const kz_command *command, const char *word) {
  const char *names = command->options;
  for (const kz_option *row; (row = kz_option_next(command, &names));) {
    const bool is_short = word[0] == '-' && row->letter && word[1] == row->letter && word[2] == '\0';
    if (row->argument && (is_short || (strncmp(word, "--", 2) == 0 && strcmp(word + 2, row->name) == 0))) return row;
  }
  return NULL;
}

void kz_completion_answer(const char *line) {
  KZ_AUTOFREE char *copy = kz_strdup(line);
  const char *first = "", *before = "", *last = "";
  const kz_command *command = &kz_program;
  int n = 0;
  for (char *rest = copy, *word; (word = strsep(&rest, " "));) {
    if (!*word && rest) continue;
    if (n++ == 1) first = word;
    before = last;
    last = word;
  }
  for (int i = 0; kz_commands[i]; i++) {
    if (n <= 2) printf("%s\t%s\n", kz_commands[i]->name, kz_commands[i]->help);
    if (n > 2 && strcmp(first, kz_commands[i]->name) == 0) command = kz_commands[i];
  }
  const kz_option *row = option_of(command, before);
  if (row)
    print_arguments(row);
  else if (n <= 2 || last[0] == '-')
    print_options(command);
  else
    puts("FILE");
}
