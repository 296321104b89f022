/* Compiled, like all layers, for the instruction set of the build: what the compiler says here is what the program uses. */
#include <string.h>

#include "app.h"

/* The compiler defines __AVX2__ as 1 where it may use that set: such a name is written out as "1", any other as itself. */
#define USED(name, text) KZ_WRITTEN(__##name##__),
const char *const kz_instructions[] = {KZ_INSTRUCTION_LIST(USED) NULL};

const char *kz_instruction_names(void) {
#define TEXT(name, text) text,
  static const char *const texts[] = {KZ_INSTRUCTION_LIST(TEXT) NULL};
#undef TEXT
  static char names[256];
  names[0] = '\0';
  for (size_t i = 0; texts[i]; i++) {
    if (kz_instructions[i][0] != '1') continue;
    if (names[0]) strncat(names, " ", sizeof names - strlen(names) - 1);
    strncat(names, texts[i], sizeof names - strlen(names) - 1);
  }
  return names[0] ? names : KZ_FIRST_INSTRUCTIONS;
}
