#include "levels.h"
#include "kapitza/study_catalogue.h"

const kz_level kz_level_rows[KZ_LEVELS] = {
    [KZ_LEVEL_DOUBLE] = {"double", "cells", KZ_FOLLOWED, 4096, 1e-16L, false},
    [KZ_LEVEL_FINE] = {"double", "fine", KZ_IN_FINE, 4096, 1e-16L, false},
    [KZ_LEVEL_PAIRS_16] = {"pairs", "pairs 16", KZ_IN_PAIRS, 4096, 1e-17L, true},
    [KZ_LEVEL_PAIRS_20] = {"pairs", "pairs 20", KZ_IN_PAIRS, 2048, 1e-21L, true},
    [KZ_LEVEL_PAIRS_24] = {"pairs", "pairs 24", KZ_IN_PAIRS, 2048, 1e-25L, true},
    [KZ_LEVEL_PAIRS_28] = {"pairs", "pairs 28", KZ_IN_PAIRS, 1024, 1e-30L, true},
    [KZ_LEVEL_QUAD] = {"quad", "quad", KZ_IN_QUAD, 256, 1e-33L, true},
};

const char *kz_evidence_word(uint8_t evidence) {
  for (int32_t level = 0; level < KZ_LEVELS; level++)
    if (kz_level_rows[level].evidence == evidence) return kz_level_rows[level].word;
  for (int i = 0; i < kz_study_count; i++)
    for (int32_t level = 0; level < kz_studies[i]->n_levels; level++)
      if (kz_studies[i]->levels[level].evidence == evidence) return kz_studies[i]->levels[level].word;
  return NULL;
}

void kz_decide_in_doubles(kz_dynamics *dynamics, const kz_start *start, int64_t max_periods, bool look,
                          kz_decision *decision) {
  const kz_label_precision precision[] = {{.level = KZ_LEVEL_DOUBLE}, {.level = KZ_LEVEL_FINE}, {.guess = true}};
  for (int i = 0; i < (look ? 3 : 2); i++) {
    kz_dynamics_label(dynamics, precision + i, 1, start, max_periods, decision);
    if (i < 2 && decision->end.label != KZ_DOUBTFUL) return;
  }
  if (decision->end.label != 0) decision->end.label = KZ_DOUBTFUL;
}

void kz_decide_in_quads(kz_dynamics *dynamics, const kz_start *start, int64_t max_periods, kz_decision *decision) {
  const kz_label_precision precision = {.level = KZ_LEVEL_QUAD, .before = KZ_LEVEL_FINE};
  kz_dynamics_label(dynamics, &precision, 1, start, max_periods, decision);
}

bool kz_start_is_trapped(kz_dynamics *dynamics, const kz_start *start) {
  const kz_label_precision precision = {.level = KZ_LEVEL_DOUBLE};
  kz_decision decision;
  kz_dynamics_label(dynamics, &precision, 1, start, 1, &decision);
  return decision.end.label > 0;
}
