/* The precision levels of method exact as stages of cells; and the candidates of those that none decides. */
#include "label_parts.h"

typedef struct {
  const char *name; /* of its stages; the first one's are those of all cells */
  int64_t tile;     /* cells that are followed together */
  uint8_t evidence; /* of what it labels */
} level;

static const level levels[KZ_LEVELS + 1] = {
    [KZ_LEVEL_DOUBLE] = {"cells", 4096, KZ_FOLLOWED},      [KZ_LEVEL_FINE] = {"fine", 4096, KZ_IN_FINE},
    [KZ_LEVEL_PAIRS_16] = {"pairs 16", 4096, KZ_IN_PAIRS}, [KZ_LEVEL_PAIRS_20] = {"pairs 20", 2048, KZ_IN_PAIRS},
    [KZ_LEVEL_PAIRS_24] = {"pairs 24", 2048, KZ_IN_PAIRS}, [KZ_LEVEL_PAIRS_28] = {"pairs 28", 1024, KZ_IN_PAIRS},
    [KZ_LEVEL_QUAD] = {"quad", 256, KZ_IN_QUAD},           [KZ_LEVEL_ARBITRARY] = {"arbitrary", 1, KZ_IN_ARBITRARY},
    [KZ_LEVELS] = {"candidates", 64, KZ_UNDECIDED},
};

const char *kz_level_name(int number) {
  return levels[number].name;
}

int64_t kz_level_tile(int number) {
  return levels[number].tile;
}

uint8_t kz_level_evidence(int number) {
  return levels[number].evidence;
}
