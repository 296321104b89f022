/* The search for attractors that a scene asks for. */
#pragma once

#include "labelling/search.h"

/* Searches of a basin, of the study attractors, of the scene's basin or attractors (without a map table). */
kz_search kz_search_of_basin(const kz_basin_plan *plan);
kz_search kz_search_of_attractors(const kz_attractors_plan *plan, int64_t max_periods);
kz_search kz_search_of(const kz_scene *scene);
/* The dynamics of the scene's pendulum, for that search. */
kz_dynamics *kz_search_dynamics(const kz_scene *scene);
