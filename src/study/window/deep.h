/* Part `deep` of the study basin: windows that doubles do not resolve, cells that quad precision leaves undecided. */
#pragma once

#include "basin/label.h"
#include "window.h"

extern const kz_basin_part kz_deep_part;
