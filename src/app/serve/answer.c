#include "answer.h"

#include <errno.h>
#include <math.h>
#include <string.h>

#include "../app.h"
#include "kapitza/version.h"

/* The members that every header has. */
static void begin(const char *answer, int64_t sequence, bool final) {
  printf("{\"answer\": \"%s\", \"sequence\": ", answer);
  if (sequence == KZ_UNSET_INTEGER)
    fputs("null", stdout);
  else
    printf("%lld", (long long)sequence);
  printf(", \"final\": %s", final ? "true" : "false");
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

static void number(const char *name, double value) {
  char text[32];
  kz_scalar_print(value, text);
  printf("\"%s\": %s", name, isfinite(value) ? text : "null");
}

static void text(const char *name, const char *value) {
  printf("\"%s\": \"", name);
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

static void print_axis(const char *name, const kz_axis *axis) {
  printf("\"%s\": {", name);
  number("min", axis->min);
  fputs(", ", stdout);
  number("max", axis->max);
  printf(", \"count\": %lld}", (long long)axis->count);
}

kz_status kz_answer_ready(const kz_scene *scene) {
  begin("ready", KZ_UNSET_INTEGER, true);
  fputs(", \"protocol\": 1, ", stdout);
  text("program", KZ_VERSION);
  fputs(", ", stdout);
  text("title", scene->title);
  fputs(", \"pendulum\": ", stdout);
  print_mapping("pendulum.", scene);
  fputs(", \"window\": {", stdout);
  print_axis("theta", &scene->basin.theta);
  fputs(", ", stdout);
  print_axis("velocity", &scene->basin.velocity);
  putchar('}');
  end(0);
  return send();
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
  printf("%s{\"id\": %lld, \"track\": %lld, ", id > 0 ? ", " : "", (long long)id, (long long)track);
  text("name", entry->name);
  printf(", \"kind\": \"%s\", \"period\": %d, \"winding\": %d, \"centre\": \"%s\", \"symmetric\": %s, \"mirror\": %d, ",
         kind_of(row), (int)row->period, (int)row->winding, centres[row->centre], row->symmetric ? "true" : "false",
         (int)entry->mirror);
  number("multiplier", row->period > 0 ? hypot(row->multiplier_re[0], row->multiplier_im[0]) : NAN);
  fputs(", \"strobe\": [", stdout);
  for (int i = 0; i < row->period; i++) {
    char theta[32], velocity[32];
    kz_scalar_print(entry->theta[i], theta);
    kz_scalar_print(entry->velocity[i], velocity);
    printf("%s[%s, %s]", i > 0 ? ", " : "", theta, velocity);
  }
  fputs("]}", stdout);
}

kz_status kz_answer_catalogue(int64_t sequence, bool final, const kz_live_catalogue *catalogue) {
  const kz_parameters *p = &catalogue->parameters;
  const struct {
    const char *name;
    double value;
  } numbers[] = {{"k", p->pendulum.k},
                 {"damping", p->pendulum.beta},
                 {"m", p->pendulum.m},
                 {"quality_factor", p->quality_factor},
                 {"drive_frequency", p->drive_frequency},
                 {"drive_amplitude", p->drive_amplitude}};
  begin("catalogue", sequence, final);
  printf(", \"version\": %lld, \"pendulum\": {", (long long)catalogue->version);
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
    if (i > 0) fputs(", ", stdout);
    number(numbers[i].name, numbers[i].value);
  }
  fputs("}, \"attractors\": [", stdout);
  for (int64_t i = 0; i < catalogue->list.count; i++) print_attractor(catalogue->list.entries + i, i, catalogue->track[i]);
  putchar(']');
  end(0);
  return send();
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
  end(0);
  return send();
}

/* The pivot's path over a drive period. */
static void print_pivot(const kz_scene *scene) {
  fputs(", \"pivot\": [", stdout);
  for (int64_t i = 0; i < scene->orbit.samples_per_period; i++) {
    char aside[32], height[32];
    double place[2];
    kz_pivot_at(&scene->parameters, (double)i / (double)scene->orbit.samples_per_period, place);
    kz_scalar_print(place[0], aside);
    kz_scalar_print(place[1], height);
    printf("%s[%s, %s]", i > 0 ? ", " : "", aside, height);
  }
  putchar(']');
}

kz_status kz_answer_orbit(const kz_request *request, int64_t samples, const double *theta, const double *velocity) {
  const kz_orbit_plan *plan = &request->scene.orbit;
  const kz_pendulum *p = &request->scene.parameters.pendulum;
  begin("orbit", request->sequence, true);
  printf(", \"samples\": %lld, \"samples_per_period\": %lld, \"transient\": %lld, ", (long long)samples,
         (long long)plan->samples_per_period, (long long)plan->transient);
  number("k", p->k);
  fputs(", ", stdout);
  number("damping", p->beta);
  fputs(", ", stdout);
  number("m", p->m);
  print_pivot(&request->scene);
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
  end(0);
  return send();
}

kz_status kz_answer_error(int64_t sequence, kz_status status) {
  begin("error", sequence, true);
  printf(", \"status\": %d, ", (int)status);
  text("message", kz_message());
  kz_message_clear();
  end(0);
  return send();
}
