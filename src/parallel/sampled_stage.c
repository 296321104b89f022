/* A stage of a sampled run. */
#include "sampled_stage.h"

#include <stdlib.h>
#include <string.h>

/* A first tile that takes so many times what the others do has set something up that they use. */
static const double SET_UP = 3;

/* Tile i of n in an order whose first tiles, however many, are spread over all. */
typedef struct {
  int64_t n, step;
} spread;

static int64_t common_divisor(int64_t a, int64_t b) {
  return b == 0 ? a : common_divisor(b, a % b);
}

static spread spread_of(int64_t n) {
  int64_t step = (int64_t)(0.6180339887 * (double)n) + 1;
  while (common_divisor(n, step) != 1) step++;
  return (spread){n, step};
}

static int64_t tile_at(const spread *s, int64_t i) {
  return (int64_t)((s->n / 2 + (__int128)i * s->step) % s->n);
}

/* Does a tile, and measures what it takes. */
static kz_status work_on(kz_sampling *s, const kz_stage *stage, int64_t tile, void *record, double *seconds) {
  const double before = kz_sampling_seconds(s);
  memset(record, 0, stage->record_bytes);
  KZ_TRY(kz_stage_work(stage, tile, record));
  *seconds = (kz_sampling_seconds(s) - before) / s->weight;
  return KZ_OK;
}

/* Records of tiles that are not done are copies of those that are; of a collective stage they stay 0. */
static void fill(const kz_stage *stage, const spread *order, int64_t done, char *records) {
  for (int64_t i = done; i < stage->n_tiles; i++) {
    char *record = records + (size_t)tile_at(order, i) * stage->record_bytes;
    if (stage->collective)
      memset(record, 0, stage->record_bytes);
    else
      memcpy(record, records + (size_t)tile_at(order, i % done) * stage->record_bytes, stage->record_bytes);
  }
}

/* What the tiles of a stage take: the first one, which may also set something up, and the others. */
typedef struct {
  int64_t done, others;
  double first, rest;
} times;

static kz_status do_some(kz_sampling *s, const kz_stage *stage, const spread *order, double until, char *records, times *t) {
  KZ_FREED char *own = stage->local ? kz_malloc(stage->record_bytes + 1) : NULL;
  while (t->done < stage->n_tiles && (t->done == 0 || kz_processor_clock() < until)) {
    const int64_t tile = tile_at(order, t->done);
    char *record = own ? own : records + (size_t)tile * stage->record_bytes;
    double seconds = 0;
    KZ_TRY(work_on(s, stage, tile, record, &seconds));
    if (own) kz_local_records_add(stage->local, tile, own, *(uint64_t *)(void *)own);
    *(t->done++ == 0 ? &t->first : &t->rest) += seconds;
  }
  t->others = t->done - 1;
  return KZ_OK;
}

/* A single tile that stands for more is done again, if it is short: only what it takes the second time is multiplied. */
static kz_status do_again(kz_sampling *s, const kz_stage *stage, const spread *order, double until, times *t) {
  if (t->others > 0 || kz_processor_clock() + t->first > until) return KZ_OK;
  KZ_FREED char *record = kz_malloc(stage->record_bytes + 1);
  KZ_TRY(work_on(s, stage, tile_at(order, 0), record, &t->rest));
  s->counted -= t->rest * s->weight;
  t->others = 1;
  return KZ_OK;
}

kz_status kz_stage_sample(kz_sampling *s, const kz_stage *stage, void *records) {
  const int64_t n = stage->n_tiles;
  const double outside = s->until;
  const kz_sampling_mark mark = kz_sampling_mark_now(&(kz_run){.sample = s});
  s->stands_for = 1;
  if (n == 0) return KZ_OK;
  if (kz_processor_clock() > s->last) return kz_fail(KZ_STOPPED, "the time for samples is over");
  const spread order = spread_of(n);
  times t = {0};
  if (!stage->whole) s->until = mark.until;
  kz_status status = do_some(s, stage, &order, stage->whole ? s->last : mark.until, records, &t);
  s->until = outside;
  KZ_TRY(status);
  if (stage->whole && t.done < n) return kz_fail(KZ_STOPPED, "the time for samples is over");
  s->stands_for = (double)n / (double)t.done;
  if (stage->local) stage->local->stands_for = s->stands_for;
  if (t.done == n && s->weight == 1) return KZ_OK;
  const double stands_for = s->stands_for;
  KZ_TRY(do_again(s, stage, &order, mark.until, &t));
  s->stands_for = stands_for;
  double one = t.others > 0 ? t.rest / (double)t.others : t.first;
  const double set_up = t.first > SET_UP * one ? t.first - one : 0;
  if (set_up == 0) one = (t.first + t.rest) / (double)(1 + t.others);
  s->counted += s->weight * one * (double)(n - t.done) - (s->weight - 1) * set_up;
  if (!stage->local) fill(stage, &order, t.done, records);
  return KZ_OK;
}
