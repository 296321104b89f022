/* A stage: tiles are drawn, worked, kept and delivered. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "draw.h"
#include "progress.h"
#include "record_buffer.h"
#include "section.h"
#include "team.h"

/* Offsets of records and slots must not overflow. */
static const int64_t TILES_MAX = (int64_t)1 << 44;

typedef struct {
  kz_team *team;
  const kz_stage *stage;
  char *records;      /* [n_tiles][record_bytes]: complete on rank 0 */
  bool kept;          /* finished records go to the section */
  kz_section section; /* of the checkpoint */
  int64_t n_left;
  int64_t *left; /* [n_left] tiles to do; NULL: all of them in order */
  kz_record_buffer buffered;
  void *buffer; /* of the delivery, rank 0 */
  kz_draw draw;
  kz_meter meter;
} kz_shift;

static kz_status check(const kz_shift *shift) {
  const kz_stage *stage = shift->stage;
  if (stage->n_tiles < 0 || stage->n_tiles > TILES_MAX || stage->record_bytes > KZ_RECORD_MAX)
    return kz_fail(KZ_FAILED, "stage %s: %lld tiles of %zu bytes are too many", stage->name, (long long)stage->n_tiles,
                   stage->record_bytes);
  if (!shift->records && stage->n_tiles > 0 && (shift->team->rank == 0 || stage->everywhere))
    return kz_fail(KZ_FAILED, "stage %s: no room for the records", stage->name);
  return KZ_OK;
}

static kz_status prepare(kz_shift *shift) {
  KZ_TRY(check(shift));
  kz_team *team = shift->team;
  kz_record_buffer_begin(&shift->buffered, shift->stage->record_bytes);
  if (team->rank == 0 && team->size > 1 && !(shift->buffer = malloc(kz_record_buffer_message_bytes(&shift->buffered))))
    return kz_fail(KZ_FAILED, "stage %s: out of memory", shift->stage->name);
  return KZ_OK;
}

/* Tiles whose records are in the checkpoint are not done again. Collective. */
static kz_status recall(kz_shift *shift) {
  kz_team *team = shift->team;
  int64_t *left = NULL;
  kz_status status = KZ_OK;
  if (team->rank == 0)
    status = kz_section_open(&team->checkpoint, shift->stage, shift->records, &shift->section, &left, &shift->n_left);
  if ((status = kz_team_agree(team, status)) == KZ_OK) status = kz_team_broadcast(team, &shift->section, sizeof shift->section);
  if (status == KZ_OK) status = kz_team_broadcast(team, &shift->n_left, sizeof shift->n_left);
  if (team->rank != 0 && status == KZ_OK && !(left = malloc((size_t)shift->n_left * sizeof *left + 1)))
    status = kz_fail(KZ_FAILED, "stage %s: out of memory", shift->stage->name);
  shift->left = left;
  KZ_TRY(kz_team_agree(team, status));
  kz_section_adopt(&team->checkpoint, &shift->section);
  return kz_team_broadcast(team, left, (size_t)shift->n_left * sizeof *left);
}

static kz_status do_tile(kz_shift *shift, int64_t tile) {
  const kz_stage *stage = shift->stage;
  void *record;
  if (shift->team->rank == 0)
    record = memset(shift->records + (size_t)tile * stage->record_bytes, 0, stage->record_bytes);
  else if (!(record = kz_record_buffer_add(&shift->buffered, tile)))
    return kz_fail(KZ_FAILED, "stage %s: out of memory for the records", stage->name);
  KZ_TRY(stage->work(stage->context, tile, record));
  return shift->kept ? kz_section_save(&shift->team->checkpoint, &shift->section, tile, record) : KZ_OK;
}

/* Draws and does tiles until none is left; whoever cannot go on halts all ranks. */
static kz_status do_tiles(kz_shift *shift) {
  for (;;) {
    int64_t drawn;
    KZ_TRY(kz_draw_next(&shift->draw, &drawn));
    if (drawn < 0) return KZ_OK;
    kz_meter_show(&shift->meter, shift->stage->n_tiles - shift->n_left + drawn);
    kz_status status = kz_team_interrupted(shift->team);
    if (status == KZ_OK) status = do_tile(shift, shift->left ? shift->left[drawn] : drawn);
    if (status != KZ_OK) {
      KZ_TRY(kz_draw_halt(&shift->draw));
      return status;
    }
  }
}

/* A tile by all ranks. Sections of the stages that it runs count for this tile alone; those of the next tile take their place. */
static kz_status do_together(kz_shift *shift, int64_t tile) {
  const kz_stage *stage = shift->stage;
  kz_checkpoint *checkpoint = &shift->team->checkpoint;
  const kz_checkpoint outside = *checkpoint;
  void *record = memset(shift->records + (size_t)tile * stage->record_bytes, 0, stage->record_bytes);
  checkpoint->seed = kz_bytes_checksum(checkpoint->seed, &tile, sizeof tile);
  kz_status status = kz_team_agree(shift->team, stage->work(stage->context, tile, record));
  checkpoint->seed = outside.seed;
  checkpoint->end = outside.end;
  checkpoint->n_sections = outside.n_sections;
  if (status == KZ_OK && shift->kept && shift->team->rank == 0)
    status = kz_section_save(checkpoint, &shift->section, tile, record);
  return kz_team_agree(shift->team, status);
}

static kz_status work_together(kz_shift *shift) {
  for (int64_t i = 0; i < shift->n_left; ++i) {
    kz_meter_show(&shift->meter, shift->stage->n_tiles - shift->n_left + i);
    KZ_TRY(do_together(shift, shift->left ? shift->left[i] : i));
  }
  return KZ_OK;
}

static kz_status work(kz_shift *shift) {
  kz_status status = kz_team_agree(shift->team, kz_draw_prepare(&shift->draw, shift->team, shift->n_left));
  if (status == KZ_OK) {
    kz_draw_begin(&shift->draw);
    status = do_tiles(shift);
  }
  const kz_status ended = kz_draw_end(&shift->draw);
  return kz_team_agree(shift->team, status == KZ_OK ? ended : status);
}

/* The share of its time that a rank had nothing to do, of all ranks together; on rank 0. */
static kz_status measure_idle(kz_shift *shift, double *idle) {
  const double seconds = kz_clock() - shift->meter.begun;
  double busy = 0;
  KZ_MPI(MPI_Reduce(&shift->draw.busy, &busy, 1, MPI_DOUBLE, MPI_SUM, 0, shift->team->comm));
  *idle = seconds > 0 ? fmax(0, 1 - busy / (seconds * shift->team->size)) : 0;
  return KZ_OK;
}

static kz_status deliver(kz_shift *shift) {
  const kz_stage *stage = shift->stage;
  KZ_TRY(kz_record_buffer_deliver(&shift->buffered, shift->team, shift->buffer, shift->records));
  if (!stage->everywhere) return KZ_OK;
  return kz_team_broadcast(shift->team, shift->records, (size_t)stage->n_tiles * stage->record_bytes);
}

static kz_status run(kz_shift *shift) {
  KZ_TRY(kz_team_agree(shift->team, prepare(shift)));
  if (shift->kept) KZ_TRY(recall(shift));
  kz_meter_begin(&shift->meter, shift->team, shift->stage->name, shift->stage->n_tiles, shift->stage->n_tiles - shift->n_left);
  double idle = 0;
  const bool together = shift->stage->together;
  kz_status status = together ? kz_team_agree(shift->team, work_together(shift)) : work(shift);
  if (status == KZ_OK && !together) status = measure_idle(shift, &idle);
  kz_meter_end(&shift->meter, status == KZ_OK, idle);
  if (status == KZ_STOPPED && !together) return kz_team_stopped(shift->team);
  KZ_TRY(status);
  return deliver(shift);
}

kz_status kz_stage_run(kz_team *team, const kz_stage *stage, void *records) {
  kz_shift shift = {.team = team, .stage = stage, .records = records, .n_left = stage->n_tiles};
  shift.kept = stage->keep && team->checkpoint.file >= 0;
  const kz_status status = run(&shift);
  kz_record_buffer_end(&shift.buffered);
  free(shift.buffer);
  free(shift.left);
  return status;
}
