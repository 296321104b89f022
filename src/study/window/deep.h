/* The part `deep` of the study basin: windows whose cells doubles do not distinguish, cells that quad precision does not decide. */
#pragma once

#include "basin/label.h"
#include "window.h"

extern const kz_basin_part kz_deep_part;
