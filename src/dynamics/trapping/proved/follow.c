/* Sets that are followed, period by period, until the region of one attractor holds them: single starts, and cells. */
#include <math.h>
#include <stdlib.h>

#include "proof.h"

enum { POOL = 2048 };              /* starts under way: many, so that those of a class of speeds fill the lanes */
static const double WIDEST = 0.03; /* of a set's sides: a wider one does not reach an attractor as a whole */
/* A precision is too coarse for sets whose longer side is shorter than this, rad. */
static const double SMALLEST[] = {[KZ_ENCLOSE_DOUBLES] = 1e-7, [KZ_ENCLOSE_PAIRS] = 1e-26};

typedef struct {
  int64_t n, next; /* starts or cells; the next one to begin */
  const kz_proof_start *start;
  uint8_t *number;
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

static pool *new_pool(int64_t n, uint8_t *number) {
  pool *p = kz_malloc(sizeof *p);
  p->n = n;
  p->number = number;
  p->next = p->under_way = 0;
  return p;
}

static void add_set(pool *p, kz_enclosure set, int64_t of) {
  p->set[p->under_way] = set;
  p->of[p->under_way] = of;
  p->periods[p->under_way++] = 0;
}

static void remove_set(pool *p, int32_t i) {
  p->under_way--;
  p->of[i] = p->of[p->under_way];
  p->periods[i] = p->periods[p->under_way];
  p->set[i] = p->set[p->under_way];
}

/* Whether an angle is near enough to be compared with the region; a period takes its whole turns out. */
static bool is_near(const kz_enclosure *set) {
  return fabs(set->theta[0]) < 4;
}

/* Fills the pool; starts inside the region are done. */
static void begin(const kz_proof *proof, pool *p) {
  for (; p->next < p->n && p->under_way < POOL; p->next++) {
    const kz_enclosure set = set_of(&p->start[p->next]);
    p->number[p->next] = is_near(&set) ? kz_proof_holds(proof, &set) : 0;
    if (p->number[p->next] == 0) add_set(p, set, p->next);
  }
}

/* The precision that a set takes: the errors of a period are small beside the set. */
static int32_t precision_for(const kz_enclosure *set, int32_t finest) {
  const double size = fmax(set->reach[0], set->reach[1]);
  int32_t precision = KZ_ENCLOSE_DOUBLES;
  while (precision < finest && size < SMALLEST[precision]) precision++;
  return precision;
}

static void swap(pool *p, int32_t i, int32_t j) {
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
static void advance(const kz_proof *proof, pool *p, int32_t finest) {
  int32_t from = 0;
  for (int32_t precision = KZ_ENCLOSE_DOUBLES; precision <= finest; precision++) {
    int32_t to = from;
    for (int32_t i = from; i < p->under_way; i++)
      if (precision_for(&p->set[i], finest) == precision) swap(p, i, to++);
    kz_enclosures_advance(proof->tables[precision], KZ_NEW_FRAME, to - from, p->set + from);
    from = to;
  }
}

/* Whether the start at place i of the pool is done. */
static bool look(const kz_proof *proof, pool *p, int32_t i, int64_t most_periods) {
  const kz_enclosure *set = &p->set[i];
  uint8_t *number = &p->number[p->of[i]];
  if (!(set->reach[0] < WIDEST && set->reach[1] < WIDEST)) return true;
  *number = kz_proof_holds(proof, set);
  if (*number == 0 && ++p->periods[i] == most_periods) *number = KZ_PROOF_LATE;
  return *number != 0;
}

void kz_proof_follow(const kz_proof *proof, int32_t precision, int64_t n, const kz_proof_start *start, int64_t most_periods,
                     uint8_t *number) {
  pool *p = new_pool(n, number);
  p->start = start;
  for (begin(proof, p); p->under_way > 0; begin(proof, p)) {
    advance(proof, p, precision);
    for (int32_t i = p->under_way - 1; i >= 0; i--)
      if (look(proof, p, i, most_periods)) remove_set(p, i);
  }
  free(p);
}

/* ---- cells ---- */

enum { LANES = 256, MOST_PERIODS = 16 };
static const double LARGEST = 0.5; /* of a cell's image, rad and rad per drive radian: no larger one gets small again */

/* A cell, larger by more than the rounding of its corners. */
static kz_enclosure set_of_cell(const kz_proof *proof, int64_t f) {
  double half[2], centre[2];
  kz_proof_half_cell(proof, half);
  kz_proof_centre(proof, f, centre);
  const double larger = 1 + KZ_PROOF_ROUNDING;
  return (kz_enclosure){
      .theta = {centre[0]}, .velocity = {centre[1]}, .matrix = {{1, 0}, {0, 1}}, .reach = {half[0] * larger, half[1] * larger}};
}

/* Cell i of the pool after one more period: its attractor, 0 = none yet; *over: it is not followed any further. */
static uint8_t look_at_cell(const kz_proof *proof, pool *p, int32_t i, bool *over) {
  *over = true;
  if (!(p->set[i].reach[0] < LARGEST && p->set[i].reach[1] < LARGEST)) return 0;
  const uint8_t found = kz_proof_holds(proof, &p->set[i]);
  *over = found != 0 || ++p->periods[i] == MOST_PERIODS;
  return found;
}

void kz_proof_cells(const kz_proof *proof, int64_t first, int64_t n, uint8_t *label) {
  pool *p = new_pool(n, label);
  while (p->next < n || p->under_way > 0) {
    for (; p->next < n && p->under_way < LANES; p->next++) {
      label[p->next] = proof->label[first + p->next];
      if (label[p->next] == 0) add_set(p, set_of_cell(proof, first + p->next), p->next);
    }
    kz_enclosures_advance(proof->tables[KZ_ENCLOSE_DOUBLES], KZ_NEW_FRAME, p->under_way, p->set);
    for (int32_t i = p->under_way - 1; i >= 0; i--) {
      bool over;
      label[p->of[i]] = look_at_cell(proof, p, i, &over);
      if (over) remove_set(p, i);
    }
  }
  free(p);
}
