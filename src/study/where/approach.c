/* Time from which a motion stays within one degree of its attractor at the strobes. */
#include "kapitza/dynamics_live.h"
#include <float.h>

#include "where.h"

enum { TOGETHER = 64, FOLDS = 40 /* e-folding times after which a motion is no longer followed */ };
static const double NEAR = M_PI / 180;

/* A motion; last [period]: for each phase relative to the attractor, the last period in which it was farther. */
typedef struct {
  const kz_entry *entry;
  int64_t certain; /* periods after which its end is certain */
  int64_t hold;    /* periods to stay near: two e-folding times, in which a swing shows its size */
  int64_t most;    /* periods after which it is given up */
  int64_t answer;  /* -1 = not known */
  int64_t *last;
  bool done;
} approach;

/* `longest`: largest number of periods followed, against multipliers of almost 1. */
static approach approach_begin(int64_t certain, const kz_entry *entry, int64_t first, int64_t longest) {
  const kz_attractor *row = &entry->row;
  const double size = fmin(fmax(hypot(row->multiplier_re[0], row->multiplier_im[0]), 1e-3), 1 - DBL_EPSILON);
  const double fold = fmin(row->period / -log(size), (double)longest);
  approach a = {.entry = entry, .certain = certain, .hold = (int64_t)ceil(2 * fold) + row->period, .answer = -1};
  a.most = certain + a.hold + (int64_t)ceil(FOLDS * fold);
  if (a.most - first > longest) a.most = first + longest;
  a.last = kz_malloc((size_t)row->period * sizeof *a.last);
  for (int32_t phase = 0; phase < row->period; phase++) a.last[phase] = first - 1;
  return a;
}

/* Takes note of the angle (rad) at strobe `time`. */
static void approach_look(approach *a, int64_t time, double theta) {
  const int32_t period = a->entry->row.period;
  for (int32_t phase = 0; phase < period; phase++) {
    const double away = remainder(theta - a->entry->theta[(time + phase) % period], 2 * M_PI);
    if (!(fabs(away) <= NEAR)) a->last[phase] = time;
    if (time < a->certain || time - a->last[phase] < a->hold) continue;
    a->answer = a->last[phase] + 1;
    a->done = true;
  }
  if (time >= a->most) a->done = true;
}

/* Follows n <= TOGETHER motions from their states [n][2] at strobes first [n] until all are done. */
static void approach_follow(kz_dynamics *dynamics, int64_t n, approach *a, const int64_t *first, double *state) {
  int64_t open = n;
  for (int64_t step = 0; open > 0; step++) {
    open = 0;
    for (int64_t i = 0; i < n; i++) {
      if (!a[i].done) approach_look(a + i, first[i] + step, M_PI * state[2 * i]);
      open += !a[i].done;
    }
    kz_dynamics_advance(dynamics, n, state);
  }
}

void kz_endings_approach(const kz_question *q, const double *state, const int64_t *periods, kz_ending *endings) {
  for (int64_t i = 0; i < q->n;) {
    approach a[TOGETHER];
    int64_t first[TOGETHER], of[TOGETHER], n = 0;
    double now[2 * TOGETHER];
    for (; i < q->n && n < TOGETHER; i++) {
      if (!kz_evidence_word(endings[i].end.evidence) || endings[i].entry.row.period < 1) continue;
      memcpy(now + 2 * n, state + 2 * i, 2 * sizeof *now);
      first[n] = periods[i];
      a[n] = approach_begin(endings[i].end.periods, &endings[i].entry, first[n], q->max_periods);
      of[n++] = i;
    }
    approach_follow(q->dynamics, n, a, first, now);
    for (int64_t j = 0; j < n; j++) {
      endings[of[j]].near_time = a[j].answer;
      free(a[j].last);
    }
  }
}
