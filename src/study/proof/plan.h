/* A scene asks for proofs or does not: kz_scene.has_proof. */
#pragma once

#include "kapitza/study.h"

struct kz_proof_plan {
  char none;
};
