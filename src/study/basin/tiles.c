#include "label.h"

enum { MOST_CELLS = 1 << 19 }; /* Cells of a tile: few MB */

/* Length of the pieces of an axis: a multiple of `unit`, at most `target` or little more, and never more than `most`;
 * `divides`: without rest. 0 where there is none. */
static int64_t tiles_piece(int64_t count, int64_t unit, int64_t target, int64_t most, bool divides) {
  int64_t best = 0;
  for (int64_t length = unit; length <= kz_smaller(count, most); length += unit) {
    if (divides && count % length != 0) continue;
    if (length > target && best > 0 && 4 * best >= target) break;
    best = length;
    if (length > target) break;
  }
  return best;
}

static void tiles_choose(kz_tiles *tiles, int64_t target, int64_t most, bool mirrored) {
  int64_t *rows = &tiles->chunk[0], *columns = &tiles->chunk[1];
  *rows = tiles->rows;
  *columns = tiles->columns;
  if (tiles->columns <= target && tiles->rows <= target / tiles->columns) return;
  *rows = tiles_piece(tiles->rows, KZ_BOX, target / tiles->columns, most / tiles->columns, mirrored);
  if (*rows == 0) *rows = tiles_piece(tiles->rows, 1, target / tiles->columns, most / tiles->columns, mirrored);
  if (*rows > 0) return;
  *rows = 1;
  *columns = tiles_piece(tiles->columns, 1, target, most, mirrored);
}

kz_tiles kz_tiles_of(const kz_scene *scene, int64_t target) {
  const kz_basin_plan *plan = scene->basin;
  kz_tiles tiles = {.rows = plan->velocity.count, .columns = plan->theta.count, .unique_cells = kz_unique_cells(plan)};
  tiles.cells = tiles.rows * tiles.columns;
  const int64_t enough = kz_tile_cells(scene, MOST_CELLS); /* as if no motion settled; nearly all settle long before */
  const bool mirrored = tiles.unique_cells < tiles.cells;
  tiles_choose(&tiles, kz_smaller(target, enough), kz_smaller(64 * enough, MOST_CELLS), mirrored);
  tiles.across = (tiles.columns + tiles.chunk[1] - 1) / tiles.chunk[1];
  tiles.n = tiles.across * ((tiles.rows + tiles.chunk[0] - 1) / tiles.chunk[0]);
  tiles.own = mirrored ? (tiles.n + 1) / 2 : tiles.n;
  tiles.whole = tiles.across == 1 && (tiles.chunk[0] % KZ_BOX == 0 || tiles.chunk[0] == tiles.rows);
  return tiles;
}

int64_t kz_tile_first(const kz_tiles *tiles, int64_t tile) {
  return tile / tiles->across * tiles->chunk[0] * tiles->columns + tile % tiles->across * tiles->chunk[1];
}

int64_t kz_tile_count(const kz_tiles *tiles, int64_t tile) {
  const int64_t row = tile / tiles->across * tiles->chunk[0], column = tile % tiles->across * tiles->chunk[1];
  return kz_smaller(tiles->chunk[0], tiles->rows - row) * kz_smaller(tiles->chunk[1], tiles->columns - column);
}

int64_t kz_tile_own(const kz_tiles *tiles, int64_t tile) {
  return kz_smaller(kz_tile_count(tiles, tile), tiles->unique_cells - kz_tile_first(tiles, tile));
}

int64_t kz_tile_capacity(const kz_tiles *tiles) {
  return tiles->chunk[0] * tiles->chunk[1];
}
