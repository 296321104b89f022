/* A stage: tiles are drawn, done, kept and delivered. */
#include "bytes.h"
#include "checkpoint.h"
#include "dispatch.h"
#include "record_buffer.h"
#include "watch.h"
#include "kapitza/common_border.h"

/* Largest number of tiles, so that offsets of records and slots do not overflow. */
static const int64_t TILES_MAX = (int64_t)1 << 44;

typedef struct {
  kz_ranks *ranks;
  kz_checkpoint *checkpoint;
  const kz_stage *stage;
  char *records;      /* [n_tiles][record_bytes], complete on rank 0 */
  bool kept;          /* True: finished records go to the section */
  kz_section section; /* Section of the checkpoint */
  int64_t n_unfinished;
  int64_t *unfinished; /* [n_unfinished] tiles to do; NULL: all of them in order */
  kz_record_buffer buffered;
  void *buffer; /* Buffer of the delivery, rank 0, or of a local record */
  kz_dispatch dispatch;
  kz_work work;
  kz_meter meter;
} stage_run;

static kz_status check_stage(const stage_run *run) {
  const kz_stage *stage = run->stage;
  if (stage->n_tiles < 0 || stage->n_tiles > TILES_MAX || stage->record_bytes > KZ_RECORD_MAX)
    return kz_fail(KZ_FAILED, "stage %s: %lld tiles of %zu bytes are too many", stage->name, (long long)stage->n_tiles,
                   stage->record_bytes);
  if (!run->records && !stage->local && stage->n_tiles > 0 && (run->ranks->rank == 0 || stage->everywhere))
    return kz_fail(KZ_FAILED, "stage %s: no memory for the records", stage->name);
  return KZ_OK;
}

static kz_status prepare_run(stage_run *run) {
  KZ_TRY(check_stage(run));
  kz_ranks *ranks = run->ranks;
  kz_record_buffer_begin(&run->buffered, run->stage->record_bytes);
  const size_t message = ranks->rank == 0 && ranks->size > 1 ? kz_record_buffer_message_bytes(&run->buffered) : 0;
  const size_t bytes = run->stage->local ? run->stage->record_bytes : message;
  if (bytes > 0) run->buffer = kz_malloc(bytes);
  return KZ_OK;
}

/* Rank 0: reads the records of the checkpoint and sets `done` [n_tiles] of their tiles. */
static void recall_records(stage_run *run, int64_t *done) {
  const kz_stage *stage = run->stage;
  for (int64_t tile = 0; run->ranks->rank == 0 && tile < stage->n_tiles; ++tile)
    done[tile] =
        kz_section_recall(run->checkpoint, &run->section, tile, run->records + (size_t)tile * stage->record_bytes);
}

/* Distributes local records of the checkpoint among the ranks. */
static void recall_local(stage_run *run, int64_t *done) {
  const kz_ranks *ranks = run->ranks;
  for (int64_t tile = ranks->rank; tile < run->stage->n_tiles; tile += ranks->size) {
    if (!kz_section_recall(run->checkpoint, &run->section, tile, run->buffer)) continue;
    done[tile] = 1;
    kz_local_records_add(run->stage->local, tile, run->buffer, kz_section_used(&run->section, run->buffer));
  }
}

/* Excludes tiles whose records are in the checkpoint. Collective. */
static kz_status recall_finished(stage_run *run) {
  kz_ranks *ranks = run->ranks;
  const int64_t n_tiles = run->stage->n_tiles;
  bool known = false;
  kz_status status = ranks->rank == 0 ? kz_section_open(run->checkpoint, run->stage, &run->section, &known) : KZ_OK;
  KZ_TRY(kz_ranks_agree(ranks, status));
  KZ_TRY(kz_ranks_broadcast(ranks, &run->section, sizeof run->section));
  KZ_TRY(kz_ranks_broadcast(ranks, &known, sizeof known));
  run->unfinished = kz_calloc((size_t)n_tiles + 1, sizeof *run->unfinished);
  if (known && run->stage->local)
    recall_local(run, run->unfinished);
  else if (known)
    recall_records(run, run->unfinished);
  KZ_TRY(kz_ranks_sum(ranks, run->unfinished, n_tiles));
  run->n_unfinished = 0;
  for (int64_t tile = 0; tile < n_tiles; ++tile)
    if (!run->unfinished[tile]) run->unfinished[run->n_unfinished++] = tile;
  kz_section_adopt(run->checkpoint, &run->section);
  return KZ_OK;
}

/* Does the work of a tile, or of its items. */
static kz_status work_tile(const kz_stage *stage, int64_t tile, void *record) {
  if (!stage->items) return stage->work(stage->context, tile, record);
  const int64_t tiles = (stage->n_items + stage->batch - 1) / stage->batch; /* tiles of a row */
  const int64_t first = tile % tiles * stage->batch, left = stage->n_items - first;
  return stage->items(stage->context, tile / tiles * stage->n_items + first, kz_smaller(left, stage->batch), record);
}

/* Where the record of a tile is made. */
static void *record_of(stage_run *run, int64_t tile) {
  const kz_stage *stage = run->stage;
  if (stage->local) return memset(run->buffer, 0, stage->record_bytes);
  if (run->ranks->rank != 0) return kz_record_buffer_add(&run->buffered, tile);
  return memset(run->records + (size_t)tile * stage->record_bytes, 0, stage->record_bytes);
}

/* Draws and does tiles until none is left; a rank that cannot go on halts all. */
static kz_status do_tiles(stage_run *run) {
  const kz_stage *stage = run->stage;
  for (;;) {
    int64_t drawn;
    KZ_TRY(kz_dispatch_next(&run->dispatch, &drawn));
    if (drawn < 0) return KZ_OK;
    kz_meter_show(&run->meter, stage->n_tiles - run->n_unfinished + drawn);
    const int64_t tile = run->unfinished ? run->unfinished[drawn] : drawn;
    const kz_stopwatch watch = kz_stopwatch_start();
    kz_status status = kz_ranks_interrupted(run->ranks);
    if (status == KZ_OK) {
      void *record = record_of(run, tile);
      status = work_tile(stage, tile, record);
      if (status == KZ_OK && stage->local) kz_local_records_add(stage->local, tile, record, *(uint64_t *)record);
      if (status == KZ_OK && run->kept) status = kz_section_save(run->checkpoint, &run->section, tile, record);
    }
    kz_work_note(&run->work, tile, &watch);
    if (status == KZ_OK) continue;
    KZ_TRY(kz_dispatch_halt(&run->dispatch));
    return status;
  }
}

/* Does a tile by all ranks. Sections of the stages that it runs are valid for this tile alone. */
static kz_status do_collectively(stage_run *run, int64_t tile) {
  const kz_stage *stage = run->stage;
  kz_checkpoint *checkpoint = run->checkpoint;
  const kz_checkpoint outside = *checkpoint;
  void *record = memset(run->records + (size_t)tile * stage->record_bytes, 0, stage->record_bytes);
  checkpoint->seed = kz_bytes_checksum(checkpoint->seed, &tile, sizeof tile);
  kz_status status = kz_ranks_agree(run->ranks, work_tile(stage, tile, record));
  checkpoint->seed = outside.seed;
  checkpoint->end = outside.end;
  checkpoint->n_sections = outside.n_sections;
  if (status == KZ_OK && run->kept && run->ranks->rank == 0)
    status = kz_section_save(checkpoint, &run->section, tile, record);
  return kz_ranks_agree(run->ranks, status);
}

static kz_status work_collectively(stage_run *run) {
  for (int64_t i = 0; i < run->n_unfinished; ++i) {
    kz_meter_show(&run->meter, run->stage->n_tiles - run->n_unfinished + i);
    KZ_TRY(do_collectively(run, run->unfinished ? run->unfinished[i] : i));
  }
  return KZ_OK;
}

static kz_status deliver_records(stage_run *run) {
  const kz_stage *stage = run->stage;
  if (stage->local) return KZ_OK;
  KZ_TRY(kz_record_buffer_deliver(&run->buffered, run->ranks, run->buffer, run->records));
  if (!stage->everywhere) return KZ_OK;
  return kz_ranks_broadcast(run->ranks, run->records, (size_t)stage->n_tiles * stage->record_bytes);
}

/* Does all tiles in this process, in order. */
static kz_status run_alone(const kz_stage *stage, char *records) {
  KZ_AUTOFREE char *own = stage->local ? kz_malloc(stage->record_bytes + 1) : NULL;
  for (int64_t tile = 0; tile < stage->n_tiles; tile++) {
    char *record = own ? own : records + (size_t)tile * stage->record_bytes;
    kz_look();
    KZ_TRY(work_tile(stage, tile, memset(record, 0, stage->record_bytes)));
    if (own) kz_local_records_add(stage->local, tile, own, *(uint64_t *)(void *)own);
  }
  return KZ_OK;
}

static void end_run(stage_run *run) {
  kz_record_buffer_end(&run->buffered);
  free(run->buffer);
  free(run->unfinished);
}

kz_status kz_stage_run(const kz_run *on, const kz_stage *stage, void *records) {
  if (!on || !on->ranks) return run_alone(stage, records);
  KZ_AUTOFREE_BY(end_run)
  stage_run run = {.ranks = on->ranks,
                   .checkpoint = on->checkpoint,
                   .stage = stage,
                   .records = records,
                   .kept = stage->keep && on->checkpoint,
                   .n_unfinished = stage->n_tiles};
  KZ_TRY(kz_ranks_agree(run.ranks, prepare_run(&run)));
  if (run.kept) KZ_TRY(recall_finished(&run));
  kz_meter_begin(&run.meter, run.ranks, stage->name, stage->n_tiles, stage->n_tiles - run.n_unfinished);
  double idle = 0;
  run.work = (kz_work){.ranks = run.ranks, .stage = stage->name};
  const kz_stopwatch watch = kz_stopwatch_start();
  const bool collective = stage->collective;
  kz_status status, ended = KZ_OK;
  if (collective) {
    status = work_collectively(&run);
  } else {
    kz_dispatch_begin(&run.dispatch, run.ranks, run.n_unfinished);
    status = do_tiles(&run);
    ended = kz_dispatch_end(&run.dispatch);
  }
  status = kz_ranks_agree(run.ranks, status == KZ_OK ? ended : status);
  kz_work_end(&run.work);
  if (status == KZ_OK && !collective) status = kz_timing_note(run.ranks, run.n_unfinished, &watch, &run.work, &idle);
  kz_meter_end(&run.meter, status == KZ_OK, idle);
  KZ_TRY(status);
  return deliver_records(&run);
}
