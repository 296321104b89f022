/* Names of stages, which logs and checkpoints keep short, in words for people who watch a run. */
#include "app.h"

static const struct {
  const char *name, *words; /* the beginning of a name; the rest of it is a round */
} known[] = {
    {"cells", "labels in double precision"},
    {"fine", "labels in shorter steps"},
    {"pairs 16", "labels in pairs of doubles"},
    {"pairs 20", "labels in pairs of doubles, 20 digits"},
    {"pairs 24", "labels in pairs of doubles, 24 digits"},
    {"pairs 28", "labels in pairs of doubles, 28 digits"},
    {"quad", "labels in quad precision"},
    {"doubt", "test of doubtful labels"},
    {"ends", "ends of the starts"},
    {"file", "writing the file"},
    {"phases", "phases of release"},
    {"probes", "probes of the error"},
};

void kz_stage_words(const char *name, char *words, size_t bytes) {
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    const size_t length = strlen(known[i].name);
    if (strncmp(name, known[i].name, length) != 0 || (name[length] != '\0' && name[length] != ' ')) continue;
    const char *round = name[length] ? name + length + 1 : "";
    const bool number = round[0] && round[strspn(round, "0123456789")] == '\0';
    if (round[0] && !number) break;
    snprintf(words, bytes, number ? "%s, round %s" : "%s", known[i].words, round);
    return;
  }
  snprintf(words, bytes, "%s", name);
}
