/* Rules of the mapping pendulum. */
#ifndef KZ_APP_PENDULUM_RULES_H
#define KZ_APP_PENDULUM_RULES_H

#include "kapitza/study.h"
#include "scene.h"

/* Computes k, beta, m from the form that the scene uses; they are complete only if the reading has no complaint. One complaint names all keys
 * that a laboratory's pendulum lacks. */
void kz_pendulum_rules(kz_reading *reading, kz_scene *scene);

#endif
