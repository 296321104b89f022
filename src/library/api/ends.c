/* Where single starts end, with any number of digits; what an atlas says of its points. */
#include "../library.h"

/* ---- starts ---- */

typedef struct {
  const char *change;
  int64_t n;
  const char *const *theta, *const *velocity;
  kapitza_endings *endings;
  const kapitza_scene *scene;
  int64_t digits;
  kapitza_boundary *boundary;
} where_job;

static kz_status starts_read(const where_job *j, double pivot_frequency, bool all, kz_coordinate (*start)[2]) {
  for (int64_t i = 0; i < j->n; i++)
    KZ_TRY(kz_start_read(j->theta[i], j->velocity[i], i, pivot_frequency, all, start[i]));
  return KZ_OK;
}

static size_t endings_bytes(int64_t n, const kz_ending *own) {
  size_t bytes = kz_library_rounded(sizeof(kapitza_endings)) + kz_library_rounded((size_t)n * sizeof(kapitza_ending));
  for (int64_t i = 0; i < n; i++) bytes += 2 * (size_t)own[i].entry.row.period * sizeof(double);
  return bytes;
}

static void put_ending(const kz_ending *own, const kz_coordinate start[2], double *points, kapitza_ending *ending) {
  const kz_attractor *row = &own->entry.row;
  const char *precision = own->end.label >= 0 ? kz_evidence_word(own->end.evidence) : NULL;
  *ending = (kapitza_ending){.attractor = own->end.label,
                             .other = own->end.other,
                             .turns = own->end.turns,
                             .period = row->period,
                             .winding = row->winding,
                             .settling_time = own->end.periods,
                             .near_time = own->near_time,
                             .error = own->error,
                             .mean_velocity = row->mean_velocity,
                             .theta = start[0].high,
                             .velocity = start[1].high,
                             .strobe_theta = points,
                             .strobe_velocity = points + row->period};
  snprintf(ending->name, sizeof ending->name, "%s", own->entry.name);
  snprintf(ending->other_name, sizeof ending->other_name, "%s", own->other_name);
  snprintf(ending->precision, sizeof ending->precision, "%s", precision ? precision : "");
  const size_t bytes = (size_t)row->period * sizeof *points;
  if (bytes == 0) return;
  memcpy(points, own->entry.theta, bytes);
  memcpy(points + row->period, own->entry.velocity, bytes);
}

kapitza_endings *kz_library_endings(const kz_scene *scene, int64_t n, const kz_coordinate (*start)[2],
                                    const kz_ending *own) {
  char *piece = kz_border_give(endings_bytes(n, own));
  kapitza_endings *endings = kz_library_part(&piece, sizeof *endings);
  kapitza_ending *ending = kz_library_part(&piece, (size_t)n * sizeof *ending);
  double *points = (double *)(void *)piece;
  for (int64_t i = 0; i < n; points += 2 * own[i++].entry.row.period) put_ending(own + i, start[i], points, ending + i);
  *endings = (kapitza_endings){n, ending, kz_library_parameters(&scene->parameters)};
  return endings;
}

static kz_status where_tell(kapitza_pendulum *p, where_job *j, const kz_scene *scene, const kz_coordinate (*start)[2]) {
  KZ_AUTOFREE kz_ending *own = kz_calloc((size_t)j->n + 1, sizeof *own);
  const kz_status status = kz_engine_where(p->engine, scene, j->n, start, own);
  if (status == KZ_OK) j->endings = kz_library_endings(scene, j->n, start, own);
  kz_where_free(j->n, own);
  return status;
}

static kz_status work_where(kapitza_pendulum *p, void *context) {
  where_job *j = context;
  KZ_AUTOFREE_BY(kz_scene_free) kz_scene scene = {0};
  KZ_TRY(kz_memory_ask("n", (size_t)j->n * (sizeof(kz_ending) + sizeof(kapitza_ending) + 2 * sizeof(kz_coordinate))));
  KZ_AUTOFREE kz_coordinate(*start)[2] = kz_calloc((size_t)j->n + 1, sizeof *start);
  KZ_TRY(kz_scene_open(&p->text, j->change, &scene));
  KZ_TRY(starts_read(j, scene.parameters.pivot_frequency, true, start));
  return where_tell(p, j, &scene, (const kz_coordinate(*)[2])start);
}

kapitza_status kapitza_where(kapitza_pendulum *pendulum, const char *change, int64_t n, const char *const *theta,
                             const char *const *velocity, kapitza_endings **endings) {
  where_job job = {.change = change, .n = n, .theta = theta, .velocity = velocity};
  const kapitza_status status = kz_library_call(pendulum, work_where, &job);
  *endings = status == KAPITZA_OK ? job.endings : NULL;
  return status;
}

/* ---- starts of a scene ---- */

static kz_status ends_answer(const kz_scene *scene, void *context) {
  where_job *j = context;
  KZ_TRY(kz_memory_ask("n", (size_t)j->n * (sizeof(kz_ending) + sizeof(kapitza_ending) + 2 * sizeof(kz_coordinate))));
  KZ_AUTOFREE kz_coordinate(*start)[2] = kz_calloc((size_t)j->n + 1, sizeof *start);
  KZ_AUTOFREE kz_ending *own = kz_calloc((size_t)j->n + 1, sizeof *own);
  KZ_TRY(starts_read(j, scene->parameters.pivot_frequency, false, start));
  const kz_status status = kz_where(scene, j->n, (const kz_coordinate(*)[2])start, own);
  if (status == KZ_OK) j->endings = kz_library_endings(scene, j->n, (const kz_coordinate(*)[2])start, own);
  kz_where_free(j->n, own);
  return status;
}

static kz_status ends_work(void *context) {
  const kz_scene_source text = kz_library_text(((where_job *)context)->scene);
  return kz_scene_ask(&text, ends_answer, context);
}

kapitza_status kz_library_where(const kapitza_scene *scene, int64_t n, const char *const *theta,
                                const char *const *velocity, kapitza_endings **endings) {
  where_job job = {.n = n, .theta = theta, .velocity = velocity, .scene = scene};
  const kapitza_status status = kz_library_alone(ends_work, &job);
  *endings = status == KAPITZA_OK ? job.endings : NULL;
  return status;
}

static kz_status boundary_answer(const kz_scene *scene, void *context) {
  const where_job *j = context;
  kz_coordinate start[2][2];
  KZ_AUTOFREE kz_boundary_point *point = kz_calloc(1, sizeof *point);
  if (j->digits < 1 || j->digits > KZ_BOUNDARY_MOST_DIGITS)
    return kz_fail(KZ_REFUSED, "digits: %lld: must be from 1 to %d", (long long)j->digits,
                   (int)KZ_BOUNDARY_MOST_DIGITS);
  KZ_TRY(starts_read(j, scene->parameters.pivot_frequency, false, start));
  KZ_TRY(kz_where_boundary(scene, (const kz_coordinate(*)[2])start, j->digits, point));
  kapitza_boundary *found = j->boundary;
  snprintf(found->theta, sizeof found->theta, "%s", point->theta);
  snprintf(found->velocity, sizeof found->velocity, "%s", point->velocity);
  for (int i = 0; i < 2; i++) {
    snprintf(found->name[i], sizeof found->name[i], "%s", point->name[i]);
    found->attractor[i] = point->attractor[i];
  }
  return KZ_OK;
}

static kz_status boundary_work(void *context) {
  const kz_scene_source text = kz_library_text(((where_job *)context)->scene);
  return kz_scene_ask(&text, boundary_answer, context);
}

kapitza_status kz_library_boundary(const kapitza_scene *scene, const char *const *theta, const char *const *velocity,
                                   int64_t digits, kapitza_boundary *boundary) {
  where_job job = {
      .n = 2, .theta = theta, .velocity = velocity, .scene = scene, .digits = digits, .boundary = boundary};
  return kz_library_alone(boundary_work, &job);
}

/* ---- points of an atlas ---- */

typedef struct {
  const char *file;
  double x, y;
  bool states;
  kapitza_motions *motions;
} motions_job;

static void put_motion(const kz_motion *own, double *points, kapitza_motion *motion) {
  *motion = (kapitza_motion){.period = own->of.period,
                             .winding = own->of.winding,
                             .centre = own->of.centre,
                             .symmetric = own->of.symmetric,
                             .images = own->of.images,
                             .strobes = own->strobes,
                             .curve = own->curve,
                             .multiplier_re = {own->multiplier_re[0], own->multiplier_re[1]},
                             .multiplier_im = {own->multiplier_im[0], own->multiplier_im[1]},
                             .theta = points,
                             .velocity = points + own->strobes};
  snprintf(motion->name, sizeof motion->name, "%s", own->of.name);
  memcpy(points, own->theta, (size_t)own->strobes * sizeof *points);
  memcpy(points + own->strobes, own->velocity, (size_t)own->strobes * sizeof *points);
}

static kapitza_motions *motions_give(const kz_motions *own) {
  size_t bytes =
      kz_library_rounded(sizeof(kapitza_motions)) + kz_library_rounded((size_t)own->count * sizeof(kapitza_motion));
  for (int64_t i = 0; i < own->count; i++) bytes += 2 * (size_t)own->motion[i].strobes * sizeof(double);
  char *piece = kz_border_give(bytes);
  kapitza_motions *motions = kz_library_part(&piece, sizeof *motions);
  kapitza_motion *motion = kz_library_part(&piece, (size_t)own->count * sizeof *motion);
  double *points = (double *)(void *)piece;
  for (int64_t i = 0; i < own->count; points += 2 * own->motion[i++].strobes)
    put_motion(own->motion + i, points, motion + i);
  *motions =
      (kapitza_motions){own->count, motion, own->x, own->y, own->pendulum.k, own->pendulum.beta, own->pendulum.m};
  return motions;
}

static kz_status work_motions(kapitza_pendulum *p, void *context) {
  motions_job *j = context;
  kz_atlas *atlas;
  KZ_AUTOFREE_BY(kz_motions_free) kz_motions own = {0};
  KZ_TRY(kz_library_atlas_of(p, j->file, &atlas));
  KZ_TRY(kz_atlas_motions(atlas, j->x, j->y, j->states, &own));
  if (!own.known)
    return kz_fail(
        KZ_REFUSED,
        "x: the list of motions is not known at %.10g, %.10g: a curve is missing, as some class of attractors has a "
        "negative count there",
        j->x, j->y);
  j->motions = motions_give(&own);
  return KZ_OK;
}

kapitza_status kapitza_motions_at(kapitza_pendulum *pendulum, const char *file, double x, double y, int32_t states,
                                  kapitza_motions **motions) {
  motions_job job = {.file = file, .x = x, .y = y, .states = states != 0};
  const kapitza_status status = kz_library_call(pendulum, work_motions, &job);
  *motions = status == KAPITZA_OK ? job.motions : NULL;
  return status;
}

/* ---- lines through an atlas ---- */

_Static_assert(KZ_LINE_COLUMNS == 5, "a point has as many numbers as kapitza.h says");

typedef struct {
  const char *file;
  bool along_x;
  double value;
  kapitza_line *line;
} line_job;

static kapitza_line *line_give(const kz_atlas_branches *own) {
  const size_t branches = (size_t)own->count * sizeof(kapitza_branch),
               points = (size_t)own->n_points * sizeof *own->point;
  char *piece = kz_border_give(kz_library_rounded(sizeof(kapitza_line)) + kz_library_rounded(branches) + points);
  kapitza_line *line = kz_library_part(&piece, sizeof *line);
  kapitza_branch *branch = kz_library_part(&piece, branches);
  for (int64_t i = 0; i < own->count; i++) {
    const kz_motion_kind *of = &own->branch[i].of;
    branch[i] = (kapitza_branch){.period = of->period,
                                 .winding = of->winding,
                                 .centre = of->centre,
                                 .symmetric = of->symmetric,
                                 .images = of->images,
                                 .first = own->branch[i].first,
                                 .points = own->branch[i].points};
    snprintf(branch[i].name, sizeof branch[i].name, "%s", of->name);
  }
  if (points > 0) memcpy(piece, own->point, points);
  *line = (kapitza_line){own->count, own->n_points, branch, (double *)(void *)piece};
  return line;
}

static kz_status work_line(kapitza_pendulum *p, void *context) {
  line_job *j = context;
  kz_atlas *atlas;
  KZ_AUTOFREE_BY(kz_atlas_branches_free) kz_atlas_branches own = {0};
  KZ_TRY(kz_library_atlas_of(p, j->file, &atlas));
  KZ_TRY(kz_atlas_line(atlas, !j->along_x, j->value, &own));
  j->line = line_give(&own);
  return KZ_OK;
}

kapitza_status kapitza_line_through(kapitza_pendulum *pendulum, const char *file, int32_t along_x, double value,
                                    kapitza_line **line) {
  line_job job = {.file = file, .along_x = along_x != 0, .value = value};
  const kapitza_status status = kz_library_call(pendulum, work_line, &job);
  *line = status == KAPITZA_OK ? job.line : NULL;
  return status;
}
