/* Rules for windows and ranges of values; each complains at the node that a user would change. `path` names the mapping. */
#ifndef KAPITZA_APP_AXIS_RULES_H
#define KAPITZA_APP_AXIS_RULES_H

#include "kapitza/study.h"
#include "scene.h"

typedef struct {
  char text[32];
} kz_shortest_text;

/* The number as a user would write it. */
kz_shortest_text kz_shortest(double value);

/* min must be below max, and double precision must distinguish neighbouring cells. */
void kz_axis_rules(kz_reading *reading, const kz_axis *axis, const char *path);

/* The axis of a basin from its edges, or from its centre and width. */
void kz_axis_set(kz_reading *reading, const kz_basin_plan *plan, kz_edges edges, kz_axis *axis, const char *path);

/* The scene gives both edges or neither; neither means the whole circle. */
void kz_theta_rules(kz_reading *reading, kz_axis *theta, const char *path);

/* Values from min to max, both included; if they are equal, there must be one value. */
void kz_ends_rules(kz_reading *reading, const kz_axis *axis, const char *path);

#endif
