#include "kapitza/common.h"

void kz_words_add(char *words, size_t bytes, const char *word) {
  if (words[0]) strncat(words, "|", bytes - strlen(words) - 1);
  strncat(words, word, bytes - strlen(words) - 1);
}

const char *kz_words_next(const char **rest, int *length) {
  const char *word = *rest;
  if (!word[0]) return NULL;
  *length = (int)strcspn(word, "|");
  *rest = word + *length + (word[*length] == '|');
  return word;
}
