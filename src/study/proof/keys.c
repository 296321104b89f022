/* The part `proof` of the study basin: its row, and its key. */
#define KEYS_OF proof

#include "kapitza/study_key_rows.h"
#include "plan.h"
#include "proof.h"

static const kz_key keys[] = {
    KZ_ROW("basin.proof", KZ_KEY_BOOLEAN, "false", KZ_ROW_OF_SCENE(has_proof),
           "Prove the labels under the differential equation itself; `evidence` marks those that are proved. Some ten "
           "times the "
           "time of the cells.",
           .unit = ""),
    {.path = NULL},
};

static const char *keys_limit(const kz_scene *scene, kz_drive_need need) {
  (void)scene;
  return need == KZ_NEEDS_STROBE ? "basin.proof needs starts at phase 0 and no ramp; leave one of them out" : NULL;
}

KZ_PART_ROW("basin", has_proof, .check = kz_proof_check, .of_basin = &kz_proof_part, .limit = keys_limit,
            .levels = kz_proof_levels, .n_levels = KZ_ENCLOSURES);
