/* One counter on rank 0 from which all ranks draw. A halt adds so much that every later draw is beyond the last tile. */
#include "team.h"

static kz_status add(kz_team *team, int64_t amount, int64_t *before) {
  KZ_MPI(MPI_Fetch_and_op(&amount, before, MPI_INT64_T, 0, 0, MPI_SUM, team->counter));
  KZ_MPI(MPI_Win_flush(0, team->counter));
  return KZ_OK;
}

kz_status kz_counter_create(kz_team *team) {
  int64_t *memory;
  const MPI_Aint bytes = team->rank == 0 ? sizeof *memory : 0;
  KZ_MPI(MPI_Win_allocate(bytes, sizeof *memory, MPI_INFO_NULL, team->comm, &memory, &team->counter));
  KZ_MPI(MPI_Win_set_errhandler(team->counter, MPI_ERRORS_RETURN));
  KZ_MPI(MPI_Win_lock_all(0, team->counter));
  return KZ_OK;
}

kz_status kz_counter_free(kz_team *team) {
  if (team->counter == MPI_WIN_NULL) return KZ_OK;
  KZ_MPI(MPI_Win_unlock_all(team->counter));
  KZ_MPI(MPI_Win_free(&team->counter));
  return KZ_OK;
}

kz_status kz_counter_reset(kz_team *team) {
  if (team->rank != 0) return KZ_OK;
  const int64_t zero = 0;
  KZ_MPI(MPI_Put(&zero, 1, MPI_INT64_T, 0, 0, 1, MPI_INT64_T, team->counter));
  KZ_MPI(MPI_Win_flush(0, team->counter));
  return KZ_OK;
}

kz_status kz_counter_draw(kz_team *team, int64_t *drawn) {
  return add(team, 1, drawn);
}

kz_status kz_counter_halt(kz_team *team) {
  int64_t before;
  return add(team, KZ_COUNTER_MAX, &before);
}
