/* Study `tangency`: the search along the key. */
#pragma once

#include "arm.h"

/* A search, from cycles that are known at `value`. */
typedef struct {
  const kz_scene *scene;
  double value;
  kz_hinge from, into; /* of the unstable and of the stable manifold */
  double nearness;     /* rad: of the branches' beginnings to the cycles */
  bool lost;           /* a cycle could not be followed, or was no saddle */
  kz_touch touch;      /* in the end: where the branches touch */
} kz_tangency_search;

typedef struct {
  double value;
  double error;  /* change of the value if the branches begin five times as far from the cycles */
  int32_t above; /* 1: they cross above the value; 0: below */
} kz_tangency;

/* Makes both branches at a value; free them with kz_arm_free. False if that fails. */
bool kz_tangency_arms(kz_tangency_search *search, double value, const kz_touch *touch, kz_arm arm[2]);
/* Finds the value in the range of the scene. KZ_REFUSED: the manifolds cross at both ends, at neither, or a cycle is lost on the way. */
kz_status kz_tangency_find(kz_tangency_search *search, kz_tangency *found);
