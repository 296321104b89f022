#include "deep.h"

#include "plan.h"

/* Largest number of cells of a window whose pending cells own orbits decide even if basin.undecided is flag. */
enum { MOST_DECIDED = 100000 };

typedef struct {
  bool decides;
  kz_images *images; /* for a window by centre and width with method exact; else NULL */
  kz_window_starts starts;
} deep;

static kz_status deep_make(const kz_scene *scene, void **own) {
  deep *d = kz_calloc(1, sizeof *d);
  d->decides = scene->deep->undecided == KZ_UNDECIDED_DECIDE;
  *own = d;
  return KZ_OK;
}

static void free_deep(void *own) {
  deep *d = own;
  kz_window_starts_free(&d->starts);
  kz_images_free(d->images);
  free(d);
}

static kz_status label_deep(void *own, kz_window_labels *l) {
  deep *d = own;
  if (kz_plan_is_centred(l->plan) && l->plan->method == KZ_METHOD_EXACT) {
    d->images = kz_images_create(l->dynamics, &l->parameters->pendulum, &l->plan->theta, &l->plan->velocity);
    KZ_TRY(kz_images_run(l->run, l->dynamics, d->images, l->plan->max_periods));
  }
  const bool decides = d->decides || (d->images && l->tiles.cells <= MOST_DECIDED);
  if (!d->images && !decides) return KZ_OK;
  kz_window_starts_make(l->plan, &l->parameters->pendulum, l->dynamics, d->images, &d->starts);
  l->labeller = kz_window_labeller(&d->starts, decides);
  return KZ_OK;
}

static void *starts_of(void *own, double reach) {
  const deep *d = own;
  if (!d->images) return NULL;
  kz_hand_over *hand_over = kz_malloc(KZ_LEVELS * sizeof *hand_over);
  kz_hand_overs_make(d->images, reach, hand_over);
  return hand_over;
}

static void start_at(const void *starts, kz_precision level, __float128 theta, __float128 velocity, kz_start *start) {
  kz_hand_over_start((const kz_hand_over *)starts + level, theta, velocity, start);
}

static const char *deep_advice(void *own) {
  if (((const deep *)own)->decides)
    return "the largest number of digits that was tried does not decide where they end.";
  return "their orbits need more than quad precision; basin.undecided: decide follows them further.";
}

const kz_basin_part kz_deep_part = {.make = deep_make,
                                    .free = free_deep,
                                    .label = label_deep,
                                    .starts = starts_of,
                                    .start_at = start_at,
                                    .advice = deep_advice};
