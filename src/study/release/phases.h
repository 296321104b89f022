/* Items released at phases spread evenly over a drive period; attractors and regions are the same at all. */
#pragma once

#include "kapitza/dynamics_release.h"
#include "labelling/labeller.h"

typedef struct {
  kz_labeller labeller; /* labeller of the items 0 .. n - 1, without a run */
  kz_release release;   /* whose phase is replaced */
  int64_t phases, n;
  bool folded; /* item n - 1 - i at a phase is the image of item i half a period before: phases fold */
  const char *stage;
  int16_t *label; /* on rank 0, of kz_phases_label: of kz_phases_free */
  int16_t *image; /* [attractors + 1] numbers of the images */
} kz_phases;
/* Whether items that mirror each other are released at so many phases of a pendulum as `folded` says. */
bool kz_phases_fold(const kz_pendulum *pendulum, const kz_release *release, int64_t phases);

/* Phase i, rad. */
double kz_phase_at(const kz_phases *phases, int64_t i);
/* Labels all items at all phases, in one kept stage. Collective. */
kz_status kz_phases_label(kz_phases *phases, const kz_run *run);
void kz_phases_free(kz_phases *phases);
/* Bytes that the labels take. */
double kz_phases_bytes(int64_t phases, int64_t n);

/* The label of an item at a phase: a number of kz_dynamics, 0 = not settled or not decided. */
int16_t kz_phases_at(const kz_phases *phases, int64_t phase, int64_t item);
/* How many different ends an item has: attractors, and one more where it has not settled or is not decided. */
int64_t kz_phases_ends(const kz_phases *phases, int64_t item);
/* The attractor in which an item ends at all phases; 0 = there is none. */
int16_t kz_phases_common(const kz_phases *phases, int64_t item);
