/* The images of a window in pieces of a few periods: each piece needs the one before, and is a stage of one tile. Together they are shown
 * as one. */
#include "reference.h"

#include <stdlib.h>
#include <string.h>

enum { PIECE = 8 }; /* periods */

/* A record. After it: the state of the orbit. */
typedef struct {
  kz_image image[PIECE];
  int64_t n;
  bool finished;
} piece;

typedef struct {
  kz_images *images;
  kz_dynamics *dynamics;
  int64_t max_periods;
} work;

static kz_status follow(void *context, int64_t tile, void *record) {
  const work *w = context;
  piece *p = record;
  const int64_t before = w->images->n;
  (void)tile;
  KZ_TRY(kz_images_follow(w->images, w->dynamics, PIECE, w->max_periods));
  p->n = w->images->n - before;
  p->finished = w->images->finished;
  memcpy(p->image, w->images->image + before + 1, (size_t)p->n * sizeof *p->image);
  kz_arbitrary_write(w->images->orbit, (char *)(p + 1));
  return KZ_OK;
}

static kz_status run_piece(const kz_run *run, const work *w, piece *record, size_t bytes) {
  const int64_t before = w->images->n;
  const kz_stage stage = {.name = "reference",
                          .n_tiles = 1,
                          .record_bytes = bytes,
                          .work = follow,
                          .context = (void *)w,
                          .keep = true,
                          .everywhere = true};
  KZ_TRY(kz_stage_run(run, &stage, record));
  kz_images_extend(w->images, before, record->n, record->image, record->finished);
  return kz_ranks_agree(run->ranks, kz_arbitrary_restore(w->images->orbit, (const char *)(record + 1)));
}

kz_status kz_images_run(const kz_run *run, kz_dynamics *dynamics, kz_images *images, int64_t max_periods) {
  const work w = {.images = images, .dynamics = dynamics, .max_periods = max_periods};
  kz_chain *chain = kz_chain_begin(run, "reference");
  const size_t bytes = sizeof(piece) + kz_arbitrary_size(images->orbit);
  piece *record = kz_malloc(bytes);
  kz_status status = KZ_OK;
  while (status == KZ_OK && !images->finished) {
    const double begun = kz_clock();
    status = run_piece(run, &w, record, bytes);
    kz_chain_show(chain, record->n > 0 ? (kz_clock() - begun) / (double)record->n * kz_images_left(images) : 0);
  }
  kz_chain_end(chain, status == KZ_OK);
  free(record);
  return status;
}
