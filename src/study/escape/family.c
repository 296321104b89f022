#include "family.h"

enum { MAX_HALVINGS = 3, MAX_TURN_STEPS = 60, MAX_CORRECTIONS = 8, FEW_CORRECTIONS = 4 };
/* Steps of the grid: the first of pseudo-arclength, its shortest and its longest, and that of differences. */
static const double FIRST = 0.02, SHORTEST = 1e-3, LONGEST = 0.3, BESIDE = 1e-4;
/* The largest jump of a path that is found; change of the action beside what its slopes foresee, of the action. */
static const double CLOSED = 1e-9, SURPRISE = 0.2;

bool kz_escape_place(const kz_escape_places *places, const double at[2], kz_pendulum *pendulum) {
  const kz_plane_axis *axis[2] = {&places->scene->escape->x, &places->scene->escape->y};
  int32_t parameter[2];
  double value[2];
  for (int c = 0; c < places->n_axes; c++) {
    const kz_axis *a = &axis[c]->values;
    parameter[c] = axis[c]->parameter;
    const double whole = rint(at[c]);
    value[c] = whole == at[c] ? kz_axis_value(a, (int64_t)whole)
                              : a->min + (a->max - a->min) * (at[c] / (double)(a->count - 1));
  }
  return kz_pendulum_at(places->scene, places->n_axes, parameter, value, pendulum) && pendulum->beta > 0;
}

void kz_escape_site_open(const kz_escape_places *places, const double at[2], kz_escape_site *site) {
  if (kz_escape_place(places, at, &site->pendulum)) site->of = kz_escape_flow_of(&site->pendulum);
}

void kz_escape_site_close(kz_escape_site *site) {
  kz_escape_flow_free(&site->of);
}

void kz_escape_member_copy(const kz_escape_member *of, kz_escape_member *copy) {
  *copy = *of;
  copy->path.node = kz_malloc((size_t)(4 * (of->path.n + 1)) * sizeof *copy->path.node);
  memcpy(copy->path.node, of->path.node, (size_t)(4 * (of->path.n + 1)) * sizeof *copy->path.node);
}

void kz_escape_member_free(kz_escape_member *member) {
  free(member->path.node);
}

/* Finds the cycles of a member, whose states are those of a neighbour. */
static bool find_ends(const kz_hamilton *flow, kz_escape_member *m) {
  return flow && kz_path_end_find(flow, m->from.period, true, m->from.state[0], m->from.state[1], &m->from) &&
         kz_path_end_find(flow, m->to.period, false, m->to.state[0], m->to.state[1], &m->to);
}

/* Whether the action is what its slopes at the other member let expect. */
static bool is_of_family(const kz_escape_member *before, const kz_escape_member *now) {
  const double *slope = before->path.slope, foreseen = before->path.action +
                                                       slope[0] * (now->pendulum.k - before->pendulum.k) +
                                                       slope[1] * (now->pendulum.m - before->pendulum.m) +
                                                       slope[2] * (now->pendulum.beta - before->pendulum.beta);
  const double action = now->path.action;
  return action > 0 && fabs(action - foreseen) <= SURPRISE * fmax(action, before->path.action);
}

/* One step of natural continuation; `any`: to an action of any size. */
static bool step_to(const kz_escape_site *site, const double at[2], bool any, kz_escape_member *member) {
  kz_escape_member next;
  kz_escape_member_copy(member, &next);
  next.at[0] = at[0], next.at[1] = at[1];
  next.pendulum = site->pendulum;
  const bool good = site->of.flow && find_ends(site->of.flow, &next) &&
                    kz_escape_polish(site->of.coarse, &next.from, &next.to, KZ_ESCAPE_NEAR, &next.path) &&
                    kz_path_polish(site->of.flow, &next.from, &next.to, &next.path) &&
                    (any || is_of_family(member, &next));
  kz_escape_member_free(good ? member : &next);
  if (good) *member = next;
  return good;
}

/* Continues in up to 2^MAX_HALVINGS steps; the member moves as far as it comes. */
static bool walk_to(const kz_escape_places *places, const kz_escape_site *site, const double at[2], int halvings,
                    kz_escape_member *member) {
  if (step_to(site, at, false, member)) return true;
  if (halvings == 0) return false;
  const double middle[2] = {0.5 * (at[0] + member->at[0]), 0.5 * (at[1] + member->at[1])};
  kz_escape_site half = {0};
  kz_escape_site_open(places, middle, &half);
  const bool good = walk_to(places, &half, middle, halvings - 1, member);
  kz_escape_site_close(&half);
  return good && walk_to(places, site, at, halvings - 1, member);
}

/* ---- folds, by pseudo-arclength along the line from `origin`, whose direction has the length of a step of the grid
 * ---- */

typedef struct {
  const kz_escape_places *places;
  double origin[2], direction[2];
} turn_line;

static void place_on(const turn_line *line, double along, double at[2]) {
  for (int c = 0; c < 2; c++) at[c] = line->origin[c] + along * line->direction[c];
}

/* Moves a path and its place until its jumps are closed; returns the number of steps, 0 where that fails. */
static int correct_member(const turn_line *line, double *along, kz_escape_member *m) {
  bool done = false, good = true;
  int steps = 0;
  for (; steps < MAX_CORRECTIONS && good && !done; steps++) {
    kz_escape_site site[2] = {0};
    kz_escape_member beside = *m;
    double at[2];
    for (int i = 0; i < 2; i++) {
      place_on(line, *along + i * BESIDE, at);
      kz_escape_site_open(line->places, at, site + i);
    }
    good = find_ends(site[0].of.flow, m) && find_ends(site[1].of.flow, &beside);
    if (good) {
      const double step = kz_path_turn((const kz_hamilton *const[]){site[0].of.flow, site[1].of.flow},
                                       (const kz_path_end *const[]){&m->from, &beside.from},
                                       (const kz_path_end *const[]){&m->to, &beside.to}, BESIDE, &m->path);
      done = m->path.mismatch < CLOSED;
      good = isfinite(step);
      if (good) *along += step;
      m->pendulum = site[0].pendulum;
    }
    for (int i = 0; i < 2; i++) kz_escape_site_close(site + i);
  }
  place_on(line, *along, m->at);
  return done && good ? steps : 0;
}

/* The next member: as far from `now` as that from the one before, times `factor`. Cycles follow in the same way. */
static void foresee_member(const kz_escape_member *before, const kz_escape_member *now, double factor,
                           kz_escape_member *next) {
  kz_escape_member_copy(now, next);
  for (int64_t i = 0; i < 4 * (now->path.n + 1); i++)
    next->path.node[i] += factor * (now->path.node[i] - before->path.node[i]);
  for (int c = 0; c < 2; c++) {
    next->from.state[c] += factor * (now->from.state[c] - before->from.state[c]);
    next->to.state[c] += factor * (now->to.state[c] - before->to.state[c]);
  }
}

/* Follows the path through a fold, and through another one, until it comes back to a place beyond `end` along the line.
 */
static bool turn_to(const kz_escape_places *places, const kz_escape_site *site, const double at[2],
                    kz_escape_member *member) {
  const double reach = fmax(fabs(at[0] - member->at[0]), fabs(at[1] - member->at[1]));
  turn_line line = {.places = places};
  double back[2], along[3] = {-FIRST, 0, 0}, factor = 1;
  for (int c = 0; c < 2; c++) {
    line.origin[c] = member->at[c];
    line.direction[c] = (at[c] - member->at[c]) / reach;
  }
  kz_escape_member m[3];
  kz_escape_member_copy(member, m + 1);
  kz_escape_member_copy(member, m);
  place_on(&line, along[0], back);
  kz_escape_site behind = {0};
  kz_escape_site_open(places, back, &behind);
  bool good = step_to(&behind, back, false, m) && m[0].path.n == m[1].path.n, there = false;
  kz_escape_site_close(&behind);
  for (int i = 0; i < MAX_TURN_STEPS && good && !there; i++) {
    foresee_member(m, m + 1, factor, m + 2);
    along[2] = along[1] + factor * (along[1] - along[0]);
    const int corrections = correct_member(&line, along + 2, m + 2);
    if (corrections == 0 || fabs(along[2] - along[1]) > LONGEST) {
      kz_escape_member_free(m + 2);
      factor *= 0.5;
      good = factor > SHORTEST;
      continue;
    }
    kz_escape_member_free(m);
    for (int j = 0; j < 2; j++) m[j] = m[j + 1], along[j] = along[j + 1];
    factor = corrections <= FEW_CORRECTIONS ? 1.5 : 1;
    there = along[1] >= reach;
  }
  if (there) there = step_to(site, at, true, m + 1);
  kz_escape_member_free(m);
  kz_escape_member_free(there ? member : m + 1);
  if (there) *member = m[1];
  return there;
}

bool kz_escape_continue(const kz_escape_places *places, const kz_escape_site *site, const double at[2], bool turns,
                        kz_escape_member *member) {
  kz_escape_member last;
  kz_escape_member_copy(member, &last);
  const bool good =
      site->of.flow && (walk_to(places, site, at, MAX_HALVINGS, &last) || (turns && turn_to(places, site, at, &last)));
  kz_escape_member_free(good ? member : &last);
  if (good) *member = last;
  return good;
}
