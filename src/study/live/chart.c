/* A chart level by level, as frames are. */
#include <stdlib.h>
#include <string.h>

#include "chart/chart.h"
#include "kapitza/study_live.h"
#include "live.h"

enum { PENDING = 254 }; /* in place of a period */

typedef struct {
  const kz_scene *scene;
  kz_status (*pause)(void *context);
  void *context;
  int64_t rows, columns;
  uint8_t *period, *centre;             /* [rows][columns] of all points, */
  uint8_t *shown_period, *shown_centre; /* of a level */
  int64_t *pending;
} drawing;

static void chart_allocate(drawing *d) {
  const size_t n = (size_t)(d->rows * d->columns);
  d->period = kz_malloc(4 * n);
  d->pending = kz_malloc(n * sizeof *d->pending);
  d->centre = d->period + n;
  d->shown_period = d->centre + n;
  d->shown_centre = d->shown_period + n;
  memset(d->period, PENDING, n);
}

static int64_t point_of(const drawing *d, int64_t level, int64_t i, int64_t j) {
  return kz_level_place(level, i, d->rows) * d->columns + kz_level_place(level, j, d->columns);
}

static kz_status follow(drawing *d, int64_t n) {
  kz_chart_ending ending[KZ_CHART_POINTS];
  for (int64_t done = 0; done < n; done += KZ_CHART_POINTS) {
    const int64_t part = n - done < KZ_CHART_POINTS ? n - done : KZ_CHART_POINTS;
    KZ_TRY(d->pause(d->context));
    kz_chart_points(d->scene, 0, part, d->pending + done, ending);
    for (int64_t i = 0; i < part; i++) {
      d->period[d->pending[done + i]] = ending[i].period >= 0 ? (uint8_t)ending[i].period : KZ_NO_LABEL;
      d->centre[d->pending[done + i]] = (uint8_t)ending[i].centre;
    }
  }
  return KZ_OK;
}

/* Follows what is pending of a level, and gathers it. */
static kz_status draw(drawing *d, kz_chart_level *level) {
  int64_t n = 0;
  for (int64_t i = 0; i < level->rows; i++)
    for (int64_t j = 0; j < level->columns; j++) {
      const int64_t point = point_of(d, level->level, i, j);
      if (d->period[point] == PENDING) d->pending[n++] = point;
    }
  KZ_TRY(follow(d, n));
  for (int64_t i = 0; i < level->rows; i++)
    for (int64_t j = 0; j < level->columns; j++) {
      const int64_t point = point_of(d, level->level, i, j), at = i * level->columns + j;
      d->shown_period[at] = d->period[point];
      d->shown_centre[at] = d->centre[point];
    }
  return KZ_OK;
}

kz_status kz_chart_draw(const kz_scene *scene, const kz_integers *levels, kz_status (*pause)(void *context),
                        kz_status (*show)(void *context, const kz_chart_level *level), void *context) {
  drawing d = {.scene = scene,
               .pause = pause,
               .context = context,
               .rows = scene->chart.y.values.count,
               .columns = scene->chart.x.values.count};
  kz_status status = KZ_OK;
  chart_allocate(&d);
  for (int64_t i = 0; status == KZ_OK && i < levels->count; i++) {
    const int64_t step = levels->values[i];
    kz_chart_level level = {.level = step,
                            .rows = kz_level_size(step, d.rows),
                            .columns = kz_level_size(step, d.columns),
                            .period = d.shown_period,
                            .centre = d.shown_centre};
    status = draw(&d, &level);
    if (status == KZ_OK) status = show(context, &level);
  }
  free(d.period);
  free(d.pending);
  return status;
}
