/* Mean lives under noise, by counting. */
#pragma once

#include "kapitza/study.h"
#include "labelling/listed.h"

/* Whether the scene's plan leaves an attractor. */
bool kz_escape_is_left(const kz_escape_plan *plan, const kz_listed *attractors, int64_t id);
/* Counts the lives of the attractors that are left, at each temperature; writes and prints them. Collective. */
kz_status kz_escape_count(const kz_scene *scene, const kz_run *run, const kz_listed *attractors, kz_store *store,
                          FILE *summary);
