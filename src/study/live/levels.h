/* The cells of a frame that a level shows: one for each multiple of the level. All cells of a level also belong to the finer levels. */
#ifndef KAPITZA_STUDY_LIVE_LEVELS_H
#define KAPITZA_STUDY_LIVE_LEVELS_H

#include <stdbool.h>
#include <stdint.h>

/* Number of cells of a level along an axis of `count` cells. */
static inline int64_t kz_level_size(int64_t level, int64_t count) {
  return (count + level - 1) / level;
}

/* Index of the i-th of them along the axis. */
static inline int64_t kz_level_place(int64_t level, int64_t i, int64_t count) {
  const int64_t at = level * i + (level == 8 ? 5 : level > 1);
  return at < count ? at : count - 1;
}

/* Lists the cells of a level that no level has followed: number [rows * columns] takes their numbers, theta fastest. A cell from `own` on is the
 * mirror image of an own one, which is listed in its place, once. listed [own]: cells that are listed, or were. Returns how many. */
int64_t kz_level_pending(int64_t level, int64_t rows, int64_t columns, int64_t own, bool *listed, int64_t *number);

#endif
