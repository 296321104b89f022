/* Finds a point between two starts at which their basins meet, in any number of digits. Not collective. */
#ifndef KAPITZA_STUDY_BISECT_H
#define KAPITZA_STUDY_BISECT_H

#include "question.h"

/* The point on the straight line between the two starts of a question, whose labels differ: theta and velocity as texts with `digits` right
 * digits behind the point. */
typedef struct {
  char theta[KZ_DECIMAL_LENGTH], velocity[KZ_DECIMAL_LENGTH];
  int32_t label[2]; /* towards the first start, towards the second */
} kz_bisection;
kz_status kz_bisect(const kz_question *question, int64_t digits, kz_bisection *bisection);

#endif
