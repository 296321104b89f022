/* Which cells of a picture a level shows: those at a place beyond multiples of the level, or the last one. Cells of a level belong to all
 * finer ones. */
#ifndef KAPITZA_STUDY_LIVE_LEVELS_H
#define KAPITZA_STUDY_LIVE_LEVELS_H

#include <stdint.h>

/* Cells of a level along an axis of `count`. */
static inline int64_t kz_level_size(int64_t level, int64_t count) {
  return (count + level - 1) / level;
}

/* The i-th of them. */
static inline int64_t kz_level_place(int64_t level, int64_t i, int64_t count) {
  const int64_t at = level * i + (level == 8 ? 5 : level > 1);
  return at < count ? at : count - 1;
}

#endif
