/* A frame raster by raster, coarse ones first: pending cells are followed in tiles, then the raster is shown. */
#include "live.h"
#include "numerics/cells.h"

enum {
  MOST_STARTS = 64,        /* starts of the search among cells that do not settle */
  LABELS_BYTES = 16 << 20, /* memory in which starts are labelled */
};

typedef struct {
  kz_engine *engine;
  kz_prepared *prepared;
  const kz_scene *scene;
  const kz_frame *frame;
  kz_window_starts starts;
  kz_samples samples;          /* samples of a moving frame whose window is a curve */
  int64_t total, own;          /* cells; the first ones, of which the others are mirror images */
  kz_frame_cell *cell;         /* [total] */
  int64_t n_pending, *pending; /* [total] numbers of the cells that a raster follows */
  bool *listed;                /* [own] cells that a raster has followed, or is about to */
  void *buffer;                /* buffer of a raster's planes */
  bool searched;               /* attractors have been looked for among its cells */
  double begin;
} making;

size_t kz_plane_bytes(int plane) {
  return plane == KZ_PLANE_SETTLING_TIME || plane == KZ_PLANE_SMOOTH_TIME || plane == KZ_PLANE_TURNS ? sizeof(float)
                                                                                                     : 1;
}

/* Bytes of a cell in all planes of a frame. */
static size_t planes_bytes(const kz_frame *frame) {
  size_t bytes = 0;
  for (int plane = 0; plane < KZ_PLANES; plane++) bytes += frame->plane[plane] ? kz_plane_bytes(plane) : 0;
  return bytes;
}

/* Asks for the memory of a frame, and for that of its labels, which is about the same whatever its size. */
static kz_status ask_for_memory(const making *m) {
  const size_t cell = sizeof *m->cell + sizeof *m->pending + sizeof *m->listed + planes_bytes(m->frame);
  return kz_memory_ask("rows", (size_t)m->total * cell + LABELS_BYTES);
}

static void frame_allocate(making *m) {
  m->cell = kz_calloc((size_t)m->total, sizeof *m->cell);
  m->pending = kz_malloc((size_t)m->total * sizeof *m->pending);
  m->listed = kz_calloc((size_t)m->own, sizeof *m->listed);
  m->buffer = kz_malloc((size_t)m->total * planes_bytes(m->frame) + sizeof(float));
}

static kz_status frame_follow(making *m, int64_t n) {
  if (m->samples.curve.count > 0) return kz_samples_follow(m->prepared, m->frame, &m->samples, n, m->pending, m->cell);
  const kz_frame_task task = {m->prepared, &m->starts, m->frame, &m->engine->changing, n, m->pending, m->cell};
  return kz_frame_follow(&task);
}

static kz_status count_unsettled(void *context, int64_t *n) {
  making *m = context;
  int64_t left = 0;
  for (int64_t i = 0; i < m->n_pending; i++)
    if (m->cell[m->pending[i]].end.label == 0) m->pending[left++] = m->pending[i];
  *n = m->n_pending = left;
  return KZ_OK;
}

static kz_status frame_pick(void *context, int64_t all, int64_t n, int64_t *cell) {
  making *m = context;
  for (int64_t i = 0; i < n; i++) cell[i] = m->pending[kz_even_place(i, n, all)];
  m->searched = true;
  return KZ_OK;
}

static kz_status follow_again(void *context, int round) {
  making *m = context;
  (void)round;
  kz_engine_list(m->engine, m->prepared);
  return frame_follow(m, m->n_pending);
}

/* Follows n pending cells; where some do not settle, the attractors that they end on are looked for, once a frame. */
static kz_status frame_label(making *m, int64_t n) {
  const kz_unsettled unsettled = {count_unsettled, frame_pick, follow_again, m};
  const kz_search_on search = {1, MOST_STARTS, NULL};
  if (!m->prepared->dynamics) return KZ_OK;
  m->n_pending = n;
  KZ_TRY(frame_follow(m, n));
  if (m->searched || kz_prepared_moves(m->prepared)) return KZ_OK;
  const kz_labeller labeller = kz_window_labeller(&m->starts, false);
  return kz_search_rounds(&labeller, &search, &unsettled);
}

/* The id of an attractor, or of its mirror image. */
static uint8_t id_of(const making *m, int32_t number, bool mirrored) {
  const kz_catalogue *list = &m->prepared->catalogue.list;
  const int32_t id = number > 0 ? list->id_of[number] : KZ_NO_LABEL;
  return (uint8_t)(mirrored && id != KZ_NO_LABEL ? list->entries[id].mirror : id);
}

static uint8_t doubt_of(const kz_label *end) {
  return end->evidence == KZ_UNDECIDED ? KZ_DOUBT_OPEN : end->evidence == KZ_LEFT ? KZ_DOUBT_UNSEEN : KZ_DOUBT_NONE;
}

/* Writes a plane's value of a cell, or of its mirror image, to place `at`. */
static void frame_put(const making *m, int plane, const kz_frame_cell *cell, bool mirrored, int64_t at, void *values) {
  const kz_label *end = &cell->end;
  uint8_t *codes = values;
  float *numbers = values;
  if (plane == KZ_PLANE_LABELS)
    codes[at] = id_of(m, end->label, mirrored);
  else if (plane == KZ_PLANE_OTHER)
    codes[at] = id_of(m, end->other, mirrored);
  else if (plane == KZ_PLANE_DOUBT)
    codes[at] = doubt_of(end);
  else if (plane == KZ_PLANE_EVIDENCE)
    codes[at] = kz_file_evidence(end, end->label > 0);
  else if (end->label <= 0)
    numbers[at] = (float)NAN;
  else if (plane == KZ_PLANE_TURNS)
    numbers[at] = end->turns == KZ_NO_TURNS ? (float)NAN : (float)(mirrored ? -end->turns : end->turns);
  else
    numbers[at] = plane == KZ_PLANE_SETTLING_TIME ? (float)end->periods : cell->smooth;
}

/* A plane of a raster. */
static void frame_fill(const making *m, int64_t coarseness, int plane, void *values) {
  const int64_t columns = m->scene->basin->theta.count, rows = m->scene->basin->velocity.count;
  const int64_t across = kz_raster_size(coarseness, columns), up = kz_raster_size(coarseness, rows);
  for (int64_t i = 0; i < up; i++) {
    const int64_t row = kz_raster_place(coarseness, i, rows) * columns;
    for (int64_t j = 0; j < across; j++) {
      const int64_t f = row + kz_raster_place(coarseness, j, columns);
      const bool mirrored = f >= m->own;
      frame_put(m, plane, m->cell + (mirrored ? m->total - 1 - f : f), mirrored, i * across + j, values);
    }
  }
}

static kz_status frame_show(making *m, int64_t coarseness) {
  const int64_t columns = m->scene->basin->theta.count, rows = m->scene->basin->velocity.count;
  kz_live_raster shown = {.coarseness = coarseness,
                          .rows = kz_raster_size(coarseness, rows),
                          .columns = kz_raster_size(coarseness, columns),
                          .catalogue = &m->prepared->catalogue};
  size_t end = 0;
  static const int order[KZ_PLANES] = {/* floats first: aligned */ KZ_PLANE_SETTLING_TIME,
                                       KZ_PLANE_SMOOTH_TIME,
                                       KZ_PLANE_TURNS,
                                       KZ_PLANE_LABELS,
                                       KZ_PLANE_DOUBT,
                                       KZ_PLANE_OTHER,
                                       KZ_PLANE_EVIDENCE};
  for (int p = 0; p < KZ_PLANES; p++) {
    if (!m->frame->plane[order[p]]) continue;
    void *values = (char *)m->buffer + end;
    frame_fill(m, coarseness, order[p], values);
    shown.plane[order[p]] = values;
    end += (size_t)(shown.rows * shown.columns) * kz_plane_bytes(order[p]);
  }
  shown.seconds = kz_process_clock() - m->begin;
  return m->frame->show(m->frame->context, &shown);
}

static kz_status frame_make(making *m) {
  frame_allocate(m);
  if (m->prepared->dynamics) KZ_TRY(kz_cells_begin(m->prepared, m->scene->basin, m->frame, &m->starts));
  if (kz_prepared_moves(m->prepared) && m->prepared->dynamics) kz_samples_make(&m->starts, &m->samples);
  for (int64_t i = 0; i < m->frame->coarseness->count; i++) {
    const int64_t coarseness = m->frame->coarseness->values[i];
    KZ_TRY(frame_label(m, kz_raster_pending(coarseness, m->scene->basin->velocity.count, m->scene->basin->theta.count,
                                            m->own, m->listed, m->pending)));
    if (m->prepared->catalogue.list.count >= KZ_NO_LABEL)
      return kz_fail(KZ_REFUSED,
                     "basin.attractors.max_period: the pendulum has %lld attractors, but a frame holds at most %d; use "
                     "a smaller period",
                     (long long)m->prepared->catalogue.list.count, KZ_NO_LABEL - 1);
    KZ_TRY(frame_show(m, coarseness));
  }
  return KZ_OK;
}

kz_status kz_engine_frame(kz_engine *engine, const kz_scene *scene, const kz_frame *frame) {
  making m = {.engine = engine,
              .scene = scene,
              .frame = frame,
              .begin = kz_process_clock(),
              .total = scene->basin->theta.count * scene->basin->velocity.count,
              .own = kz_unique_cells(scene->basin)};
  KZ_TRY(ask_for_memory(&m));
  KZ_TRY(kz_engine_prepared(engine, scene, frame, &m.prepared));
  const bool was_busy = m.prepared->busy;
  m.prepared->busy = true;
  m.prepared->smooth = frame->plane[KZ_PLANE_SMOOTH_TIME];
  m.prepared->turns = frame->plane[KZ_PLANE_TURNS];
  const kz_status status = frame_make(&m);
  m.prepared->busy = was_busy;
  kz_samples_free(&m.samples);
  kz_window_starts_free(&m.starts);
  free(m.cell);
  free(m.pending);
  free(m.listed);
  free(m.buffer);
  return status;
}

double kz_frame_centre(const kz_axis *axis, int64_t i) {
  return kz_axis_centre(axis, i);
}
