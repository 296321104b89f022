/* From labels to the file: each rank turns its tiles, and those that mirror them, into ids, counts them and packs them;
 * rank 0 writes the chunks as they come. */
#include "basin.h"

enum { OTHER = 3, TURNS = 4, VARIABLES = 5 };
static const char *const variables[VARIABLES] = {"attractor", "settling_time", "evidence", "other_attractor", "turns"};
static const size_t items[VARIABLES] = {sizeof(int16_t), sizeof(uint32_t), sizeof(uint8_t), sizeof(int16_t),
                                        sizeof(int32_t)};

static bool has_variable(const kz_basin_plan *plan, int v) {
  return (v != OTHER || plan->method == KZ_METHOD_EXACT) && (v != TURNS || plan->turns);
}

/* A chunk of each variable, packed, and settling times as they are; a message has one or two of them. */
typedef struct {
  int64_t tile, transients;
  uint64_t bytes[VARIABLES];
} head;

static size_t bytes_of_messages(int64_t cells) {
  size_t buffer = sizeof(head) + (size_t)cells * KZ_TRANSIENT_BYTES;
  for (int v = 0; v < VARIABLES; v++) buffer += kz_pack_bytes((size_t)cells, items[v]);
  return 2 * buffer;
}

/* The cells of the tile in c->ids, c->evidence. */
static void chunks_count(kz_chunks *c, int64_t tile) {
  const kz_tiles *tiles = &c->labelling->tiles;
  const int64_t n = kz_tile_count(tiles, tile), rows = n / tiles->columns;
  for (int64_t i = 0; i < n; i++) {
    c->counts.evidence[c->evidence[i]]++;
    if (c->ids[i] < 0)
      c->counts.unsettled++;
    else
      c->cells_of[c->ids[i]]++;
  }
  if (!tiles->whole) return;
  kz_count_boxes(tiles->columns, rows, c->ids, &c->counts);
  kz_count_pairs(tiles->columns, rows, c->ids, kz_axis_is_circle(&c->labelling->plan->theta), &c->counts);
}

static kz_status chunks_pack(const kz_chunks *c, int64_t tile, char *message, size_t *bytes) {
  const kz_tiles *tiles = &c->labelling->tiles;
  const size_t n = (size_t)kz_tile_capacity(tiles);
  const void *const arrays[VARIABLES] = {c->ids, c->periods, c->evidence, c->others, c->turns};
  head h = {.tile = tile};
  char *end = message + *bytes + sizeof h;
  for (int v = 0; v < VARIABLES; v++) {
    if (!has_variable(c->labelling->plan, v)) continue;
    if ((h.bytes[v] = kz_pack_into(arrays[v], n, items[v], true, end)) == 0)
      return kz_fail(KZ_FAILED, "no memory to pack %zu cells", n);
    end += h.bytes[v];
  }
  h.transients = kz_transients_pick(c->labelling->plan, kz_tile_first(tiles, tile), kz_tile_count(tiles, tile), c->ids,
                                    c->periods, end);
  end += (size_t)h.transients * KZ_TRANSIENT_BYTES;
  memcpy(message + *bytes, &h, sizeof h);
  *bytes = (size_t)(end - message);
  return KZ_OK;
}

/* The id of a number of kz_dynamics, or of its mirror image; -1 of none. */
static int16_t id_of(const kz_chunks *c, int16_t label, bool mirrored) {
  const int32_t id = label > 0 ? c->catalogue->id_of[label] : -1;
  return (int16_t)(mirrored && id >= 0 ? c->catalogue->entries[id].mirror : id);
}

/* Own cells that the scene's own numerics do not decide. */
static void count_doubtful(kz_chunks *c, int64_t tile) {
  for (int64_t i = 0; i < kz_tile_own(&c->labelling->tiles, tile); i++)
    c->counts.doubtful +=
        c->labelling->cell[i].evidence >= KZ_UNDECIDED && c->labelling->cell[i].evidence != KZ_AVERAGED;
}

/* Cells of a tile or its mirror tile, from its own ones. The middle tile's second half mirrors the first. */
static void chunks_fill(kz_chunks *c, int64_t tile, bool image) {
  const kz_window_labels *l = c->labelling;
  const int64_t n = kz_tile_count(&l->tiles, tile), own = kz_tile_own(&l->tiles, tile);
  int16_t *ids = c->ids, *others = c->others;
  uint32_t *periods = c->periods;
  uint8_t *evidence = c->evidence;
  for (int64_t i = 0; i < n; i++) {
    const bool mirrored = image || i >= own;
    const kz_label *cell = &l->cell[mirrored ? n - 1 - i : i];
    const int16_t id = id_of(c, cell->label, mirrored);
    evidence[i] = kz_file_evidence(cell, id >= 0);
    ids[i] = id;
    others[i] = id_of(c, cell->other, mirrored);
    periods[i] = (uint32_t)cell->periods;
    c->turns[i] = id < 0 || cell->turns == KZ_NO_TURNS ? KZ_NO_TURNS : mirrored ? -cell->turns : cell->turns;
  }
}

/* Counts and packs a tile: the unpacked one, `from`, or its mirror image. */
static kz_status chunks_add(kz_chunks *c, int64_t from, int64_t tile, char *message, size_t *bytes) {
  chunks_fill(c, from, from != tile);
  chunks_count(c, tile);
  return chunks_pack(c, tile, message, bytes);
}

/* Replaces labels of a tile's own cells by those of parts; counts changed cells with their mirror images. */
static kz_status take_labels(kz_chunks *c, int64_t tile) {
  const kz_tiles *tiles = &c->labelling->tiles;
  const int64_t first = kz_tile_first(tiles, tile), n = kz_tile_own(tiles, tile);
  for (int p = 0; p < c->labelling->n_parts; p++) {
    const kz_part *part = c->labelling->parts + p;
    if (!part->part->take) continue;
    KZ_AUTOFREE kz_label *own = memcpy(kz_malloc((size_t)n * sizeof *own), c->labelling->cell, (size_t)n * sizeof *own);
    KZ_TRY(part->part->take(part->own, tile, c->labelling->cell));
    for (int64_t i = 0; i < n; i++) {
      kz_label *cell = c->labelling->cell + i;
      const bool differs = own[i].label != cell->label, was_open = own[i].evidence == KZ_UNDECIDED;
      if (differs || (was_open && cell->evidence != KZ_UNDECIDED)) cell->turns = KZ_NO_TURNS;
      if (differs && !was_open)
        c->counts.changed += tiles->unique_cells < tiles->cells && 2 * (first + i) + 1 < tiles->cells ? 2 : 1;
    }
  }
  return KZ_OK;
}

/* The labels of the sample's cells that lie in the tile. */
static void note_sample(kz_chunks *c, int64_t tile) {
  const kz_window_labels *l = c->labelling;
  const int64_t first = kz_tile_first(&l->tiles, tile), end = first + kz_tile_own(&l->tiles, tile);
  for (int64_t i = 0; c->sample && i < c->sample->n; i++)
    if (c->sample->cell[i] >= first && c->sample->cell[i] < end)
      c->sample->label[i] = l->cell[c->sample->cell[i] - first].label;
}

static kz_status chunks_make(void *context, const kz_local_record *piece, void *message, size_t *bytes) {
  kz_chunks *c = context;
  const kz_tiles *tiles = &c->labelling->tiles;
  const int64_t image = tiles->n - 1 - piece->tile;
  KZ_TRY(kz_tile_labels_unpack(c->labelling, piece));
  note_sample(c, piece->tile);
  count_doubtful(c, piece->tile);
  KZ_TRY(take_labels(c, piece->tile));
  *bytes = 0;
  KZ_TRY(chunks_add(c, piece->tile, piece->tile, message, bytes));
  return tiles->own == tiles->n || image == piece->tile ? KZ_OK : chunks_add(c, piece->tile, image, message, bytes);
}

static kz_status write_chunks(const kz_chunks *c, const head *h, const char *packed) {
  const kz_tiles *tiles = &c->labelling->tiles;
  const int64_t place[] = {h->tile / tiles->across * tiles->chunk[0], h->tile % tiles->across * tiles->chunk[1]};
  for (int v = 0; v < VARIABLES; packed += h->bytes[v++])
    if (has_variable(c->labelling->plan, v))
      KZ_TRY(kz_store_chunk(c->store, "basin", variables[v], place, packed, h->bytes[v]));
  return KZ_OK;
}

static kz_status chunks_take(void *context, const void *message, size_t bytes) {
  const kz_chunks *c = context;
  for (const char *at = message, *end = at + bytes; at < end;) {
    head h;
    memcpy(&h, at, sizeof h);
    KZ_TRY(write_chunks(c, &h, at + sizeof h));
    at += sizeof h;
    for (int v = 0; v < VARIABLES; v++) at += h.bytes[v];
    if (c->transients) kz_transients_add(c->transients, h.transients, at);
    at += (size_t)h.transients * KZ_TRANSIENT_BYTES;
  }
  return KZ_OK;
}

kz_status kz_chunks_declare(const kz_basin_plan *plan, const kz_tiles *tiles, kz_store *store) {
  for (int v = 0; v < VARIABLES; v++)
    if (has_variable(plan, v)) KZ_TRY(kz_store_chunked(store, "basin", variables[v], tiles->chunk));
  return plan->turns ? kz_store_missing(store, "basin", "turns", KZ_NO_TURNS) : KZ_OK;
}

/* Boxes and pairs that tiles cut: rank 0 reads whole rows back, as many as a tile has or a few more. */
static kz_status count_rows(kz_chunks *c) {
  const kz_tiles *tiles = &c->labelling->tiles;
  const int64_t most = (tiles->chunk[0] + KZ_BOX - 1) / KZ_BOX * KZ_BOX;
  KZ_AUTOFREE int16_t *ids = kz_malloc((size_t)(most * tiles->columns) * sizeof *ids);
  kz_status status = KZ_OK;
  for (int64_t row = 0; row < tiles->rows && status == KZ_OK; row += most) {
    const int64_t n = tiles->rows - row < most ? tiles->rows - row : most;
    if ((status = kz_store_rows(c->store, "basin", "attractor", row, n, ids)) != KZ_OK) break;
    kz_count_boxes(tiles->columns, n, ids, &c->counts);
    kz_count_pairs(tiles->columns, n, ids, kz_axis_is_circle(&c->labelling->plan->theta), &c->counts);
  }
  return status;
}

static kz_status chunks_deliver(kz_chunks *c) {
  kz_window_labels *l = c->labelling;
  const kz_delivery delivery = {.name = "file",
                                .message_bytes = bytes_of_messages(kz_tile_capacity(&l->tiles)),
                                .make = chunks_make,
                                .take = chunks_take,
                                .context = c};
  KZ_TRY(kz_local_records_deliver(l->run, &l->records, &delivery));
  KZ_TRY(kz_ranks_sum(l->run->ranks, (int64_t *)&c->counts, sizeof c->counts / sizeof(int64_t)));
  KZ_TRY(kz_ranks_sum(l->run->ranks, c->cells_of, c->catalogue->count));
  if (c->sample) KZ_TRY(kz_ranks_sum(l->run->ranks, c->sample->label, c->sample->n));
  for (int64_t i = 0; i < c->catalogue->count; i++)
    c->catalogue->entries[i].fraction = (double)c->cells_of[i] / (double)l->tiles.cells;
  return kz_ranks_agree(l->run->ranks, c->store && !l->tiles.whole ? count_rows(c) : KZ_OK);
}

kz_status kz_cells_write(kz_chunks *c) {
  const size_t n = (size_t)kz_tile_capacity(&c->labelling->tiles);
  KZ_AUTOFREE int16_t *ids = c->ids = kz_calloc(n + 1, sizeof *ids),
                      *others = c->others = kz_calloc(n + 1, sizeof *others);
  KZ_AUTOFREE uint32_t *periods = c->periods = kz_calloc(n + 1, sizeof *periods);
  KZ_AUTOFREE uint8_t *evidence = c->evidence = kz_calloc(n + 1, sizeof *evidence);
  KZ_AUTOFREE int32_t *turns = c->turns = kz_calloc(n + 1, sizeof *turns);
  KZ_AUTOFREE int64_t *cells_of = c->cells_of = kz_calloc((size_t)c->catalogue->count + 1, sizeof *cells_of);
  return chunks_deliver(c);
}
