/* Starts to be labelled by the command where, after the attractors are known. */
#ifndef KAPITZA_STUDY_QUESTION_H
#define KAPITZA_STUDY_QUESTION_H

#include "attractors/catalogue.h"
#include "kapitza/study_where.h"

typedef struct {
  const kz_scene *scene;
  kz_dynamics *dynamics;
  int64_t max_periods, n;
  const kz_coordinate (*start)[2]; /* [n] as of kz_where */
  kz_decision *decision;           /* [n] */
} kz_question;

/* Labels the starts as method exact does: fills `decision`. An undecided start gets its candidates in place of KZ_DOUBTFUL. */
kz_status kz_question_decide(kz_question *question);
void kz_question_free(kz_question *question);

/* Clears endings [n]. */
void kz_endings_clear(int64_t n, kz_ending *endings);
/* Fills endings [n] from the decisions, with names of the catalogue. */
void kz_question_answer(const kz_question *question, const kz_catalogue *catalogue, kz_ending *endings);

#endif
