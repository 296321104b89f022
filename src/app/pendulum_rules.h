/* Rules of the mapping pendulum. */
#ifndef KZ_APP_PENDULUM_RULES_H
#define KZ_APP_PENDULUM_RULES_H

#include "kapitza/study.h"
#include "scene.h"

/* k, beta, m from the form that the scene chose; only a reading without complaints has it whole. All keys that a laboratory's pendulum lacks
 * are named at once. */
void kz_pendulum_rules(kz_reading *reading, kz_scene *scene);

#endif
