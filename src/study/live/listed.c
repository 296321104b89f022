/* Attractors that an atlas lists at a frame's pendulum: carried from its curves, without a search. */
#include "kapitza/dynamics_saddles.h"
#include "kapitza/study_atlas.h"
#include "live.h"

/* Largest relative difference of a frame's and the atlas's pendulum: values that people read are rounded. */
static const double SAME = 1e-9;

static kz_status listed_check(const kz_prepared *r, const kz_motions *motions) {
  const kz_pendulum *own = &r->scene.parameters.pendulum, *other = &motions->pendulum;
  if (kz_pendulums_parted(own, other) <= SAME) return KZ_OK;
  return kz_fail(KZ_REFUSED,
                 "request: x: the atlas has another pendulum there (k = %.10g, damping %.10g, m = %.10g); give the "
                 "point at which it has "
                 "the pendulum of the request (%.10g, %.10g, %.10g)",
                 other->k, other->beta, other->m, own->k, own->beta, own->m);
}

/* Whether more cycles of some period are listed than are known. */
static bool lacks_some(const kz_prepared *r, const kz_motions *motions) {
  int64_t missing[KZ_ATLAS_MOST_PERIOD + 1] = {0};
  for (int64_t i = 0; i < motions->count; i++) missing[motions->motion[i].of.period] += motions->motion[i].of.images;
  for (int64_t a = 1; a <= kz_dynamics_count(r->dynamics); a++) {
    kz_attractor row;
    kz_dynamics_attractor(r->dynamics, a, &row);
    if (row.period > 0 && row.period <= KZ_ATLAS_MOST_PERIOD) missing[row.period]--;
  }
  for (int64_t period = 1; period <= r->scene.basin->max_period && period <= KZ_ATLAS_MOST_PERIOD; period++)
    if (missing[period] > 0) return true;
  return false;
}

kz_status kz_prepared_take_listed(kz_prepared *r, const kz_frame *frame) {
  KZ_AUTOFREE_BY(kz_motions_free) kz_motions list = {0}, motions = {0};
  KZ_TRY(kz_atlas_motions(frame->atlas, frame->x, frame->y, false, &list));
  KZ_TRY(listed_check(r, &list));
  if (!list.known || !lacks_some(r, &list)) return KZ_OK;
  KZ_TRY(kz_atlas_motions(frame->atlas, frame->x, frame->y, true, &motions));
  for (int64_t i = 0; i < motions.count; i++) {
    const kz_motion *motion = motions.motion + i;
    if (motion->strobes > 0 && motion->of.period <= r->scene.basin->max_period)
      kz_dynamics_add_cycle(r->dynamics, motion->of.period, motion->theta[0], motion->velocity[0]);
  }
  kz_dynamics_update(r->dynamics);
  return KZ_OK;
}
