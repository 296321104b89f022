/* Bisection in windows about the point found so far: each is 1e10 times narrower than the last one, and its cells are handed over by its
 * own reference orbit. */
#include "bisect.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "labelling/labeller.h"
#include "numerics/cells.h"
#include "window/images.h"

enum { POINTS = 17, MOST_WIDENINGS = 6 };
/* Shares of a window's width: how near the boundary is found in it, the next window's width, and that of one that missed it. */
static const double nearest = 1e-12, narrower = 1e-10, wider = 100;

/* A piece of the line between the two starts: a window whose points have the same share along both axes. */
typedef struct {
  const kz_question *question;
  __float128 way[2]; /* from the first start to the second */
  double width;      /* share of the way */
  kz_axis axis[2];
  kz_images *images;
  kz_hand_over hand_over[KZ_LEVEL_ARBITRARY];
  double share[POINTS];
  kz_decision decision[POINTS];
} piece;

static kz_status start_point(void *context, int64_t i, int32_t level, kz_start *start) {
  const piece *p = context;
  kz_hand_over_start(&p->hand_over[level < 0 ? KZ_LEVEL_DOUBLE : level], p->share[i], p->share[i], start);
  return KZ_OK;
}

static kz_coordinate coordinate_of(const piece *p, int axis, double share) {
  return (kz_coordinate){.centre = p->axis[axis].centre.text, .width = p->axis[axis].width.text, .share = share};
}

/* Labels POINTS points from one share to another; what quad precision leaves open stays so. */
static kz_status label_points(piece *p, double from, double to) {
  const kz_labeller labeller = {
      .dynamics = p->question->dynamics, .max_periods = p->question->max_periods, .start = start_point, .context = p};
  for (int i = 0; i < POINTS; i++) p->share[i] = from + (to - from) * i / (POINTS - 1);
  return kz_label(&labeller, POINTS, NULL, p->decision);
}

/* The pair of neighbours nearest to the middle of which both are decided, and differently: the number of the first; -1: none. */
static int meeting(const piece *p) {
  int found = -1;
  for (int i = 0; i + 1 < POINTS; i++) {
    const int32_t a = p->decision[i].label, b = p->decision[i + 1].label;
    if (a > 0 && b > 0 && a != b && (found < 0 || abs(2 * i + 2 - POINTS) < abs(2 * found + 2 - POINTS))) found = i;
  }
  return found;
}

static void open_piece(piece *p) {
  const kz_question *q = p->question;
  for (int i = 0; i < 2; i++)
    snprintf(p->axis[i].width.text, sizeof p->axis[i].width.text, "%.25Le", (long double)p->way[i] * p->width);
  p->images = kz_images_create(&q->scene->parameters.pendulum, &p->axis[0], &p->axis[1]);
}

static kz_status follow_piece(piece *p) {
  const kz_question *q = p->question;
  KZ_TRY(kz_images_follow(p->images, q->dynamics, q->max_periods + 1, q->max_periods));
  for (int32_t level = 0; level < KZ_LEVEL_ARBITRARY; level++) p->hand_over[level] = kz_hand_over_at(p->images, level, 0.5);
  return KZ_OK;
}

/* The share at which the labels change, as finely as the window tells; *found: whether they do. */
static kz_status search_piece(piece *p, double *share, bool *found, kz_bisection *bisection) {
  double from = -0.5, to = 0.5;
  *found = false;
  KZ_TRY(follow_piece(p));
  while (to - from > nearest) {
    KZ_TRY(label_points(p, from, to));
    const int i = meeting(p);
    if (i < 0) break;
    *found = true;
    from = p->share[i];
    to = p->share[i + 1];
    for (int side = 0; side < 2; side++) bisection->label[side] = p->decision[i + side].label;
  }
  *share = (from + to) / 2;
  return KZ_OK;
}

/* The window's centre moves by a share of its width. */
static kz_status move_centre(piece *p, double share, int64_t digits) {
  for (int i = 0; i < 2; i++) {
    const kz_coordinate moved = coordinate_of(p, i, share);
    char text[KZ_DECIMAL_LENGTH];
    KZ_TRY(kz_coordinate_text(&moved, digits, text, sizeof text));
    strcpy(p->axis[i].centre.text, text);
  }
  return KZ_OK;
}

static kz_status begin(piece *p, int64_t digits) {
  enum { MORE = 40 };
  for (int i = 0; i < 2; i++) {
    const kz_coordinate *first = &p->question->start[0][i], *second = &p->question->start[1][i];
    p->way[i] = kz_coordinate_difference(second, first, 4 * (digits + MORE));
    KZ_TRY(kz_coordinate_text(first, digits + MORE, p->axis[i].centre.text, sizeof p->axis[i].centre.text));
    snprintf(p->axis[i].width.text, sizeof p->axis[i].width.text, "%.25Le", (long double)p->way[i]);
  }
  return move_centre(p, 0.5, digits + MORE);
}

static kz_status narrow(piece *p, int64_t digits, kz_bisection *bisection) {
  const double way = fmax(fabs((double)p->way[0]), fabs((double)p->way[1]));
  int widenings = 0;
  while (way * p->width > pow(10, -(double)digits)) {
    double share;
    bool found;
    open_piece(p);
    const kz_status status = search_piece(p, &share, &found, bisection);
    kz_images_free(p->images);
    KZ_TRY(status);
    if (!found && ++widenings > MOST_WIDENINGS)
      return kz_fail(KZ_FAILED,
                     "--boundary: no start that settles was found on one side of theta = %.40s...; give other starts",
                     p->axis[0].centre.text);
    if (found) KZ_TRY(move_centre(p, share, digits + 20));
    p->width *= found ? narrower : wider;
  }
  return KZ_OK;
}

static kz_status round_to(const kz_axis *axis, int64_t digits, char *text) {
  const kz_coordinate centre = {.centre = axis->centre.text};
  return kz_coordinate_text(&centre, digits, text, KZ_DECIMAL_LENGTH);
}

kz_status kz_bisect(const kz_question *question, int64_t digits, kz_bisection *bisection) {
  piece p = {.question = question, .width = 1};
  KZ_TRY(begin(&p, digits));
  KZ_TRY(narrow(&p, digits, bisection));
  KZ_TRY(round_to(&p.axis[0], digits, bisection->theta));
  return round_to(&p.axis[1], digits, bisection->velocity);
}
