/* Ends of one start over a plane of two keys, raster by raster, as frames are, for pages that somebody looks at. */
#include "ends/ends.h"
#include "live.h"
#include "sweep/plan.h"

typedef struct {
  const kz_scene *scene;
  kz_status (*pause)(void *context);
  void *context;
  int64_t rows, columns, *pending;
  bool *listed;                         /* [rows][columns] points that a raster has followed, or is about to */
  uint8_t *period, *centre;             /* [rows][columns] ends of all points */
  uint8_t *shown_period, *shown_centre; /* planes of a raster */
} drawing;

static kz_status plane_follow(drawing *d, int64_t n) {
  kz_plane_ending ending[KZ_ENDS_POINTS];
  for (int64_t done = 0; done < n; done += KZ_ENDS_POINTS) {
    const int64_t part = n - done < KZ_ENDS_POINTS ? n - done : KZ_ENDS_POINTS;
    KZ_TRY(d->pause(d->context));
    kz_ends_points(d->scene, 0, part, d->pending + done, ending);
    for (int64_t i = 0; i < part; i++) {
      d->period[d->pending[done + i]] = ending[i].period >= 0 ? (uint8_t)ending[i].period : KZ_NO_LABEL;
      d->centre[d->pending[done + i]] = (uint8_t)ending[i].centre;
    }
  }
  return KZ_OK;
}

/* Follows what is pending of a raster, and gathers it. */
static kz_status plane_draw(drawing *d, const kz_plane_raster *raster) {
  KZ_TRY(plane_follow(
      d, kz_raster_pending(raster->coarseness, d->rows, d->columns, d->rows * d->columns, d->listed, d->pending)));
  for (int64_t i = 0; i < raster->rows; i++)
    for (int64_t j = 0; j < raster->columns; j++) {
      const int64_t at = i * raster->columns + j, point = kz_raster_place(raster->coarseness, i, d->rows) * d->columns +
                                                          kz_raster_place(raster->coarseness, j, d->columns);
      d->shown_period[at] = d->period[point];
      d->shown_centre[at] = d->centre[point];
    }
  return KZ_OK;
}

kz_status kz_plane_points(const kz_scene *scene, int64_t *points) {
  if (!kz_sweep_is_plane(scene->sweep)) return kz_fail(KZ_REFUSED, "sweep.x: a chart needs the axes x and y");
  *points = scene->sweep->x.values.count * scene->sweep->y.values.count;
  return KZ_OK;
}

kz_status kz_plane_draw(const kz_scene *scene, const kz_integers *coarseness, kz_status (*pause)(void *context),
                        kz_status (*show)(void *context, const kz_plane_raster *raster), void *context) {
  const int64_t rows = scene->sweep->y.values.count, columns = scene->sweep->x.values.count, n = rows * columns;
  KZ_TRY(kz_memory_ask("x", (size_t)n * (4 + sizeof(int64_t) + sizeof(bool))));
  KZ_AUTOFREE uint8_t *planes = kz_malloc(4 * (size_t)n);
  KZ_AUTOFREE int64_t *pending = kz_malloc((size_t)n * sizeof *pending);
  KZ_AUTOFREE bool *listed = kz_calloc((size_t)n, sizeof *listed);
  drawing d = {scene,  pause,  context,    rows,           columns,       pending,
               listed, planes, planes + n, planes + 2 * n, planes + 3 * n};
  for (int64_t i = 0; i < coarseness->count; i++) {
    const int64_t step = coarseness->values[i];
    const kz_plane_raster raster = {step, kz_raster_size(step, rows), kz_raster_size(step, columns), d.shown_period,
                                    d.shown_centre};
    KZ_TRY(plane_draw(&d, &raster));
    KZ_TRY(show(context, &raster));
  }
  return KZ_OK;
}
