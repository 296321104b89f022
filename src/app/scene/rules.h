/* Rules between keys: what the files of rules share. Each rule complains at the node that a user would change. */
#pragma once

#include "scene.h"

/* The path of the key `name` of a mapping. */
kz_short_text kz_key_in(const char *mapping, const char *name);

/* Rules for windows and ranges of values; `path` names the mapping. min must be below max, and double precision must
 * distinguish neighbouring cells. */
void kz_axis_rules(kz_reading *reading, const kz_axis *axis, const char *path);
/* The axis of a basin from its edges, or from its centre and width. */
void kz_axis_set(kz_reading *reading, const kz_basin_plan *plan, kz_edges edges, kz_axis *axis, const char *path);
/* The scene gives both edges or neither; neither means the whole circle. */
void kz_theta_rules(kz_reading *reading, kz_axis *theta, const char *path);
/* Values from min to max, both included; if they are equal, there must be one value. */
void kz_axis_ends_rules(kz_reading *reading, const kz_axis *axis, const char *path);

/* Computes k, beta, m from the form that the scene uses; they are complete only if the reading has no complaint. One
 * complaint names all keys that a laboratory's pendulum lacks. */
void kz_pendulum_rules(kz_reading *reading, kz_scene *scene);
