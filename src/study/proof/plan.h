/* What a scene says of proofs is whether it asks for them: kz_scene.has_proof. */
#pragma once

#include "kapitza/study.h"

struct kz_proof_plan {
  char none;
};
