/* Windows of any depth: labels of cells that are handed over by one reference orbit, against each cell's own orbit in
 * as many digits as it takes; the catalogue is found as for a basin. KAPITZA_EXTENSIVE=1: more cells, and the deepest
 * windows. */
#include "../tools/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cells/scene_search.h"
#include "labelling/labeller.h"
#include "numerics/cells.h"
#include "window/window.h"
#include "scene/scene.h"
#include "kapitza/study_basin.h"

#define K01 "pendulum: {k: 0.1, damping: 0.1, m: 0.4}"
#define FIG12 "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}"
/* Beside a fold: a saddle is near the attractor. */
#define FOLD "pendulum: {k: 0.1, damping: 0.1, m: 0.39965146083203706}"
#define FOLD_BOUNDARY "-2.446848329686444"
#define K01_BOUNDARY "-2.36717282205514094284618936441679792892500699963420629501343"
#define K01_DEEP                                                       \
  "-2.367172822054595206197195965469343352456262073417327939174161857" \
  "7113814226078200050029132746710242054545163052171"
#define FIG12_BOUNDARY "-0.264011425069458192092654683104843683"

typedef struct {
  const char *pendulum, *theta, *velocity, *width;
  int cells;
} window;

/* A window with all that its labels need. */
typedef struct {
  kz_scene scene;
  kz_dynamics *dynamics;
  kz_images *images;
  kz_hand_over hand_over[KZ_LEVELS];
} view;

enum { COUNT = 1009 }; /* cells along an axis */

static void find_attractors(view *v) {
  const kz_search search = kz_search_of(&v->scene);
  assert_int_equal(kz_search_window(NULL, v->dynamics, &search, NULL), KZ_OK);
  kz_dynamics_update(v->dynamics);
}

static view open_view(const window *w) {
  char text[1000];
  view v;
  snprintf(
      text, sizeof text,
      "%s\nbasin:\n  theta: {centre: '%s', width: %s, count: %d}\n  velocity: {centre: '%s', width: %s, count: %d}\n"
      "  method: exact\n  attractors: {starts: 512}\n",
      w->pendulum, w->theta, w->width, COUNT, w->velocity, w->width, COUNT);
  if (kz_scene_read(text, strlen(text), "s.yaml", 0, NULL, &v.scene) != KZ_OK) fail_msg("%s", kz_message());
  const kz_basin_plan *plan = v.scene.basin;
  v.dynamics = kz_dynamics_create(&v.scene.parameters.pendulum, &v.scene.numerics, plan->max_period);
  find_attractors(&v);
  v.images = kz_images_create(v.dynamics, &v.scene.parameters.pendulum, &plan->theta, &plan->velocity);
  assert_int_equal(kz_images_follow(v.images, v.dynamics, plan->max_periods, plan->max_periods), KZ_OK);
  kz_hand_overs_make(v.images, 0.5, v.hand_over);
  return v;
}

static void close_view(view *v) {
  kz_images_free(v->images);
  kz_dynamics_free(v->dynamics);
  kz_scene_free(&v->scene);
}

static kz_status start_cell(void *context, int64_t cell, kz_precision level, kz_start *start) {
  const view *v = context;
  const kz_basin_plan *plan = v->scene.basin;
  kz_hand_over_start(&v->hand_over[level], kz_axis_share(&plan->theta, cell % COUNT),
                     kz_axis_share(&plan->velocity, cell / COUNT), start);
  return KZ_OK;
}

static void own_label(const view *v, int64_t cell, kz_decision *decision) {
  const kz_basin_plan *plan = v->scene.basin;
  const kz_coordinate start[2] = {kz_axis_coordinate(&plan->theta, cell % COUNT),
                                  kz_axis_coordinate(&plan->velocity, cell / COUNT)};
  assert_int_equal(kz_own_orbit_decide(v->dynamics, &v->scene.parameters.pendulum, start, plan->max_periods, decision),
                   KZ_OK);
  assert_int_not_equal(decision->end.label, KZ_DOUBTFUL);
}

/* Every cell is decided, and as its own orbit ends. The labels differ among the cells. */
static void depth_compare(const window *w) {
  enum { MOST = 64 };
  view v = open_view(w);
  int64_t item[MOST];
  kz_label label[MOST];
  kz_decision own;
  const kz_labeller labeller = {.dynamics = v.dynamics,
                                .max_periods = v.scene.basin->max_periods,
                                .way = KZ_BY_LEVELS,
                                .start = start_cell,
                                .context = &v};
  const int cells = getenv("KAPITZA_EXTENSIVE") ? 50 : w->cells;
  bool several = false;
  srand(3);
  for (int i = 0; i < MOST; i++) item[i] = (int64_t)(rand() % COUNT) * COUNT + rand() % COUNT;
  assert_int_equal(kz_label_items(&labeller, 1, MOST, item, label), KZ_OK);
  for (int i = 0; i < MOST; i++) several = several || label[i].label != label[0].label;
  for (int i = 0; i < cells; i++) {
    own_label(&v, item[i], &own);
    if (label[i].label != own.end.label || getenv("KZ_SHOW"))
      print_message("width %s cell %d: %d by evidence %d after %lld, own %d after %lld\n", w->width, i, label[i].label,
                    label[i].evidence, (long long)label[i].periods, own.end.label, (long long)own.end.periods);
    assert_true(label[i].label == own.end.label);
  }
  assert_true(several);
  close_view(&v);
}

TEST(labels_are_those_of_own_orbits) {
  static const window windows[] = {
      {K01, K01_BOUNDARY, "17", "1e-7", 6},        {K01, K01_BOUNDARY, "17", "1e-20", 6},
      {FIG12, FIG12_BOUNDARY, "1.42", "1e-12", 4}, {FIG12, FIG12_BOUNDARY, "1.42", "1e-25", 1},
      {K01, "180 deg", "0", "1e-12", 6},           {FOLD, FOLD_BOUNDARY, "-0.21806737647827037", "1e-14", 3},
  };
  static const window deep[] = {{K01, K01_DEEP, "17", "1e-50", 0}, {K01, K01_DEEP, "17", "1e-100", 0}};
  for (size_t i = 0; i < sizeof windows / sizeof *windows; i += getenv("KAPITZA_EXTENSIVE") ? 1 : 2)
    depth_compare(windows + i);
  for (size_t i = 0; getenv("KAPITZA_EXTENSIVE") && i < sizeof deep / sizeof *deep; i++) depth_compare(deep + i);
}

/* States of a cell and its sample, at most half a step and a tenth away; a step's image is `step` long. */
static void compare_samples(const kz_window_starts *starts, const kz_window_curve *curve) {
  const kz_labeller labeller = kz_window_labeller(starts, false);
  double cell[2], sample[2], next[2], farthest = 0;
  int64_t periods, same;
  kz_window_curve_state(curve, curve->count / 2, sample, &periods);
  kz_window_curve_state(curve, curve->count / 2 + 1, next, &periods);
  const double step = hypot(M_PI * (next[0] - sample[0]), next[1] - sample[1]);
  for (int i = 0; i < 2000; i++) {
    const int64_t at = (int64_t)(rand() % COUNT) * COUNT + rand() % COUNT, of = kz_window_curve_sample(curve, at);
    assert_true(of >= 0 && of < curve->count);
    assert_int_equal(kz_item_states(&labeller, 1, &at, cell, &periods), KZ_OK);
    kz_window_curve_state(curve, of, sample, &same);
    assert_int_equal(same, periods);
    farthest = fmax(farthest, hypot(M_PI * (cell[0] - sample[0]), cell[1] - sample[1]) / step);
  }
  assert_true(farthest > 0.4 && farthest < 0.7);
}

TEST(deep_windows_are_curves) {
  static const window deep = {K01, K01_BOUNDARY, "17", "1e-20", 0}, wide = {K01, K01_BOUNDARY, "17", "1e-4", 0};
  for (int i = 0; i < 2; i++) {
    view v = open_view(i == 0 ? &deep : &wide);
    kz_window_starts starts;
    kz_window_curve curve;
    kz_window_starts_make(v.scene.basin, &v.scene.parameters.pendulum, v.dynamics, v.images, &starts);
    kz_window_curve_make(&starts, &curve);
    assert_true(i == 0 ? curve.count > 16 * COUNT && curve.count <= 2 * 16 * COUNT + 3 : curve.count == 0);
    if (i == 0) compare_samples(&starts, &curve);
    kz_window_curve_free(&curve);
    kz_window_starts_free(&starts);
    close_view(&v);
  }
}

/* A window that the map folds: the first degree nearly vanishes, and the second shows that the fourth is not small. */
TEST(folded_images_hand_nothing_over) {
  kz_image image[] = {{.jet = {.linear = {{1e-20, 0}, {0, 1e-20}}}},
                      {.jet = {.linear = {{1e-8, 0}, {0, 1e-8}}}},
                      {.jet = {.linear = {{1e-9, 0}, {0, 1e-9}}, .higher_terms = {{[3] = 1e-17}}}}};
  const kz_images images = {.n = 2, .image = image};
  kz_hand_over hand_over[KZ_LEVELS];
  kz_hand_overs_make(&images, 0.5, hand_over);
  assert_int_equal(hand_over[0].periods, 2);
  image[2].jet.higher_terms[0][0] = 1e-6L;
  kz_hand_overs_make(&images, 0.5, hand_over);
  assert_int_equal(hand_over[0].periods, 1);
}
