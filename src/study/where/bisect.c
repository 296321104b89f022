/* Bisection in windows about the point found so far: each is as narrow as the last one could tell, some 1e20 times narrower, and its points
 * are handed over by its own reference orbit. */
#include "bisect.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "labelling/labeller.h"
#include "numerics/cells.h"
#include "window/images.h"

/* Those within fill the lanes of an orbit in quad precision. */
enum { POINTS = 9, MOST_WIDENINGS = 6 };
/* Shares of a window's width: how near the boundary is looked for in it, the next window's width in those of the bracket that is found, and
 * the width of one that missed it. */
static const double nearest = 1e-21, roomy = 4, wider = 100;

/* A piece of the line between the two starts: a window whose points have the same share along both axes. */
typedef struct {
  const kz_question *question;
  __float128 way[2]; /* from the first start to the second */
  double width;      /* share of the way */
  kz_axis axis[2];
  kz_images *images;
  kz_hand_over hand_over[KZ_LEVEL_ARBITRARY];
  __float128 share[POINTS];
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

/* Labels the points from the first to the last one, evenly spread; what quad precision leaves open stays so. */
static kz_status label_points(piece *p, int first, int last) {
  const kz_labeller labeller = {
      .dynamics = p->question->dynamics, .max_periods = p->question->max_periods, .start = start_point, .context = p};
  const __float128 from = p->share[0], step = (p->share[POINTS - 1] - from) / (POINTS - 1);
  int64_t item[POINTS];
  for (int i = first; i <= last; i++) {
    item[i] = i;
    if (i > 0 && i < POINTS - 1) p->share[i] = from + step * i;
  }
  return kz_label(&labeller, last - first + 1, item + first, p->decision + first);
}

/* The points i and i + 1 become the ends. */
static void close_in(piece *p, int i) {
  p->share[0] = p->share[i];
  p->decision[0] = p->decision[i];
  p->share[POINTS - 1] = p->share[i + 1];
  p->decision[POINTS - 1] = p->decision[i + 1];
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

/* Closes in on a change of the labels, as finely as the window tells or as is asked for; *found: whether there is one. Then it lies between the
 * ends. */
static kz_status search_piece(piece *p, double finest, bool *found) {
  *found = false;
  p->share[0] = -0.5;
  p->share[POINTS - 1] = 0.5;
  KZ_TRY(follow_piece(p));
  KZ_TRY(label_points(p, 0, POINTS - 1));
  for (int i = meeting(p); i >= 0; i = meeting(p)) {
    *found = true;
    close_in(p, i);
    if (!(p->share[POINTS - 1] - p->share[0] > finest)) break;
    KZ_TRY(label_points(p, 1, POINTS - 2));
  }
  return KZ_OK;
}

/* The window's centre moves by a share of its width. */
static kz_status move_centre(piece *p, __float128 share, int64_t digits) {
  const double part[2] = {(double)share, (double)(share - (double)share)};
  for (int i = 0; i < 4; i++) {
    const kz_coordinate moved = coordinate_of(p, i / 2, part[i % 2]);
    char text[KZ_DECIMAL_LENGTH];
    KZ_TRY(kz_coordinate_text(&moved, digits, text, sizeof text));
    strcpy(p->axis[i / 2].centre.text, text);
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

/* The next window: about the ends of the bracket that was found, or wider than the one that has missed the boundary. */
static kz_status go_on(piece *p, bool found, int64_t digits, kz_bisection *bisection) {
  const __float128 bracket = p->share[POINTS - 1] - p->share[0];
  if (!found) {
    p->width *= wider;
    return KZ_OK;
  }
  KZ_TRY(move_centre(p, p->share[0] + bracket / 2, digits));
  p->width *= roomy * (double)bracket;
  for (int side = 0; side < 2; side++) bisection->label[side] = p->decision[side * (POINTS - 1)].label;
  return KZ_OK;
}

static kz_status narrow(piece *p, int64_t digits, kz_bisection *bisection) {
  const double way = fmax(fabs((double)p->way[0]), fabs((double)p->way[1])), enough = pow(10, -(double)digits) / way;
  int widenings = 0;
  while (p->width > enough) {
    bool found;
    open_piece(p);
    const kz_status status = search_piece(p, fmax(nearest, enough / p->width / roomy), &found);
    kz_images_free(p->images);
    KZ_TRY(status);
    if (!found && ++widenings > MOST_WIDENINGS)
      return kz_fail(KZ_FAILED,
                     "--boundary: no start that settles was found on one side of theta = %.40s...; give other starts",
                     p->axis[0].centre.text);
    KZ_TRY(go_on(p, found, digits + 20, bisection));
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
