/* study: how the cells of a scene are released (C; layer 3). */
#pragma once

#include "kapitza/model_release.h"
#include "kapitza/study.h"

/* The release of a pendulum in place of the scene's. */
kz_release kz_release_of(const kz_scene *scene, const kz_pendulum *pendulum);
/* Whether motions begin alike. */
bool kz_release_is_same(const kz_release *a, const kz_release *b);
