/* The raster of an atlas: the list of attractors of every cell, and the regions with one list. */
#include "lines.h"
#include "cycles.h"
#include "regions.h"

static int compare_classes(const void *first, const void *second) {
  const kz_atlas_class *a = first, *b = second;
  if (a->symmetric != b->symmetric) return b->symmetric - a->symmetric;
  return a->period != b->period ? a->period - b->period : a->turns - b->turns;
}

double kz_atlas_middle(int64_t i, int64_t points) {
  return ((double)i + 0.5) / (double)points;
}

void kz_atlas_order(kz_atlas *atlas) {
  kz_atlas_class *reference = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *reference);
  int32_t *counts = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    const kz_cycle_kind child = kz_child_kind(&atlas->curve[i].kind);
    const kz_atlas_class own = kz_atlas_class_of(&atlas->curve[i].kind), grown = kz_atlas_class_of(&child);
    kz_atlas_class_number(atlas, &own);
    if (atlas->curve[i].kind.multiplier < 0 && kz_kind_period(&child) <= atlas->scene->atlas->max_period)
      kz_atlas_class_number(atlas, &grown);
  }
  const int64_t columns = atlas->undriven ? atlas->scene->atlas->points : 0;
  for (int64_t i = 0; i < columns; i++)
    kz_atlas_base(atlas, kz_atlas_middle(i, columns), counts); /* rest, which no curve need bound */
  memcpy(reference, atlas->class, sizeof atlas->class);
  memcpy(counts, atlas->at_reference, sizeof atlas->at_reference);
  qsort(atlas->class, (size_t)atlas->n_classes, sizeof *atlas->class, compare_classes);
  for (int32_t i = 0; i < atlas->n_classes; i++)
    atlas->at_reference[kz_atlas_class_number(atlas, reference + i)] = counts[i];
  free(reference);
  free(counts);
}

int64_t kz_atlas_fill_column(kz_atlas *atlas, int64_t column, kz_atlas_raster *raster) {
  const int64_t n = atlas->scene->atlas->points;
  const double x = kz_atlas_column(atlas, kz_atlas_middle(column, n));
  KZ_AUTOFREE_BY(kz_atlas_crossings_free) kz_atlas_crossings crossings = {0};
  KZ_AUTOFREE int32_t *counts = kz_malloc(KZ_ATLAS_MOST_CLASSES * sizeof *counts);
  kz_atlas_base(atlas, x, counts);
  kz_atlas_crossings_of(atlas, 0, x, true, &crossings);
  double from = kz_atlas_floor(atlas);
  int64_t negative = 0;
  for (int64_t row = 0; row < n; row++) {
    int total = 0;
    kz_atlas_changes(&crossings, from, kz_atlas_middle(row, n), counts);
    from = kz_atlas_middle(row, n);
    const bool known = kz_atlas_plausible(atlas, counts);
    negative += !known;
    for (int64_t c = 0; raster && c < raster->n_classes; c++) {
      raster->attracting[(c * n + row) * n + column] = (uint8_t)(known ? counts[c] : KZ_ATLAS_NOT_KNOWN);
      total += counts[c] * kz_atlas_images(atlas, atlas->class + c);
    }
    if (raster) raster->count[row * n + column] = (int16_t)(known ? total : -1);
  }
  return negative;
}

/* ---- lists: cells with equal counts have one number ---- */

static bool is_equal(const kz_atlas_raster *r, int64_t a, int64_t b) {
  for (int64_t c = 0; c < r->n_classes; c++)
    if (r->attracting[c * r->points * r->points + a] != r->attracting[c * r->points * r->points + b]) return false;
  return true;
}

static uint64_t hash_of(const kz_atlas_raster *r, int64_t cell) {
  uint64_t hash = 1469598103934665603u;
  for (int64_t c = 0; c < r->n_classes; c++)
    hash = (hash ^ r->attracting[c * r->points * r->points + cell]) * 1099511628211u;
  return hash;
}

static void number_lists(kz_atlas_raster *r) {
  enum { SLOTS = 1 << 16 };
  const int64_t cells = r->points * r->points;
  KZ_AUTOFREE int64_t *slot = kz_malloc(SLOTS * sizeof *slot);
  for (int i = 0; i < SLOTS; i++) slot[i] = -1;
  for (int64_t cell = 0; cell < cells; cell++) {
    r->list[cell] = -1;
    if (r->count[cell] < 0) continue;
    uint64_t place = hash_of(r, cell) % SLOTS;
    for (int tried = 0; tried < SLOTS && slot[place] >= 0 && !is_equal(r, slot[place], cell); tried++)
      place = (place + 1) % SLOTS;
    if (slot[place] < 0) {
      slot[place] = cell;
      r->list[cell] = (int32_t)r->lists++;
    } else {
      r->list[cell] = r->list[slot[place]];
    }
  }
}

/* ---- regions ---- */

/* Twice the distance of each cell from the edge of its region, in cells: by two passes over neighbours. */
static int32_t *regions_distances(const kz_atlas_raster *r) {
  const int64_t n = r->points;
  static const int step[4][3] = {{-1, 0, 2}, {0, -1, 2}, {-1, -1, 3}, {1, -1, 3}};
  int32_t *d = kz_malloc((size_t)(n * n) * sizeof *d);
  for (int64_t i = 0; i < n * n; i++) d[i] = 1 << 20;
  for (int pass = 0; pass < 2; pass++)
    for (int64_t i = 0; i < n * n; i++) {
      const int64_t cell = pass ? n * n - 1 - i : i, x = cell % n, y = cell / n;
      for (int s = 0; s < 4; s++) {
        const int64_t u = x + (pass ? -step[s][0] : step[s][0]), v = y + (pass ? -step[s][1] : step[s][1]);
        const bool there = u >= 0 && v >= 0 && u < n && v < n && r->list[v * n + u] == r->list[cell];
        const int32_t through = (there ? d[v * n + u] : 0) + (there ? step[s][2] : step[s][2] - 1);
        if (through < d[cell]) d[cell] = through;
      }
    }
  return d;
}

/* The connected cells of a list from one cell on; they lose their mark. */
static kz_atlas_region regions_grow(const kz_atlas_raster *r, const int32_t *distance, uint8_t *free_cell,
                                    int64_t first, int64_t *stack) {
  const int64_t n = r->points;
  kz_atlas_region region = {.cell = first};
  int64_t top = 0;
  stack[top++] = first;
  free_cell[first] = 0;
  while (top > 0) {
    const int64_t cell = stack[--top], x = cell % n, y = cell / n;
    const int64_t next[4] = {x > 0 ? cell - 1 : -1, x < n - 1 ? cell + 1 : -1, y > 0 ? cell - n : -1,
                             y < n - 1 ? cell + n : -1};
    region.cells++;
    if (distance[cell] > distance[region.cell] || (distance[cell] == distance[region.cell] && cell < region.cell))
      region.cell = cell;
    for (int i = 0; i < 4; i++) {
      if (next[i] < 0 || !free_cell[next[i]] || r->list[next[i]] != r->list[first]) continue;
      free_cell[next[i]] = 0;
      stack[top++] = next[i];
    }
  }
  region.radius = 0.5 * distance[region.cell];
  return region;
}

static void find_regions(kz_atlas_raster *r) {
  const size_t cells = (size_t)(r->points * r->points);
  KZ_AUTOFREE int32_t *distance = regions_distances(r);
  KZ_AUTOFREE uint8_t *free_cell = kz_malloc(cells);
  KZ_AUTOFREE int64_t *stack = kz_malloc(cells * sizeof *stack);
  memset(free_cell, 1, cells);
  for (int64_t cell = 0; cell < (int64_t)cells; cell++) {
    if (!free_cell[cell] || r->list[cell] < 0) continue;
    const kz_atlas_region region = regions_grow(r, distance, free_cell, cell, stack);
    int64_t place = r->n_regions < KZ_ATLAS_REGIONS ? r->n_regions++ : KZ_ATLAS_REGIONS;
    for (; place > 0 && r->region[place - 1].cells < region.cells; place--)
      if (place < KZ_ATLAS_REGIONS) r->region[place] = r->region[place - 1];
    if (place < KZ_ATLAS_REGIONS) r->region[place] = region;
  }
}

void kz_atlas_region_place(const kz_atlas_raster *raster, int64_t region, double place[2]) {
  const int64_t cell = raster->region[region].cell;
  place[0] = kz_atlas_middle(cell % raster->points, raster->points);
  place[1] = kz_atlas_middle(cell / raster->points, raster->points);
}

void kz_atlas_raster_make(kz_atlas *atlas, kz_atlas_raster *raster) {
  const int64_t n = atlas->scene->atlas->points;
  *raster = (kz_atlas_raster){.points = n, .n_classes = atlas->n_classes};
  raster->attracting = kz_calloc((size_t)(n * n * atlas->n_classes) + 1, 1);
  raster->count = kz_calloc((size_t)(n * n), sizeof *raster->count);
  raster->list = kz_calloc((size_t)(n * n), sizeof *raster->list);
  for (int64_t column = 0; column < n; column++) raster->negative += kz_atlas_fill_column(atlas, column, raster);
  number_lists(raster);
  find_regions(raster);
}

void kz_atlas_raster_free(kz_atlas_raster *raster) {
  free(raster->attracting);
  free(raster->count);
  free(raster->list);
  free(raster->hits);
  free(raster->other);
}
