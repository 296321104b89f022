/* Datasets written chunk by chunk, packed by kz_pack_into. */
#include "store.h"

static const hsize_t PLAIN_BYTES = 16384, CHUNK_BYTES = 1 << 20;

/* An array of one to three dimensions as sheets of rows and columns, and its chunks, which are one sheet thick. */
typedef struct {
  hsize_t sheets, rows, columns, chunk_rows, chunk_columns;
  size_t item;
  int rank;
} layout;

static layout layout_of(int rank, const hsize_t *lengths, const hsize_t *chunk, size_t item) {
  const bool flat = rank == 1;
  return (layout){.sheets = rank == 3 ? lengths[0] : 1,
                  .rows = flat ? 1 : lengths[rank - 2],
                  .columns = lengths[rank - 1],
                  .chunk_rows = flat ? 1 : chunk[rank - 2],
                  .chunk_columns = chunk[rank - 1],
                  .item = item,
                  .rank = rank};
}

kz_status kz_chunks_set(hid_t creation, int rank, const hsize_t *lengths, const hsize_t *chunk, size_t item) {
  hsize_t rows[KZ_MAX_DIMENSIONS], bytes = item;
  for (int d = 0; d < rank; ++d) bytes *= rows[d] = lengths[d];
  if (!chunk && bytes <= PLAIN_BYTES) return KZ_OK;
  bytes = item;
  for (int d = rank - 1; d >= 0; --d) {
    const hsize_t fit = bytes < CHUNK_BYTES ? CHUNK_BYTES / bytes : 1;
    if (rows[d] > fit) rows[d] = fit;
    if (d == rank - 3) rows[d] = 1;
    bytes *= rows[d];
  }
  KZ_HDF5(H5Pset_chunk(creation, rank, chunk ? chunk : rows));
  KZ_HDF5(H5Pset_shuffle(creation));
  KZ_HDF5(H5Pset_deflate(creation, KZ_PACK_LEVEL));
  return KZ_OK;
}

/* Gathers the items of the chunk that begins at (row, column); zeros beyond the array. */
static void gather_chunk(const layout *l, const char *data, hsize_t row, hsize_t column, char *chunk) {
  const hsize_t rows = l->rows - row < l->chunk_rows ? l->rows - row : l->chunk_rows;
  const hsize_t columns = l->columns - column < l->chunk_columns ? l->columns - column : l->chunk_columns;
  if (rows < l->chunk_rows || columns < l->chunk_columns) memset(chunk, 0, l->chunk_rows * l->chunk_columns * l->item);
  for (hsize_t r = 0; r < rows; ++r)
    memcpy(chunk + r * l->chunk_columns * l->item, data + ((row + r) * l->columns + column) * l->item,
           columns * l->item);
}

/* Writes all chunks. Numbers smaller than a double come in runs, as labels do. */
static kz_status write_chunks(hid_t dataset, const layout *l, const char *data) {
  const size_t items = l->chunk_rows * l->chunk_columns;
  char *chunk = kz_malloc(items * l->item), *packed = kz_malloc(kz_pack_bytes(items, l->item));
  kz_status status = KZ_OK;
  for (hsize_t sheet = 0; sheet < l->sheets; sheet++, data += l->rows * l->columns * l->item)
    for (hsize_t row = 0; row < l->rows; row += l->chunk_rows)
      for (hsize_t column = 0; status == KZ_OK && column < l->columns; column += l->chunk_columns) {
        const hsize_t offset[KZ_MAX_DIMENSIONS] = {sheet, row, column}, *place = offset + KZ_MAX_DIMENSIONS - l->rank;
        gather_chunk(l, data, row, column, chunk);
        const size_t bytes = kz_pack_into(chunk, items, l->item, l->item < sizeof(double), packed);
        status = bytes == 0 ? KZ_FAILED : KZ_HDF5_STATUS(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, place, bytes, packed));
      }
  free(packed);
  free(chunk);
  return status;
}

kz_status kz_chunks_write(hid_t dataset, hid_t type, int rank, const hsize_t *lengths, size_t item, const void *data) {
  hsize_t chunk[KZ_MAX_DIMENSIONS];
  hid_t creation;
  KZ_HDF5(creation = H5Dget_create_plist(dataset));
  const bool chunked = H5Pget_layout(creation) == H5D_CHUNKED && H5Pget_chunk(creation, rank, chunk) == rank;
  H5Pclose(creation);
  if (!chunked) return KZ_HDF5_STATUS(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  const layout l = layout_of(rank, lengths, chunk, item);
  return write_chunks(dataset, &l, data);
}
