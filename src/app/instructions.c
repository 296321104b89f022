/* Compiled for the instruction set of the build, as all layers: what the compiler says here holds for all. */
#include <pthread.h>

#include "app.h"

/* __AVX2__ is defined as 1 where the compiler may use that set: it is written as "1", any other name as itself. */
#define USED(name, text) KZ_STRINGIFY(__##name##__),
const char *const kz_instructions[] = {KZ_INSTRUCTION_LIST(USED) NULL};

static char names[256];

static void join_names(void) {
#define TEXT(name, text) text,
  static const char *const texts[] = {KZ_INSTRUCTION_LIST(TEXT) NULL};
#undef TEXT
  for (size_t i = 0; texts[i]; i++) {
    if (kz_instructions[i][0] != '1') continue;
    if (names[0]) strncat(names, " ", sizeof names - strlen(names) - 1);
    strncat(names, texts[i], sizeof names - strlen(names) - 1);
  }
  if (!names[0]) strcpy(names, KZ_FIRST_INSTRUCTIONS);
}

const char *kz_instruction_names(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, join_names);
  return names;
}
