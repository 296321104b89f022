#include "answer.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <string.h>
#include <unistd.h>

#include "../app.h"
#include "kapitza/version.h"

/* The members that every header has. */
static void begin(const char *answer, int64_t sequence, bool final) {
  char text[24] = "null";
  if (sequence != KZ_UNSET_INTEGER) snprintf(text, sizeof text, "%lld", (long long)sequence);
  printf("{\"answer\": \"%s\", \"sequence\": %s, \"final\": %s", answer, text, final ? "true" : "false");
}

/* Ends the header; the payload's bytes come next. */
static void end(size_t bytes) {
  printf(", \"bytes\": %zu}\n", bytes);
}

/* A reader that has gone ends the program as the end of its requests does. */
static kz_status send(void) {
  if (fflush(stdout) == 0) return KZ_OK;
  return errno == EPIPE ? KZ_STOPPED : kz_fail(KZ_FAILED, "standard output cannot be written: %s", strerror(errno));
}

/* Ends an answer without payload. */
static kz_status finish(void) {
  end(0);
  return send();
}

/* A number as JSON, with all digits that distinguish it; "null" if it is not finite. */
#define NUMBER(value) number(value).text
static kz_short_text number(double value) {
  return isfinite(value) ? kz_shortest(value) : (kz_short_text){"null"};
}

static void text(const char *name, const char *value) {
  printf(", \"%s\": \"", name);
  kz_json_text(stdout, value);
  putchar('"');
}

/* The keys of a mapping ("pendulum.") that the scene gives. */
static void print_mapping(const char *mapping, const kz_scene *scene) {
  bool first = true;
  putchar('{');
  for (const kz_key *key = kz_keys; key->path; key++) {
    const char *name = key->path + strlen(mapping), *quote = key->type == KZ_KEY_WORD ? "\"" : "";
    if (strncmp(key->path, mapping, strlen(mapping)) != 0 || strchr(name, '.') || !kz_value_is_set(key, scene)) continue;
    printf("%s\"%s\": %s", first ? "" : ", ", name, quote);
    if (key->type == KZ_KEY_MAPPING) {
      char inner[64];
      snprintf(inner, sizeof inner, "%s.", key->path);
      print_mapping(inner, scene);
    } else {
      kz_value_print(key, scene, stdout);
    }
    fputs(quote, stdout);
    first = false;
  }
  putchar('}');
}

kz_status kz_answer_ready(const kz_scene *scene) {
  const kz_axis *theta = &scene->basin.theta, *velocity = &scene->basin.velocity;
  begin("ready", KZ_UNSET_INTEGER, true);
  fputs(", \"protocol\": 1", stdout);
  text("program", KZ_VERSION);
  text("title", scene->title);
  fputs(", \"pendulum\": ", stdout);
  print_mapping("pendulum.", scene);
  printf(", \"window\": {\"theta\": {\"min\": %s, \"max\": %s, \"count\": %lld}, ", NUMBER(theta->min), NUMBER(theta->max),
         (long long)theta->count);
  printf("\"velocity\": {\"min\": %s, \"max\": %s, \"count\": %lld}}", NUMBER(velocity->min), NUMBER(velocity->max),
         (long long)velocity->count);
  return finish();
}

/* As KINDS of the figures' style has them. */
static const char *kind_of(const kz_attractor *row) {
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

static void print_attractor(const kz_entry *entry, int64_t id, int64_t track) {
  static const char *const centres[] = {
      [KZ_ABOUT_DOWN] = "down", [KZ_ABOUT_INVERTED] = "inverted", [KZ_ROTATING] = "rotating", [KZ_ABOUT_NEITHER] = "neither"};
  const kz_attractor *row = &entry->row;
  printf("%s{\"id\": %lld, \"track\": %lld", id > 0 ? ", " : "", (long long)id, (long long)track);
  text("name", entry->name);
  printf(", \"kind\": \"%s\", \"period\": %d, \"winding\": %d, \"centre\": \"%s\", \"symmetric\": %s, \"mirror\": %d, ",
         kind_of(row), (int)row->period, (int)row->winding, centres[row->centre], row->symmetric ? "true" : "false",
         (int)entry->mirror);
  printf("\"multiplier\": %s, \"strobe\": [",
         NUMBER(row->period > 0 ? hypot(row->multiplier_re[0], row->multiplier_im[0]) : NAN));
  for (int i = 0; i < row->period; i++)
    printf("%s[%s, %s]", i > 0 ? ", " : "", NUMBER(entry->theta[i]), NUMBER(entry->velocity[i]));
  fputs("]}", stdout);
}

kz_status kz_answer_catalogue(int64_t sequence, bool final, const kz_live_catalogue *catalogue) {
  const kz_parameters *p = &catalogue->parameters;
  begin("catalogue", sequence, final);
  printf(", \"version\": %lld, \"pendulum\": {\"k\": %s, \"damping\": %s, \"m\": %s, ", (long long)catalogue->version,
         NUMBER(p->pendulum.k), NUMBER(p->pendulum.beta), NUMBER(p->pendulum.m));
  printf("\"quality_factor\": %s, \"drive_frequency\": %s, \"drive_amplitude\": %s}, \"attractors\": [",
         NUMBER(p->quality_factor), NUMBER(p->drive_frequency), NUMBER(p->drive_amplitude));
  for (int64_t i = 0; i < catalogue->list.count; i++) print_attractor(catalogue->list.entries + i, i, catalogue->track[i]);
  putchar(']');
  return finish();
}

kz_status kz_answer_level(const kz_request *request, bool final, const kz_live_level *level) {
  static const char *const names[] = {"labels", "settling_time", "smooth_time", "doubt", "other"};
  const char *quality = request->quality == KZ_QUALITY_MOVING ? "moving" : "exact";
  const size_t cells = (size_t)(level->rows * level->columns);
  size_t bytes = 0;
  begin("frame", request->sequence, final);
  printf(
      ", \"level\": %lld, \"rows\": %lld, \"columns\": %lld, \"catalogue\": %lld, \"quality\": \"%s\", \"milliseconds\": %.3f, "
      "\"planes\": [",
      (long long)level->level, (long long)level->rows, (long long)level->columns, (long long)level->catalogue->version, quality,
      1e3 * level->seconds);
  for (int64_t i = 0; i < request->planes.count; i++) {
    printf("%s\"%s\"", i > 0 ? ", " : "", names[request->planes.values[i]]);
    bytes += cells * kz_plane_bytes((int)request->planes.values[i]);
  }
  putchar(']');
  end(bytes);
  for (int64_t i = 0; i < request->planes.count; i++)
    fwrite(level->plane[request->planes.values[i]], kz_plane_bytes((int)request->planes.values[i]), cells, stdout);
  return send();
}

kz_status kz_answer_where(int64_t sequence, const kz_coordinate start[2], const kz_ending *ending, double omega) {
  begin("where", sequence, true);
  fputs(", ", stdout);
  kz_ending_print(start, ending, omega);
  return finish();
}

kz_status kz_answer_orbit(const kz_request *request, int64_t samples, const double *theta, const double *velocity) {
  const kz_orbit_plan *plan = &request->scene.orbit;
  const kz_pendulum *p = &request->scene.parameters.pendulum;
  begin("orbit", request->sequence, true);
  printf(", \"samples\": %lld, \"samples_per_period\": %lld, \"transient\": %lld, ", (long long)samples,
         (long long)plan->samples_per_period, (long long)plan->transient);
  printf("\"k\": %s, \"damping\": %s, \"m\": %s, \"pivot\": [", NUMBER(p->k), NUMBER(p->beta), NUMBER(p->m));
  for (int64_t i = 0; i < plan->samples_per_period; i++) { /* the pivot's path over a drive period */
    double place[2];
    kz_pivot_at(&request->scene.parameters, 2 * M_PI * (double)i / (double)plan->samples_per_period, place);
    printf("%s[%s, %s]", i > 0 ? ", " : "", NUMBER(place[0]), NUMBER(place[1]));
  }
  putchar(']');
  end(2 * (size_t)samples * sizeof *theta);
  fwrite(theta, sizeof *theta, (size_t)samples, stdout);
  fwrite(velocity, sizeof *velocity, (size_t)samples, stdout);
  return send();
}

kz_status kz_answer_chart(int64_t sequence, bool final, const kz_chart_level *level) {
  const size_t cells = (size_t)(level->rows * level->columns);
  begin("chart", sequence, final);
  printf(", \"level\": %lld, \"rows\": %lld, \"columns\": %lld, \"planes\": [\"period\", \"centre\"]", (long long)level->level,
         (long long)level->rows, (long long)level->columns);
  end(2 * cells);
  fwrite(level->period, 1, cells, stdout);
  fwrite(level->centre, 1, cells, stdout);
  return send();
}

kz_status kz_answer_ended(int64_t sequence) {
  begin("ended", sequence, true);
  return finish();
}

kz_status kz_answer_error(int64_t sequence, kz_status status) {
  begin("error", sequence, true);
  printf(", \"status\": %d", (int)status);
  text("message", kz_message());
  kz_message_clear();
  return finish();
}

enum { GRACE = 1 /* seconds in which the program ends by itself */ };

/* A pipe without a reader says so without being asked; a file never does. */
static void *watch(void *unused) {
  struct pollfd output = {.fd = STDOUT_FILENO};
  (void)unused;
  while (poll(&output, 1, -1) < 0 && errno == EINTR) continue;
  sleep(GRACE);
  _exit(0);
}

kz_status kz_answer_watch(void) {
  pthread_t thread;
  const int error = pthread_create(&thread, NULL, watch, NULL);
  if (error) return kz_fail(KZ_FAILED, "serve: no thread can be started: %s", strerror(error));
  pthread_detach(thread);
  return KZ_OK;
}
