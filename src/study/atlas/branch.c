/* A branch of cycles as users see it: values of the key, a strobe point, multipliers. */
#include "cycles.h"
#include "branch.h"

kz_status kz_atlas_place(const kz_atlas *atlas, int axis, double value, double *place) {
  const kz_atlas_plan *plan = atlas->scene->atlas;
  const kz_plane_axis *of = kz_atlas_axis(atlas, axis) ? &plan->y : &plan->x;
  if (!(value >= of->values.min && value <= of->values.max))
    return kz_fail(KZ_REFUSED, "%c: %.10g lies outside of the atlas; %s is from %.10g to %.10g there", axis ? 'y' : 'x',
                   value, kz_sweep_parameter_at(of->parameter)->name, of->values.min, of->values.max);
  *place = (value - of->values.min) / (of->values.max - of->values.min);
  return KZ_OK;
}

/* Multipliers from the trace and determinant of the map; those of a half map are squared. */
void kz_atlas_multipliers(const kz_cycle *cycle, double re[2], double im[2]) {
  const double determinant = cycle->number[1], half = cycle->number[0] / 2, root = half * half - determinant;
  const double large = half + (half < 0 ? -1 : 1) * sqrt(fmax(root, 0)), imaginary = sqrt(fmax(-root, 0));
  const bool squared = cycle->kind.side < 0 && !cycle->kind.rest;
  for (int i = 0; i < 2; i++) {
    const double a = root < 0 || i == 0 ? large : determinant / large, b = i == 0 ? imaginary : -imaginary;
    re[i] = squared ? a * a - b * b : a;
    im[i] = squared ? 2 * a * b : b;
  }
}

/* The columns of a point of a branch. */
static void put_point(const kz_atlas *atlas, int axis, const kz_cycle *at, double multiplier, kz_atlas_branches *line) {
  double *to = line->point[line->n_points++], value[2], cosine = 0, point[2 * KZ_CURVE_POINTS][2];
  const int points = kz_atlas_points(atlas, at, point);
  kz_atlas_values(atlas->scene->atlas, at->place, value);
  for (int p = 0; p < points; p++) cosine += cos(point[p][0]);
  to[KZ_LINE_VALUE] = value[axis];
  to[KZ_LINE_HEIGHT] = -cosine / points;
  to[KZ_LINE_THETA] = remainder(at->point[0][0], 2 * M_PI);
  to[KZ_LINE_VELOCITY] = at->point[0][1];
  to[KZ_LINE_MULTIPLIER] = multiplier;
}

static double largest_multiplier(const kz_cycle *cycle) {
  double re[2], im[2];
  kz_atlas_multipliers(cycle, re, im);
  return fmax(hypot(re[0], im[0]), hypot(re[1], im[1]));
}

/* Whether an event, one with a multiplier of 1 or -1, lies between two rows: by trace and determinant of both. */
static bool lies_between(kz_event event, const double a[2], const double b[2]) {
  const double sign = event == KZ_EVENT_FOLD ? -1 : 1;
  return event <= KZ_EVENT_FLIP && (1 + a[1] + sign * a[0] > 0) != (1 + b[1] + sign * b[0] > 0);
}

void kz_atlas_draw(const kz_atlas *atlas, int axis, const kz_cycle *row, const kz_cycle *event,
                   const kz_branch_end *end, kz_atlas_branches *line) {
  if (end->rows < 2) return;
  const kz_atlas_class class = kz_atlas_class_of(&row->kind);
  const kz_cycle *last = event + end->events;
  kz_atlas_branch branch = {.of = kz_atlas_described(atlas, &class), .first = line->n_points};
  line->point = kz_realloc(line->point, (size_t)(line->n_points + end->rows + end->events) * sizeof *line->point);
  for (int64_t i = 0; i < end->rows; i++) {
    for (; i > 0 && event < last &&
           (event->event > KZ_EVENT_FLIP || lies_between(event->event, row[i - 1].number, row[i].number));
         event++)
      if (event->event <= KZ_EVENT_FLIP) put_point(atlas, axis, event, 1, line);
    put_point(atlas, axis, row + i, largest_multiplier(row + i), line);
  }
  branch.points = line->n_points - branch.first;
  line->branch = kz_list_reserve(line->branch, &line->capacity, line->count + 1, sizeof *line->branch);
  line->branch[line->count++] = branch;
}

void kz_atlas_branches_free(kz_atlas_branches *line) {
  free(line->branch);
  free(line->point);
  *line = (kz_atlas_branches){0};
}
