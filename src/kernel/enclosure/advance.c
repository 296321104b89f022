/* Advances sets through drive periods: sets of one class of speeds together, each in a lane of its own, so that its
 * result does not depend on the others. A set too fast for its class begins the period again in the next class. */
#include "sets.h"

enum { GROUP = KZ_PARTS * LANES, MOST_CLASSES = 64, BATCH = 4096 };
static const double FIRST_SPEED = 0.7,
                    SPEED_RATIO = 1.3; /* Speed of the first class, rad per drive radian; ratio of classes */

typedef struct {
  kz_sets sets[KZ_PARTS];
} group;

kz_status kz_enclosure_tables_create(const kz_pendulum *pendulum, int32_t precision, double fastest,
                                     kz_enclosure_tables **tables) {
  *tables = NULL;
  kz_enclosure_tables *created = *tables = kz_calloc(1, sizeof *created + MOST_CLASSES * sizeof *created->classes);
  created->precision = precision;
  created->speed_margin = 1.1 * fabs(pendulum->m) + 2 * fabs(pendulum->k) + 0.03;
  if (!kz_is_sine(pendulum)) created->speed_margin = 1.5 * kz_stiffness(pendulum) + 0.03;
  for (double speed = fmin(FIRST_SPEED, fastest); created->n_classes < MOST_CLASSES;
       speed = fmin(speed * SPEED_RATIO, fastest)) {
    kz_speed_class *next = kz_speed_class_create(pendulum, precision, speed, 0);
    if (!next) break;
    created->classes[created->n_classes++] = next;
    if (speed >= fastest) return KZ_OK;
  }
  kz_enclosure_tables_free(created);
  *tables = NULL;
  return KZ_REFUSED;
}

void kz_enclosure_tables_free(kz_enclosure_tables *tables) {
  for (int32_t c = 0; tables && c < tables->n_classes; c++) free(tables->classes[c]);
  free(tables);
}

static void get_set(const kz_sets *x, int lane, kz_enclosure *set) {
  for (int i = 0; i < KZ_SET_NUMBERS; i++) ((double *)set)[i] = ((const vector *)x)[i][lane];
}

static void mark_lost(kz_enclosure *set) {
  set->reach[0] = set->reach[1] = INFINITY;
}

static bool is_lost(const kz_enclosure *set) {
  return !isfinite(set->reach[0] + set->reach[1]);
}

/* The step of the centres, and the function that removes their whole turns. */
typedef struct {
  kz_centres_step *step;
  void (*wrap)(kz_sets *);
} arithmetic;
static const arithmetic arithmetic_of[KZ_ENCLOSURES] = {
    [KZ_ENCLOSE_DOUBLES] = {kz_centres_step_doubles, kz_sets_wrap},
    [KZ_ENCLOSE_PAIRS] = {kz_centres_step_pairs, kz_sets_wrap},
    [KZ_ENCLOSE_TRIPLES] = {kz_centres_step_triples, kz_sets_wrap_triples}};

static void advance_group(const kz_enclosure_tables *tables, const kz_speed_class *speed, kz_enclosure_frame frame,
                          group *g) {
  const bool jacobian = frame == KZ_KEEP_FRAME;
  kz_circle circle[KZ_PARTS];
  const arithmetic *centres = &arithmetic_of[tables->precision];
  const int n_circle = jacobian ? KZ_ORDER_JACOBIAN : KZ_ORDER_TANGENT;
  for (int p = 0; p < KZ_PARTS && tables->precision < KZ_ENCLOSE_TRIPLES; p++) {
    kz_sets_check(speed, &g->sets[p]);
    kz_sets_drop_rest(&g->sets[p]);
  }
  for (int32_t i = 0; i < speed->n_steps; i++) {
    for (int p = 0; p < KZ_PARTS; p++) kz_sets_check(speed, &g->sets[p]);
    centres->step(speed, i, g->sets, n_circle, circle);
    for (int p = 0; p < KZ_PARTS; p++) {
      kz_neighbours_step(speed, i, &circle[p], jacobian, &g->sets[p]);
      if (!jacobian && (i + 1) % speed->frame_steps == 0 && i + 1 < speed->n_steps) kz_sets_renew_frame(&g->sets[p]);
    }
  }
  for (int p = 0; p < KZ_PARTS; p++) {
    kz_sets_check(speed, &g->sets[p]);
    centres->wrap(&g->sets[p]);
    if (!jacobian) kz_sets_renew_frame(&g->sets[p]);
  }
}

/* Advances n <= GROUP sets [of]; idle lanes copy the first, and are lost. A set that is too fast stays as it is, and
 * `of` names it afterwards; returns the number of these. */
static int advance_lanes(const kz_enclosure_tables *tables, const kz_speed_class *speed, kz_enclosure_frame frame,
                         int n, int32_t *of, kz_enclosure *set) {
  group g = {0};
  int n_again = 0;
  for (int lane = 0; lane < GROUP; lane++) put_set(&set[of[lane < n ? lane : 0]], lane % LANES, &g.sets[lane / LANES]);
  for (int lane = n; lane < GROUP; lane++) g.sets[lane / LANES].lost[lane % LANES] = -1;
  advance_group(tables, speed, frame, &g);
  for (int lane = 0; lane < n; lane++) {
    const kz_sets *x = &g.sets[lane / LANES];
    kz_enclosure *to = &set[of[lane]];
    if (x->too_fast[lane % LANES]) {
      of[n_again++] = of[lane];
      continue;
    }
    get_set(x, lane % LANES, to);
    if (x->lost[lane % LANES]) mark_lost(to);
  }
  return n_again;
}

/* Removes whole turns from a set whose angle is larger than (B3) assumes. */
static void wrap_far_set(int32_t precision, kz_enclosure *set) {
  kz_sets x = {.lost = {0}};
  if (fabs(set->theta[0]) < 4 || is_lost(set)) return;
  for (int lane = 0; lane < LANES; lane++) put_set(set, lane, &x);
  arithmetic_of[precision].wrap(&x);
  get_set(&x, 0, set);
  if (x.lost[0]) mark_lost(set);
}

/* Advances n <= BATCH sets. */
static void advance_batch(const kz_enclosure_tables *tables, kz_enclosure_frame frame, int32_t n, kz_enclosure *set) {
  for (int32_t i = 0; i < n; i++) wrap_far_set(tables->precision, &set[i]);
  int32_t waiting[BATCH + GROUP], n_waiting = 0;
  int8_t first_class[BATCH];
  for (int32_t i = 0; i < n; i++) {
    int c = 0;
    const double needed = fabs(set[i].velocity[0]) + tables->speed_margin;
    while (c + 1 < tables->n_classes && !(needed <= tables->classes[c]->fastest)) c++;
    first_class[i] = (int8_t)c;
  }
  for (int32_t c = 0; c < tables->n_classes; c++) {
    for (int32_t i = 0; i < n; i++)
      if (first_class[i] == c && !is_lost(&set[i])) waiting[n_waiting++] = i;
    int32_t n_again = 0;
    for (int32_t i = 0; i < n_waiting; i += GROUP) {
      int32_t *of = waiting + i;
      const int left =
          advance_lanes(tables, tables->classes[c], frame, n_waiting - i < GROUP ? n_waiting - i : GROUP, of, set);
      for (int j = 0; j < left; j++) waiting[n_again++] = of[j];
    }
    n_waiting = n_again;
  }
  for (int32_t i = 0; i < n_waiting; i++) mark_lost(&set[waiting[i]]);
}

void kz_enclosures_advance(const kz_enclosure_tables *tables, kz_enclosure_frame frame, int64_t n, kz_enclosure *set) {
  for (int64_t i = 0; i < n; i += BATCH)
    advance_batch(tables, frame, (int32_t)(n - i < BATCH ? n - i : BATCH), set + i);
}
