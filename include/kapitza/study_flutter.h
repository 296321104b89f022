/* study: drives of a sine between which flutter attracts (C; layer 3). */
#pragma once

#include "kapitza/study.h"

/* Drives m of a sine at which a damped pendulum that can stand upside down flutters about the inverted position: from
 * where that position loses its stability by the multiplier -1 to where the cycles that follow flutter double their
 * period; NaN = it does not, or the end is not known. */
void kz_flutter_drives(const kz_pendulum *pendulum, double *onset, double *end);
