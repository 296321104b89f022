/* study: attractors as users see them (C; layer 3). */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* An attractor as users see it. */
typedef struct {
  kz_attractor row;
  char name[KZ_NAME_LENGTH];
  int32_t mirror;           /* id of the mirror image */
  double fraction;          /* share of the grid's cells that end on it; NaN without a grid */
  double *theta, *velocity; /* [period] strobe points: rad, rad per drive radian */
} kz_entry;

/* The attractors in the order of the file: the index of an entry is its id. */
typedef struct {
  int64_t count;
  kz_entry *entries;
  int32_t *id_of; /* [number], from 1: id of the attractor with this number in kz_dynamics; -1 = not in the catalogue */
} kz_catalogue;

/* Precision of this evidence as a word: double, pairs, quad, arbitrary; NULL = not decided, or not settled. */
const char *kz_evidence_word(uint8_t evidence);
