/* The levels of precision, and how labels are known. No other folder of studies knows a level by its name. */
#pragma once

#include "kapitza/dynamics_labels.h"
#include "kapitza/study.h"

/* How a label was found: the values of the file's variable `evidence` that the core gives; those of powers stand in
 * their folders. From KZ_UNDECIDED on the scene's own numerics did not decide it. KZ_LEFT is a doubtful label of method
 * direct; KZ_AVERAGED is that of a running state without a trapping region. */
typedef enum {
  KZ_UNSETTLED = 0,
  KZ_INSIDE = 1,
  KZ_FOLLOWED = 2,
  KZ_UNDECIDED = 3,
  KZ_IN_QUAD = 4,
  KZ_IN_PAIRS = 5,
  KZ_IN_FINE = 7,
  KZ_LEFT = 9,
  KZ_AVERAGED = 12
} kz_evidence;

/* A level: a row of a table. The code of the core's is their place (dynamics_labels.h); what carries their orbits is in
 * dynamics/labels/levels.f90. A power names its own in the row of its study (study.h). */
struct kz_level {
  const char *word;  /* for people; NULL = undecided */
  const char *stage; /* name of its stages */
  uint8_t evidence;  /* evidence of its decisions */
  int64_t tile;      /* items that are followed together */
  long double error; /* rad: what its arithmetic adds in a period, or less */
  bool in_pairs;     /* its starts need more digits than doubles have */
};
extern const kz_level kz_level_rows[KZ_LEVELS];

/* Decides where one orbit ends by double precision: *decision has KZ_DOUBTFUL if that does not decide it. `look`: where
 * doubles without regard to errors end nowhere known, the orbit counts as not settled. */
void kz_decide_in_doubles(kz_dynamics *dynamics, const kz_start *start, int64_t max_periods, bool approach_look,
                          kz_decision *decision);
/* Decides starts in quad precision. */
void kz_decide_in_quads(kz_dynamics *dynamics, const kz_start *start, int64_t max_periods, kz_decision *decision);
/* Whether a trapping region holds a start, with its error, after one period. */
bool kz_start_is_trapped(kz_dynamics *dynamics, const kz_start *start);

/* Evidence of a label as files have it; settled = it has an id. A start inside a region has its own value. */
static inline uint8_t kz_file_evidence(const kz_label *frame_label, bool settled) {
  if (frame_label->evidence == KZ_UNDECIDED) return KZ_UNDECIDED;
  if (!settled) return KZ_UNSETTLED;
  return frame_label->evidence == KZ_FOLLOWED && frame_label->periods == 0 ? KZ_INSIDE : frame_label->evidence;
}
