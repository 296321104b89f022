/* Words that tables of variables share (kz_variable of store.h). Such a table lies beside the study that writes its group. */
#pragma once

#include "kapitza/store.h"

/* Units that many variables have. */
#define ANGLE "rad"
#define VELOCITY "1|rad per drive radian"
#define PERIODS "1|drive periods"
#define RATE "1|1 per drive period"
#define NONE "1"
/* Meanings that several have. */
#define CENTRES "down", "inverted", "rotating", "none"
