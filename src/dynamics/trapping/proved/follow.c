/* Sets that are followed, period by period, until the region of one attractor holds them: single starts, and cells. */
#include "proof.h"

/* Starts and cells under way: many, so that those of a class of speeds fill the lanes; periods of a cell. */
enum { POOL = 2048, CELLS = 256, CELL_PERIODS = 16 };
/* Largest side of a set: a wider start does not reach an attractor as a whole, and no larger cell gets small again. */
static const double WIDEST = 0.03, LARGEST = 0.5;
/* A precision is too coarse for sets whose longer side is shorter than this, rad. */
static const double SMALLEST[] = {[KZ_ENCLOSE_DOUBLES] = 1e-7, [KZ_ENCLOSE_PAIRS] = 1e-26};

/* Items 0 .. n - 1 to be followed. */
typedef struct {
  const kz_proof *proof;
  const kz_proof_start *start; /* NULL: items are cells, from cell `first` on */
  int64_t first, n, most_periods;
  double widest;
  uint8_t *number, late; /* number [n]: results; late: that after most_periods */
  int32_t finest, places;
} items;

/* The sets of those under way. */
typedef struct {
  items by;
  int64_t next; /* item to begin next */
  int32_t under_way;
  kz_enclosure set[POOL];
  int64_t of[POOL], periods[POOL];
} pool;

static kz_enclosure set_of(const kz_proof_start *start) {
  return (kz_enclosure){.theta = {start->theta[0], start->theta[1], 0},
                        .velocity = {start->velocity[0], start->velocity[1], 0},
                        .matrix = {{1, 0}, {0, 1}},
                        .reach = {start->radius, start->radius}};
}

/* A cell, larger by more than the rounding of its corners. */
static kz_enclosure set_of_cell(const kz_proof *proof, int64_t f) {
  double half[2], centre[2];
  kz_proof_half_cell(proof, half);
  kz_proof_centre(proof, f, centre);
  const double larger = 1 + KZ_PROOF_ROUNDING;
  return (kz_enclosure){.theta = {centre[0]},
                        .velocity = {centre[1]},
                        .matrix = {{1, 0}, {0, 1}},
                        .reach = {half[0] * larger, half[1] * larger}};
}

/* Result for an item that is known before it is followed. An angle far from the circle is not compared with the region:
 * a period takes its whole turns out. */
static uint8_t follow_known(const items *by, int64_t item, kz_enclosure *set) {
  if (!by->start) {
    const uint8_t label = by->proof->label[by->first + item];
    if (label == 0) *set = set_of_cell(by->proof, by->first + item);
    return label;
  }
  *set = set_of(&by->start[item]);
  return fabs(set->theta[0]) < 4 ? kz_proof_holds(by->proof, set) : 0;
}

static void follow_begin(pool *p) {
  for (; p->next < p->by.n && p->under_way < p->by.places; p->next++) {
    p->by.number[p->next] = follow_known(&p->by, p->next, &p->set[p->under_way]);
    if (p->by.number[p->next] != 0) continue;
    p->of[p->under_way] = p->next;
    p->periods[p->under_way++] = 0;
  }
}

/* The precision that a set takes: the errors of a period are small beside the set. */
static int32_t precision_for(const kz_enclosure *set, int32_t finest) {
  const double size = fmax(set->reach[0], set->reach[1]);
  int32_t precision = KZ_ENCLOSE_DOUBLES;
  while (precision < finest && size < SMALLEST[precision]) precision++;
  return precision;
}

static void follow_swap(pool *p, int32_t i, int32_t j) {
  const kz_enclosure set = p->set[i];
  const int64_t of = p->of[i], periods = p->periods[i];
  p->set[i] = p->set[j];
  p->of[i] = p->of[j];
  p->periods[i] = p->periods[j];
  p->set[j] = set;
  p->of[j] = of;
  p->periods[j] = periods;
}

/* A period of all sets; those of one precision are brought together. */
static void follow_advance(pool *p) {
  int32_t from = 0;
  for (int32_t precision = KZ_ENCLOSE_DOUBLES; precision <= p->by.finest; precision++) {
    int32_t to = from;
    for (int32_t i = from; i < p->under_way; i++)
      if (precision_for(&p->set[i], p->by.finest) == precision) follow_swap(p, i, to++);
    kz_enclosures_advance(p->by.proof->tables[precision], KZ_NEW_FRAME, to - from, p->set + from);
    from = to;
  }
}

/* Whether the item at place i of the pool is done. */
static bool is_done(pool *p, int32_t i) {
  const kz_enclosure *set = &p->set[i];
  uint8_t *number = &p->by.number[p->of[i]];
  if (!(set->reach[0] < p->by.widest && set->reach[1] < p->by.widest)) return true;
  *number = kz_proof_holds(p->by.proof, set);
  if (*number != 0) return true;
  if (++p->periods[i] < p->by.most_periods) return false;
  *number = p->by.late;
  return true;
}

static void follow_items(items by) {
  pool *p = kz_malloc(sizeof *p);
  p->by = by;
  p->next = p->under_way = 0;
  for (follow_begin(p); p->under_way > 0; follow_begin(p)) {
    follow_advance(p);
    for (int32_t i = p->under_way - 1; i >= 0; i--)
      if (is_done(p, i)) follow_swap(p, i, --p->under_way);
  }
  free(p);
}

void kz_proof_follow(const kz_proof *proof, int32_t precision, int64_t n, const kz_proof_start *start,
                     int64_t most_periods, uint8_t *number) {
  follow_items((items){.proof = proof,
                       .start = start,
                       .n = n,
                       .most_periods = most_periods,
                       .widest = WIDEST,
                       .number = number,
                       .late = KZ_PROOF_LATE,
                       .finest = precision,
                       .places = POOL});
}

void kz_proof_cells(const kz_proof *proof, int64_t first, int64_t n, uint8_t *label) {
  follow_items((items){.proof = proof,
                       .first = first,
                       .n = n,
                       .most_periods = CELL_PERIODS,
                       .widest = LARGEST,
                       .number = label,
                       .finest = KZ_ENCLOSE_DOUBLES,
                       .places = CELLS});
}
