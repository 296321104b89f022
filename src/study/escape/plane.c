/* Tiles are patches of the grid for one attractor. The paths out of its basin are searched at the middle of each patch,
 * and continued over the patch and a margin, in which patches overlap; at each place the least of all tiles counts. */
#include "plane.h"

#include "cells/scene_search.h"
#include "counted.h"
#include "family.h"
#include "kapitza/study_saddles.h"
#include "labelling/catalogue.h"
#include "numerics/cells.h"
#include "saddles/plan.h"

enum { MOST_FAMILIES = 12, REACH = 4 /* patches beyond its own over which a path is continued along a line */ };
/* Paths that are continued beside the least one; share of a patch that its margins have, on each side, of a plane. */
static const double WORTH = 1.5, MARGIN = 0.25;

/* The least barrier at a place: its action, derivatives by the axes, largest torque, strobe point 0 of its saddle. */
typedef struct {
  double action, slope[2], torque, theta, velocity;
  int32_t period, winding; /* period 0 = no path was found */
} plane_point;

typedef struct {
  const kz_scene *scene;
  const kz_run *run;
  kz_escape_places places;
  const kz_listed *attractors;
  char (*name)[KZ_NAME_LENGTH]; /* [attractors->count] */
  int64_t *left, n_left;        /* ids of attractors that are left */
  int64_t size[2], patch, patches[2], margin;
} plane_work;

/* Patch of a tile: first value and number of values along each axis, margins included; the place where paths are
 * searched. */
typedef struct {
  int64_t first[2], count[2], middle[2];
} plane_patch;

static plane_patch patch_of(const plane_work *w, int64_t tile) {
  const int64_t index[2] = {tile % w->patches[0], tile / w->patches[0] % w->patches[1]};
  plane_patch p;
  for (int c = 0; c < 2; c++) {
    const int64_t low = index[c] * w->patch, high = low + w->patch < w->size[c] ? low + w->patch : w->size[c];
    p.middle[c] = (low + high - 1) / 2;
    p.first[c] = low > w->margin ? low - w->margin : 0;
    p.count[c] = (high + w->margin < w->size[c] ? high + w->margin : w->size[c]) - p.first[c];
  }
  return p;
}

/* ---- the search at one place ---- */

/* Cycles of a catalogue that attract, or that do not, in the form of a file's group. */
static kz_listed listed_of(const kz_catalogue *all, bool attracts, int32_t *id) {
  kz_listed list = {.phases = 1};
  for (int64_t i = 0; i < all->count; i++) {
    const kz_attractor *row = &all->entries[i].row;
    id[i] = (hypot(row->multiplier_re[0], row->multiplier_im[0]) < 1) == attracts ? (int32_t)list.count++ : -1;
    if (row->period > list.phases) list.phases = row->period;
  }
  list.period = kz_calloc((size_t)(list.count * (3 + 2 * list.phases)) + 1, sizeof(double));
  list.mirror = list.period + list.count;
  list.lyapunov = list.mirror + list.count;
  list.theta = list.lyapunov + list.count;
  list.velocity = list.theta + list.count * list.phases;
  for (int64_t i = 0; i < all->count; i++) {
    const kz_entry *e = all->entries + i;
    if (id[i] < 0) continue;
    list.period[id[i]] = e->row.period;
    list.mirror[id[i]] = id[e->mirror];
    memcpy(list.theta + id[i] * list.phases, e->theta, (size_t)e->row.period * sizeof(double));
    memcpy(list.velocity + id[i] * list.phases, e->velocity, (size_t)e->row.period * sizeof(double));
  }
  return list;
}

/* A pendulum's attractors and saddles, and how its starts are labelled. */
typedef struct {
  kz_scene scene;
  kz_listed attractors, saddles;
  int64_t wanted; /* id of the attractor with the name that is asked for; -1 = there is none */
  kz_gate *gate;
} plane_world;

static void world_free(plane_world *world) {
  kz_plans_free(&world->scene);
  kz_listed_free(&world->attractors);
  kz_listed_free(&world->saddles);
  free(world->gate);
}

static kz_status world_label(const kz_escape_flow *flow, plane_world *world) {
  static const kz_run alone = {NULL, NULL};
  const kz_search search = kz_search_of(&world->scene);
  KZ_AUTOFREE_BY(kz_dynamics_freed) kz_dynamics *dynamics = kz_search_dynamics(&world->scene);
  KZ_AUTOFREE kz_escape_labels *labels = kz_calloc(1, sizeof *labels);
  *labels = (kz_escape_labels){.run = &alone, .dynamics = dynamics, .max_periods = search.max_periods};
  KZ_TRY(kz_escape_labels_make(&search, &world->attractors, labels));
  return kz_gates_find(labels, flow, &world->saddles, world->gate);
}

/* All cycles of a pendulum, and on which basins its saddles border. */
static kz_status world_make(const plane_work *w, const kz_escape_site *site, const char *name, plane_world *world) {
  const kz_saddles_plan *plan = w->scene->saddles;
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  int64_t open;
  world->scene = *w->scene;
  world->scene.parameters.pendulum = site->pendulum;
  world->wanted = -1;
  kz_plans_copy(&world->scene);
  kz_numerics_resolve(&world->scene);
  KZ_AUTOFREE_BY(kz_saddles_free) kz_catalogue all = {0};
  KZ_TRY(kz_saddles_all(&world->scene, plan->max_period, &window, &all, &open));
  KZ_AUTOFREE int32_t *id = kz_malloc((size_t)(all.count + 1) * sizeof *id);
  world->saddles = listed_of(&all, false, id);
  world->attractors = listed_of(&all, true, id);
  world->gate = kz_calloc((size_t)world->saddles.count + 1, sizeof *world->gate);
  for (int64_t i = 0; i < all.count && world->wanted < 0; i++)
    if (id[i] >= 0 && strcmp(all.entries[i].name, name) == 0) world->wanted = id[i];
  if (world->wanted < 0 || world->attractors.count > KZ_GATE_ATTRACTORS) return KZ_OK;
  return world_label(&site->of, world);
}

/* The path to one saddle joins the families, in the order of actions. */
static void plane_search(const kz_escape_site *site, const plane_world *world, int64_t saddle, int64_t starts,
                         kz_escape_member *member, int *n) {
  const kz_listed *a = &world->attractors, *s = &world->saddles;
  const int64_t at = world->wanted * a->phases, of = saddle * s->phases;
  kz_escape_cycle from, to = {0};
  KZ_AUTOFREE kz_escape_route *route = kz_calloc(1, sizeof *route);
  if (kz_escape_cycle_find(&site->of, (int64_t)a->period[world->wanted], true, a->theta + at, a->velocity + at,
                           &from) &&
      kz_escape_cycle_find(&site->of, (int64_t)s->period[saddle], false, s->theta + of, s->velocity + of, &to)) {
    kz_escape_search(&site->of, &from, &to, starts, (uint64_t)(world->wanted * INT16_MAX + saddle), route);
    if (route->count > 0 && kz_escape_finish(&site->of, &from, &to, KZ_ESCAPE_NEAR, route)) {
      route->least.node = route->node;
      const kz_escape_member found = {
          .pendulum = site->pendulum, .from = from.end[route->phase], .to = to.end[0], .path = route->least};
      int place = *n < MOST_FAMILIES ? (*n)++ : MOST_FAMILIES;
      for (; place > 0 && member[place - 1].path.action > found.path.action; place--) {
        if (place == MOST_FAMILIES)
          kz_escape_member_free(member + place - 1);
        else
          member[place] = member[place - 1];
      }
      if (place < MOST_FAMILIES) kz_escape_member_copy(&found, member + place);
    }
  }
  kz_escape_cycle_free(&from);
  kz_escape_cycle_free(&to);
}

/* The least paths to all saddles on the edge of the basin at one place: member [MOST_FAMILIES]. */
static kz_status plane_search_all(const plane_work *w, const kz_escape_site *site, const char *name,
                                  kz_escape_member *member, int *n) {
  KZ_AUTOFREE_BY(world_free) plane_world world = {0};
  KZ_TRY(world_make(w, site, name, &world));
  if (world.wanted < 0) return KZ_OK;
  const uint64_t alone = kz_gates_alone(world.saddles.count, world.gate);
  const bool own_image =
      kz_is_mirrored(&site->pendulum) && (int64_t)world.attractors.mirror[world.wanted] == world.wanted;
  for (int64_t s = 0; s < world.saddles.count; s++)
    if (kz_gate_is_of(world.gate + s, (int32_t)world.wanted, alone) &&
        !(own_image && (int64_t)world.saddles.mirror[s] < s))
      plane_search(site, &world, s, w->scene->escape->starts, member, n);
  return KZ_OK;
}

/* ---- continuation over a patch ---- */

typedef struct {
  const plane_work *w;
  plane_patch patch;
  kz_escape_site *site; /* [count y][count x]; opened when it is first needed */
  plane_point *point;   /* [count y][count x] */
} plane_tile;

static int64_t tile_index(const plane_tile *t, const int64_t at[2]) {
  return (at[1] - t->patch.first[1]) * t->patch.count[0] + at[0] - t->patch.first[0];
}

static const kz_escape_site *tile_site(const plane_tile *t, const int64_t at[2]) {
  kz_escape_site *site = t->site + tile_index(t, at);
  if (!site->of.flow) kz_escape_site_open(&t->w->places, (double[]){(double)at[0], (double)at[1]}, site);
  return site;
}

/* Derivative of the action by the value of an axis; NaN where the drive has more parameters than k, beta and m. */
static double slope_along(const plane_tile *t, int axis, const kz_escape_member *m) {
  static const double STEP = 1e-4; /* steps of the grid */
  const kz_axis *values = axis ? &t->w->scene->escape->y.values : &t->w->scene->escape->x.values;
  const double *slope = m->path.slope, unit = (values->max - values->min) / (double)(values->count - 1);
  kz_pendulum beside[2];
  for (int side = 0; side < 2; side++) {
    double at[2] = {m->at[0], m->at[1]};
    at[axis] += side ? STEP : -STEP;
    if (!kz_escape_place(&t->w->places, at, beside + side) || !kz_is_sine(beside + side)) return NAN;
  }
  return (slope[0] * (beside[1].k - beside[0].k) + slope[1] * (beside[1].m - beside[0].m) +
          slope[2] * (beside[1].beta - beside[0].beta)) /
         (2 * STEP * unit);
}

/* Whether the path is worth more steps; where it is the least so far and its saddle lies on the edge of the basin, it
 * is noted. */
static bool tile_note(const plane_tile *t, const int64_t at[2], const kz_escape_member *m) {
  plane_point *p = t->point + tile_index(t, at);
  if (p->period > 0 && m->path.action >= p->action) return m->path.action < WORTH * p->action;
  const kz_escape_site *site = tile_site(t, at);
  if (!kz_gate_borders(site->of.coarse, &m->from, &m->to)) return false;
  *p = (plane_point){.action = m->path.action,
                     .torque = kz_escape_torque(&site->of, &m->path),
                     .theta = m->to.state[0],
                     .velocity = m->to.state[1],
                     .period = (int32_t)m->to.period,
                     .winding = (int32_t)m->to.winding};
  for (int axis = 0; axis < t->w->places.n_axes; axis++) p->slope[axis] = slope_along(t, axis, m);
  return true;
}

/* Continues a path from the middle of the patch to all places that it reaches, from neighbour to neighbour. */
static void tile_flood(const plane_tile *t, const kz_escape_member *from) {
  enum { ATTEMPTS = 2 /* neighbours from which a place is tried */ };
  const bool turns = t->w->places.n_axes == 1;
  const int64_t n = t->patch.count[0] * t->patch.count[1];
  KZ_AUTOFREE kz_escape_member *member = kz_calloc((size_t)n + 1, sizeof *member);
  KZ_AUTOFREE int32_t *attempts = kz_calloc((size_t)n + 1, sizeof *attempts);
  int64_t reached = 1;
  kz_escape_member_copy(from, member);
  attempts[tile_index(t, t->patch.middle)] = ATTEMPTS;
  for (int64_t i = 0; i < reached; i++)
    for (int way = 0; way < 4; way++) {
      const int axis = way / 2;
      int64_t at[2] = {(int64_t)member[i].at[0], (int64_t)member[i].at[1]};
      at[axis] += way % 2 ? 1 : -1;
      if (at[axis] < t->patch.first[axis] || at[axis] >= t->patch.first[axis] + t->patch.count[axis]) continue;
      int32_t *left = attempts + tile_index(t, at);
      if ((*left)++ >= ATTEMPTS) continue;
      kz_escape_member *next = member + reached;
      kz_escape_member_copy(member + i, next);
      const double place[2] = {(double)at[0], (double)at[1]};
      const bool good = kz_escape_continue(&t->w->places, tile_site(t, at), place, turns, next);
      if (good) *left = ATTEMPTS;
      if (good && tile_note(t, at, next))
        reached++;
      else
        kz_escape_member_free(next);
    }
  for (int64_t i = 0; i < reached; i++) kz_escape_member_free(member + i);
}

/* Record: a plane_point for each place of the patch. */
static kz_status plane_tile_work(void *context, int64_t tile, void *record) {
  const plane_work *w = context;
  plane_tile t = {.w = w, .patch = patch_of(w, tile), .point = record};
  const int64_t n = t.patch.count[0] * t.patch.count[1], id = w->left[tile / (w->patches[0] * w->patches[1])];
  kz_escape_member member[MOST_FAMILIES];
  int families = 0;
  t.site = kz_calloc((size_t)n, sizeof *t.site);
  const kz_escape_site *middle = tile_site(&t, t.patch.middle);
  kz_status status = middle->of.flow ? plane_search_all(w, middle, w->name[id], member, &families) : KZ_OK;
  for (int f = 0; f < families && status == KZ_OK; f++) {
    for (int c = 0; c < 2; c++) member[f].at[c] = (double)t.patch.middle[c];
    status = kz_ranks_interrupted(w->run->ranks);
    if (status != KZ_OK || !tile_note(&t, t.patch.middle, member + f)) continue;
    tile_flood(&t, member + f);
  }
  for (int f = 0; f < families; f++) kz_escape_member_free(member + f);
  for (int64_t i = 0; i < n; i++) kz_escape_site_close(t.site + i);
  free(t.site);
  return status;
}

/* ---- the file ---- */

#define COLUMN(type, name, n, expression) KZ_COLUMN(store, "escape", name, n, type, expression)

static kz_status write_points(const plane_work *w, const plane_point *p, kz_store *store) {
  const kz_plane_axis *axis[2] = {&w->scene->escape->x, &w->scene->escape->y};
  const int64_t n = w->attractors->count * w->size[0] * w->size[1];
  for (int c = w->places.n_axes - 1; c >= 0; c--) {
    const kz_axis *values = &axis[c]->values;
    KZ_TRY(kz_axis_describe(values, axis[c]->parameter, c ? "y" : "x", "escape", store));
    KZ_SCALE(store, "escape", c ? "y" : "x", values->count, kz_axis_value(values, i));
  }
  const bool plane = w->places.n_axes == 2;
#define OVER(name) plane ? "plane_" name : "line_" name
#define NUMBER(member) p[i].period > 0 ? p[i].member : NAN
  COLUMN(double, OVER("barrier"), n, NUMBER(action));
  COLUMN(double, OVER("barrier_by_x"), n, NUMBER(slope[0]));
  if (plane) COLUMN(double, "plane_barrier_by_y", n, NUMBER(slope[1]));
  COLUMN(double, OVER("largest_torque"), n, NUMBER(torque));
  COLUMN(int32_t, OVER("saddle_period"), n, p[i].period);
  COLUMN(int32_t, OVER("saddle_winding"), n, p[i].winding);
  COLUMN(double, OVER("saddle_theta"), n, p[i].period > 0 ? remainder(p[i].theta, 2 * M_PI) : NAN);
  COLUMN(double, OVER("saddle_velocity"), n, NUMBER(velocity));
  return KZ_OK;
}

static void print_points(const plane_work *w, const plane_point *p, FILE *summary) {
  const kz_plane_axis *axis[2] = {&w->scene->escape->x, &w->scene->escape->y};
  const int64_t points = w->size[0] * w->size[1];
  for (int64_t k = 0; k < w->n_left; k++) {
    const plane_point *own = p + w->left[k] * points;
    int64_t found = 0, best = -1;
    for (int64_t i = 0; i < points; i++) {
      found += own[i].period > 0;
      if (own[i].period > 0 && (best < 0 || own[i].action > own[best].action)) best = i;
    }
    fprintf(summary, "barrier of attractor %lld (%s): at %lld of %lld places", (long long)w->left[k],
            w->name[w->left[k]], (long long)found, (long long)points);
    for (int c = 0; c < w->places.n_axes && best >= 0; c++) {
      char text[100];
      const int64_t at = c ? best / w->size[0] : best % w->size[0];
      kz_axis_print(&axis[c]->values, axis[c]->parameter, 6, kz_axis_value(&axis[c]->values, at), text, sizeof text);
      fprintf(summary, c ? ", %s" : "; largest at %s", text);
    }
    if (best >= 0) fprintf(summary, ": %.8g", own[best].action);
    fprintf(summary, "\n");
  }
}

/* The least of all tiles at each place: point [attractors->count][y][x]. */
static void join_tiles(const plane_work *w, int64_t tiles, int64_t bytes, const char *record, plane_point *point) {
  for (int64_t tile = 0; tile < tiles; tile++) {
    const plane_patch patch = patch_of(w, tile);
    const plane_point *of = (const plane_point *)(record + tile * bytes);
    plane_point *own = point + w->left[tile / (w->patches[0] * w->patches[1])] * w->size[0] * w->size[1];
    for (int64_t i = 0; i < patch.count[0] * patch.count[1]; i++) {
      plane_point *to = own + (patch.first[1] + i / patch.count[0]) * w->size[0] + patch.first[0] + i % patch.count[0];
      if (of[i].period > 0 && (to->period == 0 || of[i].action < to->action)) *to = of[i];
    }
  }
}

static kz_status plane_run(const plane_work *w, const kz_run *run, kz_store *store, FILE *summary) {
  const int64_t tiles = w->n_left * w->patches[0] * w->patches[1], side = w->patch + 2 * w->margin;
  const size_t bytes = (size_t)(side * (w->size[1] > 1 ? side : 1)) * sizeof(plane_point);
  const kz_stage stage = kz_stage_for_rank0("barriers", tiles, bytes, plane_tile_work, (void *)w);
  KZ_AUTOFREE char *record = store ? kz_calloc((size_t)tiles + 1, bytes) : NULL;
  KZ_TRY(kz_stage_run(run, &stage, record));
  if (!store) return KZ_OK;
  KZ_AUTOFREE plane_point *point =
      kz_calloc((size_t)(w->attractors->count * w->size[0] * w->size[1]) + 1, sizeof *point);
  join_tiles(w, tiles, (int64_t)bytes, record, point);
  print_points(w, point, summary);
  return write_points(w, point, store);
}

kz_status kz_escape_over_plane(const kz_scene *scene, const kz_escape_labels *labels, const kz_listed *attractors,
                               kz_store *store, FILE *summary) {
  const kz_escape_plan *plan = scene->escape;
  if (!kz_escape_has_plane(plan)) return KZ_OK;
  const bool plane = plan->y.parameter >= 0;
  KZ_AUTOFREE int64_t *left = kz_malloc((size_t)(attractors->count + 1) * sizeof *left);
  KZ_AUTOFREE char (*name)[KZ_NAME_LENGTH] = kz_calloc((size_t)attractors->count + 1, sizeof *name);
  plane_work w = {.scene = scene,
                  .run = labels->run,
                  .places = {scene, plane ? 2 : 1},
                  .attractors = attractors,
                  .name = name,
                  .left = left,
                  .patch = plan->patch};
  w.size[0] = plan->x.values.count;
  w.size[1] = plane ? plan->y.values.count : 1;
  w.margin = plane ? (int64_t)ceil(MARGIN * (double)w.patch) : REACH * w.patch;
  for (int c = 0; c < 2; c++) w.patches[c] = (w.size[c] + w.patch - 1) / w.patch;
  KZ_AUTOFREE_BY(kz_catalogue_free) kz_catalogue catalogue = {0};
  kz_catalogue_make(labels->dynamics, NULL, &catalogue);
  for (int64_t number = 1; number <= kz_dynamics_count(labels->dynamics); number++)
    if (labels->id[number] >= 0 && catalogue.id_of[number] >= 0)
      memcpy(name[labels->id[number]], catalogue.entries[catalogue.id_of[number]].name, KZ_NAME_LENGTH);
  for (int64_t id = 0; id < attractors->count; id++)
    if (kz_escape_is_left(plan, attractors, id)) left[w.n_left++] = id;
  return plane_run(&w, labels->run, store, summary);
}
