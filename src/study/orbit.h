/* Study `orbit`. */
#ifndef KAPITZA_STUDY_ORBIT_H
#define KAPITZA_STUDY_ORBIT_H

#include "kapitza/study.h"

bool kz_orbit_wanted(const kz_scene *scene);
kz_cost kz_orbit_cost(const kz_scene *scene);
kz_status kz_orbit_run(const kz_scene *scene, kz_team *team, kz_store *store, FILE *summary);

#endif
