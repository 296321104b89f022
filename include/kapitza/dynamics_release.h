/* dynamics: starts that are released before the drive has its final form (Fortran; the layer above kernel). */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/model_release.h"

/* Sets how starts are released. Call after the trapping regions are made: its first use measures errors of a
 * release. */
void kz_dynamics_set_release(kz_dynamics *dynamics, const kz_release *release);
/* Returns the release that was set; without phase and ramp if none was, or if it is at a strobe of the final drive. */
void kz_dynamics_get_release(const kz_dynamics *dynamics, kz_release *release);
