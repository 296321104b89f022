/* A point between two starts where their basins meet, in any number of digits. Not collective. */
#ifndef KAPITZA_STUDY_BISECT_H
#define KAPITZA_STUDY_BISECT_H

#include "question.h"

/* On the straight line between the two starts of a question whose labels differ: theta and velocity as texts, right to `digits` behind the
 * point, with the labels of both sides. */
typedef struct {
  char theta[KZ_DECIMAL_LENGTH], velocity[KZ_DECIMAL_LENGTH];
  int32_t label[2]; /* towards the first start, towards the second */
} kz_bisection;
kz_status kz_bisect(const kz_question *question, int64_t digits, kz_bisection *bisection);

#endif
