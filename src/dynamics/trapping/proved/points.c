/* Single starts that are followed until the region holds them. */
#include <math.h>
#include <stdlib.h>

#include "proof.h"

enum { POOL = 2048 };              /* starts under way: many, so that those of a class of speeds fill the lanes */
static const double WIDEST = 0.03; /* of a set's sides: a wider one does not reach an attractor as a whole */
/* A precision is too coarse for sets whose longer side is shorter than this, rad. */
static const double SMALLEST[] = {[KZ_ENCLOSE_DOUBLES] = 1e-7, [KZ_ENCLOSE_PAIRS] = 1e-26};

typedef struct {
  int64_t n, next; /* starts; the next one to begin */
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

/* Fills the pool; starts inside the region are done. */
static void begin(const kz_proof *proof, pool *p) {
  for (; p->next < p->n && p->under_way < POOL; p->next++) {
    kz_enclosure *set = &p->set[p->under_way];
    *set = set_of(&p->start[p->next]);
    p->number[p->next] = kz_proof_holds(proof, set);
    if (p->number[p->next] != 0) continue;
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
  pool *p = kz_malloc(sizeof *p);
  p->n = n;
  p->next = p->under_way = 0;
  p->start = start;
  p->number = number;
  for (begin(proof, p); p->under_way > 0; begin(proof, p)) {
    advance(proof, p, precision);
    for (int32_t i = p->under_way - 1; i >= 0; i--) {
      if (!look(proof, p, i, most_periods)) continue;
      p->under_way--;
      p->of[i] = p->of[p->under_way];
      p->periods[i] = p->periods[p->under_way];
      p->set[i] = p->set[p->under_way];
    }
  }
  free(p);
}
