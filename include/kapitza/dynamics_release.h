/* dynamics: starts that are released before the drive has its final form (Fortran; the layer above kernel). */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/model_release.h"

/* Sets how starts are released. The errors of a release are measured at its first use, which must come after the trapping regions are made. */
void kz_dynamics_set_release(kz_dynamics *dynamics, const kz_release *release);
/* That release; one without a phase and a ramp where none is set that is not at a strobe of the final drive. */
void kz_dynamics_get_release(const kz_dynamics *dynamics, kz_release *release);
