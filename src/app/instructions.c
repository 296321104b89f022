/* Compiled, like all layers, for the instruction set of the build: what the compiler says here is what the program uses. */
#include <string.h>

#include "app.h"

/* The compiler defines __AVX2__ as 1 where it may use that set: such a name is written out as "1", any other as itself. */
#define WRITTEN(macro) #macro
#define WRITTEN_OUT(macro) WRITTEN(macro)
#define USED(name, text) WRITTEN_OUT(__##name##__),
const char *const kz_instructions[] = {KZ_INSTRUCTION_LIST(USED) NULL};

const char *kz_instruction_names(void) {
  static char names[256];
  size_t i = 0;
  names[0] = '\0';
#define APPEND(name, text)                                                 \
  if (kz_instructions[i++][0] == '1') {                                    \
    strncat(names, names[0] ? " " : "", sizeof names - strlen(names) - 1); \
    strncat(names, text, sizeof names - strlen(names) - 1);                \
  }
  KZ_INSTRUCTION_LIST(APPEND)
#undef APPEND
  return names[0] ? names : KZ_FIRST_INSTRUCTIONS;
}
