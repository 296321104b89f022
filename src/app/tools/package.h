/* Commands that are Python. */
#pragma once

#include "../app.h"

/* Words of a command line. */
enum { KZ_PACKAGE_WORDS = 512 };
typedef struct {
  int n;
  const char *word[KZ_PACKAGE_WORDS]; /* [n] */
} kz_package_words;
/* Appends an option and its argument; NULL: it has none. */
void kz_package_word(kz_package_words *words, const char *option, const char *argument);

/* This process becomes the command `name` of the Python package, with these words, and behind them the sets, --json and
 * operands of its options. Returns only after a failure, and on ranks that print nothing. */
kz_status kz_package_call(const kz_options *options, const char *name, kz_package_words *words);
