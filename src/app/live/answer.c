#include "answer.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include "where.h"
#include "../json.h"
#include "kapitza/version.h"
#include "kapitza/study_basin.h"
#include "kapitza/study_orbit.h"

/* A header with the members that all have. */
static kz_json *answer_begin(const char *answer, int64_t sequence, bool final) {
  kz_json *header = json_object_new_object();
  kz_json_add_text(header, "answer", answer);
  kz_json_add(header, "sequence", sequence == KZ_UNSET_INTEGER ? NULL : json_object_new_int64(sequence));
  kz_json_add_boolean(header, "final", final);
  return header;
}

/* Prints the header and frees it; the payload's bytes come next. */
static void answer_print(kz_json *header, size_t bytes) {
  kz_json_add_integer(header, "bytes", (int64_t)bytes);
  kz_json_print(header, stdout);
}

/* A reader that has gone ends the program as the end of its requests does. */
static kz_status answer_send(void) {
  if (fflush(stdout) == 0) return KZ_OK;
  return errno == EPIPE ? KZ_STOPPED : kz_fail(KZ_FAILED, "standard output cannot be written: %s", strerror(errno));
}

/* An answer without payload. */
static kz_status answer_finish(kz_json *header) {
  answer_print(header, 0);
  return answer_send();
}

/* The value of a key. All but words are printed as JSON. */
static kz_json *value_of(const kz_key *key, const kz_scene *scene) {
  char *text = NULL;
  size_t bytes = 0;
  FILE *out = open_memstream(&text, &bytes);
  if (!out) return NULL;
  kz_value_print(key, scene, out);
  fclose(out);
  kz_json *value = key->type == KZ_KEY_WORD ? kz_json_text(text) : json_tokener_parse(text);
  free(text);
  return value;
}

/* The keys of a mapping ("pendulum.") that the scene gives. */
static kz_json *mapping_of(const char *mapping, const kz_scene *scene) {
  kz_json *object = json_object_new_object();
  for (const kz_key *key = kz_scene_keys(); key->path; key++) {
    const char *name = key->path + strlen(mapping);
    if (strncmp(key->path, mapping, strlen(mapping)) != 0 || strchr(name, '.') || !kz_value_is_set(key, scene))
      continue;
    char inner[64];
    snprintf(inner, sizeof inner, "%s.", key->path);
    kz_json_add(object, name, key->type == KZ_KEY_MAPPING ? mapping_of(inner, scene) : value_of(key, scene));
  }
  return object;
}

static kz_json *axis_of(const kz_axis *axis) {
  kz_json *object = json_object_new_object();
  kz_json_add_real(object, "min", axis->min);
  kz_json_add_real(object, "max", axis->max);
  kz_json_add_integer(object, "count", axis->count);
  return object;
}

kz_status kz_answer_ready(const kz_scene *scene) {
  kz_json *header = answer_begin("ready", KZ_UNSET_INTEGER, true), *window = json_object_new_object();
  kz_json_add_integer(header, "protocol", 1);
  kz_json_add_text(header, "program", KZ_VERSION);
  kz_json_add_text(header, "title", scene->title);
  kz_json_add(header, "pendulum", mapping_of("pendulum.", scene));
  kz_json_add(window, "theta", axis_of(&scene->basin->theta));
  kz_json_add(window, "velocity", axis_of(&scene->basin->velocity));
  kz_json_add(header, "window", window);
  return answer_finish(header);
}

/* As KINDS of the figures' style has them. */
static const char *kind_of(const kz_attractor *row) {
  if (kz_is_running(row)) return row->winding > 0 ? "running +" : "running -";
  if (row->period == 0) return "chaotic";
  switch (row->centre) {
    case KZ_ROTATING:
      return row->winding > 0 ? "rotation +" : "rotation -";
    case KZ_ABOUT_INVERTED:
      return row->period == 1 ? "inverted" : row->period == 2 ? "flutter" : "inverted nodding";
    case KZ_ABOUT_DOWN:
      return row->period == 1 ? "down" : "down nodding";
    default:
      return "other";
  }
}

static const char *const CENTRES[] = {[KZ_ABOUT_DOWN] = "down",
                                      [KZ_ABOUT_INVERTED] = "inverted",
                                      [KZ_ROTATING] = "rotating",
                                      [KZ_ABOUT_NEITHER] = "neither"};

static kz_json *strobe_of(int64_t n, const double *theta, const double *velocity) {
  kz_json *strobe = json_object_new_array();
  for (int64_t i = 0; i < n; i++) json_object_array_add(strobe, kz_json_pair(theta[i], velocity[i]));
  return strobe;
}

static kz_json *attractor_of(const kz_entry *entry, int64_t id, int64_t track) {
  const kz_attractor *row = &entry->row;
  kz_json *object = json_object_new_object();
  kz_json_add_integer(object, "id", id);
  kz_json_add_integer(object, "track", track);
  kz_json_add_text(object, "name", entry->name);
  kz_json_add_text(object, "kind", kind_of(row));
  kz_json_add_integer(object, "period", row->period);
  kz_json_add_integer(object, "winding", row->winding);
  kz_json_add_text(object, "centre", CENTRES[row->centre]);
  kz_json_add_boolean(object, "symmetric", row->symmetric);
  kz_json_add_integer(object, "mirror", entry->mirror);
  kz_json_add_real(object, "mean_velocity", row->mean_velocity);
  kz_json_add_real(object, "multiplier", row->period > 0 ? hypot(row->multiplier_re[0], row->multiplier_im[0]) : NAN);
  kz_json_add(object, "strobe", strobe_of(row->period, entry->theta, entry->velocity));
  return object;
}

static kz_json *pendulum_of(const kz_parameters *p) {
  kz_json *object = json_object_new_object();
  kz_json_add_real(object, "k", p->pendulum.k);
  kz_json_add_real(object, "damping", p->pendulum.beta);
  kz_json_add_real(object, "m", p->pendulum.m);
  kz_json_add_real(object, "quality_factor", p->quality_factor);
  kz_json_add_real(object, "drive_frequency", p->drive_frequency);
  kz_json_add_real(object, "drive_amplitude", p->drive_amplitude);
  return object;
}

kz_status kz_answer_catalogue(int64_t sequence, bool final, const kz_live_catalogue *catalogue) {
  kz_json *header = answer_begin("catalogue", sequence, final), *list = json_object_new_array();
  kz_json_add_integer(header, "version", catalogue->version);
  kz_json_add(header, "pendulum", pendulum_of(&catalogue->parameters));
  for (int64_t i = 0; i < catalogue->list.count; i++)
    json_object_array_add(list, attractor_of(catalogue->list.entries + i, i, catalogue->track[i]));
  kz_json_add(header, "attractors", list);
  return answer_finish(header);
}

/* Of a frame or chart: its coarseness and its cells. */
static void add_raster(kz_json *header, int64_t coarseness, int64_t rows, int64_t columns) {
  kz_json_add_integer(header, "level", coarseness);
  kz_json_add_integer(header, "rows", rows);
  kz_json_add_integer(header, "columns", columns);
}

kz_status kz_answer_raster(const kz_request *request, bool final, const kz_live_raster *raster) {
  static const char *const names[] = {"labels", "settling_time", "smooth_time", "doubt", "other", "turns", "evidence"};
  const size_t cells = (size_t)(raster->rows * raster->columns);
  size_t bytes = 0;
  kz_json *header = answer_begin("frame", request->sequence, final), *planes = json_object_new_array();
  add_raster(header, raster->coarseness, raster->rows, raster->columns);
  kz_json_add_integer(header, "catalogue", raster->catalogue->version);
  kz_json_add_text(header, "quality", request->quality == KZ_QUALITY_MOVING ? "moving" : "exact");
  kz_json_add_real(header, "milliseconds", rint(1e6 * raster->seconds) / 1e3);
  for (int64_t i = 0; i < request->planes.count; i++) {
    json_object_array_add(planes, kz_json_text(names[request->planes.values[i]]));
    bytes += cells * kz_plane_bytes((int)request->planes.values[i]);
  }
  kz_json_add(header, "planes", planes);
  answer_print(header, bytes);
  for (int64_t i = 0; i < request->planes.count; i++)
    fwrite(raster->plane[request->planes.values[i]], kz_plane_bytes((int)request->planes.values[i]), cells, stdout);
  return answer_send();
}

kz_status kz_answer_where(int64_t sequence, const kz_coordinate start[2], const kz_ending *ending, double omega) {
  kz_json *header = answer_begin("where", sequence, true);
  kz_ending_add(header, start, ending, omega);
  return answer_finish(header);
}

/* The pivot's path over a drive period. */
static kz_json *pivot_of(const kz_parameters *parameters, int64_t samples) {
  kz_json *path = json_object_new_array();
  for (int64_t i = 0; i < samples; i++) {
    double place[2];
    kz_pivot_at(parameters, 2 * M_PI * (double)i / (double)samples, place);
    json_object_array_add(path, kz_json_pair(place[0], place[1]));
  }
  return path;
}

kz_status kz_answer_orbit(const kz_request *request, int64_t samples, const double *theta, const double *velocity) {
  const kz_orbit_plan *plan = request->scene.orbit;
  const kz_pendulum *p = &request->scene.parameters.pendulum;
  kz_json *header = answer_begin("orbit", request->sequence, true);
  kz_json_add_integer(header, "samples", samples);
  kz_json_add_integer(header, "samples_per_period", plan->samples_per_period);
  kz_json_add_integer(header, "transient", plan->transient);
  kz_json_add_real(header, "k", p->k);
  kz_json_add_real(header, "damping", p->beta);
  kz_json_add_real(header, "m", p->m);
  kz_json_add(header, "pivot", pivot_of(&request->scene.parameters, plan->samples_per_period));
  answer_print(header, 2 * (size_t)samples * sizeof *theta);
  fwrite(theta, sizeof *theta, (size_t)samples, stdout);
  fwrite(velocity, sizeof *velocity, (size_t)samples, stdout);
  return answer_send();
}

kz_status kz_answer_plane(int64_t sequence, bool final, const kz_plane_raster *raster) {
  const size_t cells = (size_t)(raster->rows * raster->columns);
  kz_json *header = answer_begin("chart", sequence, final);
  add_raster(header, raster->coarseness, raster->rows, raster->columns);
  kz_json_add(header, "planes", kz_json_texts((const char *const[]){"period", "centre", NULL}));
  answer_print(header, 2 * cells);
  fwrite(raster->period, 1, cells, stdout);
  fwrite(raster->centre, 1, cells, stdout);
  return answer_send();
}

/* What motions and branches have in common. */
static void add_kind(kz_json *object, const kz_motion_kind *of) {
  kz_json_add_text(object, "name", of->name);
  kz_json_add_integer(object, "period", of->period);
  kz_json_add_integer(object, "winding", of->winding);
  kz_json_add_text(object, "centre", CENTRES[of->centre]);
  kz_json_add_boolean(object, "symmetric", of->symmetric);
  kz_json_add_integer(object, "images", of->images);
}

static kz_json *motion_of(const kz_motion *motion) {
  kz_json *object = json_object_new_object(), *multipliers = json_object_new_array();
  add_kind(object, &motion->of);
  kz_json_add(object, "curve", motion->curve < 0 ? NULL : json_object_new_int64(motion->curve));
  for (int i = 0; i < 2 && motion->strobes > 0; i++)
    json_object_array_add(multipliers, kz_json_pair(motion->multiplier_re[i], motion->multiplier_im[i]));
  kz_json_add(object, "multipliers", multipliers);
  kz_json_add(object, "strobe", strobe_of(motion->strobes, motion->theta, motion->velocity));
  return object;
}

kz_status kz_answer_motions(int64_t sequence, const kz_motions *motions) {
  kz_json *header = answer_begin("motions", sequence, true), *list = json_object_new_array();
  kz_json_add_real(header, "x", motions->x);
  kz_json_add_real(header, "y", motions->y);
  kz_json_add_real(header, "k", motions->pendulum.k);
  kz_json_add_real(header, "damping", motions->pendulum.beta);
  kz_json_add_real(header, "m", motions->pendulum.m);
  for (int64_t i = 0; i < motions->count; i++) json_object_array_add(list, motion_of(motions->motion + i));
  kz_json_add(header, "motions", list);
  return answer_finish(header);
}

kz_status kz_answer_line(int64_t sequence, const kz_atlas_branches *line) {
  kz_json *header = answer_begin("line", sequence, true), *list = json_object_new_array();
  const size_t values = (size_t)line->n_points * KZ_LINE_COLUMNS;
  for (int64_t i = 0; i < line->count; i++) {
    kz_json *object = json_object_new_object();
    add_kind(object, &line->branch[i].of);
    kz_json_add_integer(object, "first", line->branch[i].first);
    kz_json_add_integer(object, "points", line->branch[i].points);
    json_object_array_add(list, object);
  }
  kz_json_add(header, "branches", list);
  kz_json_add(header, "columns",
              kz_json_texts((const char *const[]){"value", "height", "theta", "velocity", "multiplier", NULL}));
  answer_print(header, values * sizeof(double));
  if (values > 0) fwrite(line->point, sizeof(double), values, stdout);
  return answer_send();
}

kz_status kz_answer_ended(int64_t sequence) {
  return answer_finish(answer_begin("ended", sequence, true));
}

kz_status kz_answer_error(int64_t sequence, kz_status status) {
  kz_json *header = answer_begin("error", sequence, true);
  kz_json_add_integer(header, "status", status);
  kz_json_add_text(header, "message", kz_message());
  kz_message_clear();
  return answer_finish(header);
}

enum { GRACE = 1 /* seconds in which the program ends by itself */ };

/* poll() reports the closed far end of a pipe as POLLERR, an event that is reported without having been requested. A
 * regular file has no far end, and poll() never reports it. */
static void *answer_watch(void *unused) {
  struct pollfd output = {.fd = STDOUT_FILENO};
  (void)unused;
  while (poll(&output, 1, -1) < 0 && errno == EINTR) continue;
  sleep(GRACE);
  _exit(0);
}

kz_status kz_answer_watch(void) {
  pthread_t thread;
  const int error = pthread_create(&thread, NULL, answer_watch, NULL);
  if (error) return kz_fail(KZ_FAILED, "serve: no thread can be started: %s", strerror(error));
  pthread_detach(thread);
  return KZ_OK;
}
