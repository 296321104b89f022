/* The map table; the ranks share its rows. */
#ifndef KAPITZA_STUDY_MAP_TABLE_H
#define KAPITZA_STUDY_MAP_TABLE_H

#include <stdint.h>

#include "kapitza/dynamics.h"
#include "kapitza/parallel.h"

/* Builds the table of n_theta x n_velocity nodes up to velocity `max_velocity` on every rank. Collective; `run` NULL = this
 * rank alone. */
kz_status kz_map_table_make(const kz_run *run, kz_dynamics *dynamics, int64_t n_theta, int64_t n_velocity, double max_velocity);

#endif
