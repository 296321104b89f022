/* study: units and meanings for tables of variables (kz_variable of store.h), beside the study that writes them. */
#pragma once

#include "kapitza/store.h"

/* Units that many variables have. */
#define ANGLE "rad"
#define VELOCITY "1|rad per drive radian"
#define PERIODS "1|drive periods"
#define RATE "1|1 per drive period"
#define NONE "1"
/* Meanings of the centre of a motion. */
#define CENTRES "down", "inverted", "rotating", "none"
