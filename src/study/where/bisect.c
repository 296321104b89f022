/* Bisection to any number of digits. The labels of a piece of the line between the two starts locate the boundary to
 * some sixteen digits of the piece, because they are found in quad precision. Further digits come from a smaller piece
 * about the boundary, whose orbit begins at a later image of the first one, and so on. From period 0 on, the program
 * follows a new orbit only when the number of digits has grown by about a half. */
#include "where.h"

#include "window/window.h"

/* The points between the ends fill the lanes of an orbit in quad precision. */
enum { POINTS = 9, MOST_WIDENINGS = 6, WIDENING = 7, MOST_PARTS = 256 };
/* Shares of a piece's width: how near the boundary is looked for by its labels, and the next piece's width in those of
 * the bracket that is found. */
static const double nearest = 1e-21, roomy = 4;

/* Place of the boundary and its bracket, in widths of the largest piece; labels on both sides. */
typedef struct {
  double part[MOST_PARTS], bracket; /* the place is the sum of the parts */
  int n;
  int32_t label[2];
} spot;

/* A piece of the line, with points on it. */
typedef struct {
  const kz_question *question;
  kz_images *images;
  kz_hand_over hand_over[KZ_LEVELS];
  __float128 share[POINTS];
  kz_label end[POINTS];
} piece;

static kz_status start_point(void *context, int64_t i, kz_precision level, kz_start *start) {
  const piece *p = context;
  kz_hand_over_start(&p->hand_over[level], p->share[i], 0, start);
  return KZ_OK;
}

/* Labels the points from the first to the last one, evenly spread; what quad precision leaves open stays so. */
static kz_status label_points(piece *p, int first, int last) {
  const kz_labeller labeller = {.dynamics = p->question->dynamics,
                                .max_periods = p->question->max_periods,
                                .way = KZ_BY_LEVELS,
                                .start = start_point,
                                .context = p};
  const __float128 from = p->share[0], step = (p->share[POINTS - 1] - from) / (POINTS - 1);
  int64_t item[POINTS];
  for (int i = first; i <= last; i++) {
    item[i] = i;
    if (i > 0 && i < POINTS - 1) p->share[i] = from + step * i;
  }
  return kz_label_items(&labeller, 1, last - first + 1, item + first, p->end + first);
}

/* The points i and i + 1 become the ends. */
static void close_in(piece *p, int i) {
  p->share[0] = p->share[i];
  p->end[0] = p->end[i];
  p->share[POINTS - 1] = p->share[i + 1];
  p->end[POINTS - 1] = p->end[i + 1];
}

/* Periods until the points i and i + 1 have settled, if both are decided, and differently; else INT64_MAX. */
static int64_t periods_of(const piece *p, int i) {
  const kz_label *a = p->end + i, *b = a + 1;
  if (a->label <= 0 || b->label <= 0 || a->label == b->label) return INT64_MAX;
  return kz_larger(a->periods, b->periods);
}

/* The neighbours between which the labels change: those that settle soonest, because the boundary between them takes
 * the shortest orbit, and of these the ones nearest to the middle. The number of the first; -1: none. */
static int bisect_meeting(const piece *p) {
  int found = -1;
  int64_t fewest = INT64_MAX;
  for (int j = 0; j + 1 < POINTS; j++) {
    const int i = (POINTS - 1) / 2 + (j % 2 ? -(j + 1) / 2 : j / 2); /* from the middle on */
    const int64_t periods = periods_of(p, i);
    if (periods >= fewest) continue;
    fewest = periods;
    found = i;
  }
  return found;
}

static kz_status follow_piece(piece *p) {
  const kz_question *q = p->question;
  KZ_TRY(kz_images_follow(p->images, q->dynamics, q->max_periods + 1, q->max_periods));
  kz_hand_overs_make(p->images, 0.5, p->hand_over);
  return KZ_OK;
}

/* Closes in on a change of the labels, as finely as the piece allows, or to `finest`; *found: whether there is one.
 * Then it lies between the ends. */
static kz_status search_piece(piece *p, double finest, bool *found) {
  *found = false;
  p->share[0] = -0.5;
  p->share[POINTS - 1] = 0.5;
  KZ_TRY(follow_piece(p));
  KZ_TRY(label_points(p, 0, POINTS - 1));
  for (int i = bisect_meeting(p); i >= 0; i = bisect_meeting(p)) {
    *found = true;
    close_in(p, i);
    if (!(p->share[POINTS - 1] - p->share[0] > finest)) break;
    KZ_TRY(label_points(p, 1, POINTS - 2));
  }
  return KZ_OK;
}

static kz_status bisect_lost(const kz_question *q) {
  return kz_fail(
      KZ_REFUSED,
      "--boundary: beside the boundary no starts on both sides settle within %lld periods (max_periods of the scene); "
      "allow more periods, or give other starts",
      (long long)q->max_periods);
}

/* Notes where the boundary lies in a piece whose width is 2^exponent of the largest one's. */
static kz_status bisect_note(const piece *p, int exponent, spot *s) {
  const __float128 middle = (p->share[0] + p->share[POINTS - 1]) / 2;
  if (s->n + 2 > MOST_PARTS) return bisect_lost(p->question);
  s->part[s->n++] = ldexp((double)middle, exponent);
  s->part[s->n++] = ldexp((double)(middle - (double)middle), exponent);
  s->bracket = ldexp((double)(p->share[POINTS - 1] - p->share[0]), exponent);
  for (int side = 0; side < 2; side++) s->label[side] = p->end[side * (POINTS - 1)].label;
  return KZ_OK;
}

static int64_t digits_of(double share) {
  return (int64_t)ceil(-log10(share));
}

static kz_status bisect_narrow(piece *p, int exponent, double finest, spot *s, bool *found);

/* Goes on in a smaller piece about the bracket of this one. A piece without a boundary is made wider. */
static kz_status narrow_within(const piece *p, int exponent, double finest, spot *s) {
  const __float128 middle = (p->share[0] + p->share[POINTS - 1]) / 2;
  int narrower = ilogb(roomy * (double)(p->share[POINTS - 1] - p->share[0])) + 1;
  for (int widenings = 0; widenings <= MOST_WIDENINGS; widenings++, narrower += WIDENING) {
    const double finer = ldexp(finest, -narrower);
    piece smaller = {.question = p->question,
                     .images = kz_images_beside(p->images, middle, narrower, digits_of(finer))};
    bool found;
    const kz_status status = bisect_narrow(&smaller, exponent + narrower, finer, s, &found);
    kz_images_free(smaller.images);
    if (status != KZ_OK || found) return status;
  }
  return bisect_lost(p->question);
}

/* Finds the boundary in a piece to `finest` of its width. */
static kz_status bisect_narrow(piece *p, int exponent, double finest, spot *s, bool *found) {
  KZ_TRY(search_piece(p, fmax(nearest, finest), found));
  if (!*found) return KZ_OK;
  KZ_TRY(bisect_note(p, exponent, s));
  return ldexp(s->bracket, -exponent) > finest ? narrow_within(p, exponent, finest, s) : KZ_OK;
}

/* The line: the middle of the present piece, and its width, the way from its first point to its last one. */
typedef struct {
  kz_decimal point[2], width[2];
} line;

enum { MORE_DIGITS = 20 }; /* Digits of the line beyond those that are asked for */

/* to = from + share * width, with so many digits behind the point; from "" = 0. `to` may be either of them. */
static kz_status bisect_add(const kz_decimal *from, const kz_decimal *width, double share, int64_t digits,
                            kz_decimal *to) {
  const kz_coordinate sum = {.centre = from->text[0] ? from->text : NULL, .width = width->text, .share = share};
  char text[KZ_DECIMAL_LENGTH];
  KZ_TRY(kz_coordinate_text(&sum, digits + MORE_DIGITS, text, sizeof text));
  strcpy(to->text, text);
  return KZ_OK;
}

static kz_status bisect_begin(const kz_question *q, int64_t digits, line *l) {
  for (int i = 0; i < 2; i++) {
    const kz_coordinate *first = &q->start[0][i], *second = &q->start[1][i];
    const __float128 way = kz_coordinate_difference(second, first, 4 * (digits + MORE_DIGITS));
    const kz_coordinate width = {.high = (double)way, .low = (double)(way - (double)way)};
    KZ_TRY(kz_coordinate_text(first, digits + MORE_DIGITS, l->point[i].text, sizeof l->point[i].text));
    KZ_TRY(kz_coordinate_text(&width, digits + MORE_DIGITS, l->width[i].text, sizeof l->width[i].text));
    KZ_TRY(bisect_add(&l->point[i], &l->width[i], 0.5, digits, &l->point[i]));
  }
  return KZ_OK;
}

/* The piece becomes that about the boundary, `narrower` times its width. */
static kz_status follow_line(line *l, const spot *s, double narrower, int64_t digits) {
  static const kz_decimal zero = {.text = ""};
  for (int axis = 0; axis < 2; axis++) {
    for (int i = 0; i < s->n; i++)
      KZ_TRY(bisect_add(&l->point[axis], &l->width[axis], s->part[i], digits, &l->point[axis]));
    KZ_TRY(bisect_add(&zero, &l->width[axis], narrower, digits, &l->width[axis]));
  }
  return KZ_OK;
}

/* The longer side of the piece, rad or rad per drive radian. */
static long double size_of(const line *l) {
  return fmaxl(fabsl(strtold(l->width[0].text, NULL)), fabsl(strtold(l->width[1].text, NULL)));
}

/* Share of a piece's width to which its boundary is sought: smaller in a narrow piece, whose orbit is longer. */
static double finest_share(long double width) {
  static const long double first = 1e-16L, last = 1e-250L, growth = 0.6L; /* last: far above the smallest doubles */
  return (double)fmaxl(last, fminl(first, powl(width, growth)));
}

static kz_status narrow_line(const kz_question *q, const line *l, double finest, spot *s, bool *found) {
  const kz_coordinate point[2] = {{.centre = l->point[0].text, .width = l->width[0].text},
                                  {.centre = l->point[1].text, .width = l->width[1].text}};
  piece p = {.question = q,
             .images = kz_images_on_line(q->dynamics, &q->scene->parameters.pendulum, point, digits_of(finest))};
  const kz_status status = bisect_narrow(&p, 0, finest, s, found);
  kz_images_free(p.images);
  return status;
}

static kz_status narrow_all(const kz_question *q, line *l, int64_t digits, kz_bisection *bisection) {
  const long double whole = size_of(l), enough = powl(10, -(long double)digits);
  for (int widenings = 0; size_of(l) > enough;) {
    const long double size = size_of(l);
    spot s = {.n = 0};
    bool found;
    KZ_TRY(narrow_line(q, l, fmax(finest_share(size / whole), (double)(enough / size) / roomy), &s, &found));
    if (!found && ++widenings > MOST_WIDENINGS) return bisect_lost(q);
    if (found) memcpy(bisection->label, s.label, sizeof s.label);
    KZ_TRY(follow_line(l, &s, found ? roomy * s.bracket : ldexp(1, WIDENING), digits));
  }
  return KZ_OK;
}

static kz_status round_to(const kz_decimal *point, int64_t digits, char *text) {
  const kz_coordinate coordinate = {.centre = point->text};
  return kz_coordinate_text(&coordinate, digits, text, KZ_DECIMAL_LENGTH);
}

kz_status kz_bisect(const kz_question *question, int64_t digits, kz_bisection *bisection) {
  line l;
  KZ_TRY(bisect_begin(question, digits, &l));
  KZ_TRY(narrow_all(question, &l, digits, bisection));
  KZ_TRY(round_to(&l.point[0], digits, bisection->theta));
  return round_to(&l.point[1], digits, bisection->velocity);
}
