/* Discovery of the attractors that a set of starts ends on; shared by the studies that need a catalogue. */
#ifndef KAPITZA_DISCOVERY_H
#define KAPITZA_DISCOVERY_H

#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/parallel.h"

/* Follows n starts (state [n][2], half-turns and velocity; in and out) up to about max_periods periods, and finds the attractors
 * they end on; those join the catalogue and the regions (outline or table) of `dynamics` on every rank. owner [n] = attractor
 * from 1, 0 where the start has not settled on any. Collective; team NULL = this rank alone. */
kz_status kz_discover(kz_team *team, kz_dynamics *dynamics, int64_t max_periods, int64_t n, double *state, int32_t *owner);

/* Runs a stage with the team; team NULL = this rank alone, in order. */
kz_status kz_stage_run_with(kz_team *team, const kz_stage *stage, void *records);

#endif
