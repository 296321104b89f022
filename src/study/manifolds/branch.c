#include "manifolds.h"

kz_status kz_branch_read(kz_store *store, int64_t saddle, int64_t phase, kz_branch *branch) {
  const int64_t place[] = {saddle, phase};
  double period;
  KZ_TRY(kz_store_number(store, "saddles", "period", &saddle, &period));
  branch->period = (int32_t)period;
  KZ_TRY(kz_store_number(store, "saddles", "strobe_theta", place, &branch->theta));
  return kz_store_number(store, "saddles", "strobe_velocity", place, &branch->velocity);
}
