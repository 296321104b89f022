/* Reports about a scene or about the program: check, keys, --version, warnings, the message at the end. */
#include "app.h"
#include "json.h"
#include "kapitza/version.h"
#include "../study/numerics/cells.h"

/* ---- the variables of the result file ---- */

static const char *const kinds[] = {
    [KZ_REAL] = "float64", [KZ_INT8] = "int8",     [KZ_UINT8] = "uint8", [KZ_INT16] = "int16",
    [KZ_INT32] = "int32",  [KZ_UINT32] = "uint32", [KZ_TEXT] = "text",
};

/* As kz_variable has units: "UNIT", "UNIT|WORDS", or "@NAME" of an attribute of the group. */
static void add_units(kz_json *object, const kz_variable *row) {
  char unit[64], name[256];
  const char *words = strchr(row->units, '|');
  snprintf(unit, sizeof unit, "%.*s", (int)strcspn(row->units, "|"), row->units);
  snprintf(name, sizeof name, "%s%s%s", row->long_name, words ? ", in " : "", words ? words + 1 : "");
  kz_json_add_text(object, "units", unit);
  kz_json_add_text(object, "long_name", name);
}

static kz_json *layout_of(const char *group, const kz_variable *row) {
  kz_json *object = json_object_new_object();
  kz_json_add_text(object, "group", group);
  kz_json_add_text(object, "name", row->name);
  kz_json_add_text(object, "type", kinds[row->kind]);
  kz_json_add(object, "dimensions", kz_json_texts(row->dimensions));
  add_units(object, row);
  kz_json_add(object, "flags", kz_json_texts(row->flags));
  return object;
}

/* Prints the variables of the result file, a line of JSON each (docs/reference/commands.md). */
static void print_layout(FILE *out) {
  for (const kz_group *group = kz_groups; group->name; group++)
    for (const kz_variable *row = group->variables; row->name; row++)
      kz_json_print(layout_of(row->group ? row->group : group->name, row), out);
}

char *kz_scene_text(const kz_scene *scene, bool fingerprint) {
  char *text = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&text, &size);
  if (!out) return NULL;
  kz_scene_write(kz_scene_keys(), scene, fingerprint, out);
  if (fingerprint)
    fprintf(out, "program version: %s\ngit revision: %s\ninstruction set: %s\n", KZ_VERSION, KZ_GIT_REVISION,
            kz_instruction_names());
  if (fclose(out) == 0) return text;
  free(text);
  return NULL;
}

void kz_warnings_print(const kz_scene *scene, FILE *out) {
  if (scene->basin->table_is_idle)
    fputs("warning: basin.icm: is not used by this basin.method; leave it out, or choose basin.method: icm\n", out);
  if (scene->bare[0]) fprintf(out, "note: pendulum: numbers without a unit are taken so: %s\n", scene->bare);
  kz_settling_warn(scene, out);
}

static void print_studies(const kz_scene *scene, FILE *out) {
  const char *before = "studies          ";
  for (int i = 0; i < kz_study_count; i++) {
    if (kz_study_is_part(kz_studies[i]) || !kz_study_is_wanted(kz_studies[i], scene)) continue;
    fprintf(out, "%s%s", before, kz_studies[i]->name);
    if (kz_studies[i] == &kz_basin_study)
      fprintf(out, " (%s)",
              isnan(scene->basin->accuracy) ? kz_method_names[scene->basin->method] : "method by basin.accuracy");
    before = ", ";
  }
}

/* Five lines at most, then warnings; the rest for `all`. */
static void print_check(const kz_options *options, const kz_scene *scene, const char *resolved, FILE *out) {
  const kz_cost cost = kz_cost_of(scene);
  const kz_pendulum *p = &scene->parameters.pendulum;
  fprintf(out, "%s is a valid scene.\n", options->scene);
  print_studies(scene, out);
  if (cost.cells > 0) fprintf(out, ", %lld cells", (long long)cost.cells);
  fputs("\n", out);
  if (!isnan(p->k)) fprintf(out, "pendulum         k = %.10g, beta = %.10g, m = %.10g\n", p->k, p->beta, p->m);
  kz_rest_print(&scene->parameters, out);
  fprintf(out, "cost             %s of memory, %s on disk\n",
          kz_cost_bytes(cost.memory_bytes + cost.rank0_bytes + cost.shared_bytes).text,
          kz_cost_bytes(cost.disk_bytes).text);
  kz_warnings_print(scene, out);
  if (!options->all) return;
  fprintf(out, "memory per rank  %s, %s more on rank 0, and a share of %s\n", kz_cost_bytes(cost.memory_bytes).text,
          kz_cost_bytes(cost.rank0_bytes).text, kz_cost_bytes(cost.shared_bytes).text);
  kz_drive_print(&scene->parameters, out);
  kz_symmetries_print(p, out);
  fprintf(out, "\n%s", resolved);
}

static kz_json *studies_of(const kz_scene *scene) {
  kz_json *list = json_object_new_array();
  for (int i = 0; i < kz_study_count; i++)
    if (!kz_study_is_part(kz_studies[i]) && kz_study_is_wanted(kz_studies[i], scene))
      json_object_array_add(list, kz_json_text(kz_studies[i]->name));
  return list;
}

/* Writes the report for programs, as one object on a line. */
static void print_check_json(const kz_options *options, const kz_scene *scene, const char *resolved) {
  const kz_cost cost = kz_cost_of(scene);
  const kz_pendulum *p = &scene->parameters.pendulum;
  KZ_AUTOFREE char *text = NULL;
  size_t bytes = 0;
  kz_json *object = json_object_new_object(), *pendulum = json_object_new_object();
  FILE *out = open_memstream(&text, &bytes);
  if (out) {
    print_check(options, scene, resolved, out);
    fclose(out);
  }
  kz_json_add_text(object, "scene", resolved);
  kz_json_add_real(pendulum, "k", p->k);
  kz_json_add_real(pendulum, "beta", p->beta);
  kz_json_add_real(pendulum, "m", p->m);
  kz_json_add(object, "pendulum", pendulum);
  kz_json_add(object, "studies", studies_of(scene));
  kz_json_add_integer(object, "cells", cost.cells);
  kz_json_add_real(object, "disk_bytes", cost.disk_bytes);
  kz_json_add_real(object, "rank_bytes", cost.memory_bytes);
  kz_json_add_real(object, "rank0_bytes", cost.rank0_bytes);
  kz_json_add_real(object, "shared_bytes", cost.shared_bytes);
  kz_json_add_text(object, "text", text ? text : "");
  kz_json_print(object, stdout);
}

static kz_status check_scene(const kz_options *options, const kz_scene *scene) {
  char *resolved = kz_scene_text(scene, false);
  const kz_cost cost = kz_cost_of(scene);
  kz_status status = resolved ? kz_cost_check(&cost, NULL) : kz_fail(KZ_FAILED, "out of memory");
  if (status == KZ_OK) status = kz_studies_check(scene);
  if (status == KZ_OK && options->json)
    print_check_json(options, scene, resolved);
  else if (status == KZ_OK)
    print_check(options, scene, resolved, stdout);
  free(resolved);
  return status;
}

kz_status kz_scene_answer(const kz_options *options, kz_status (*answer)(const kz_options *, const kz_scene *)) {
  char *text;
  size_t length;
  kz_scene scene;
  if (!options->prints) return KZ_OK;
  KZ_TRY(kz_scene_load(options->scene, &text, &length));
  kz_status status = kz_scene_read(text, length, options->scene, options->n_sets, options->sets, &scene);
  if (status == KZ_OK) {
    status = kz_scene_locate(answer(options, &scene), text, length, options->scene, options->n_sets, options->sets);
    kz_scene_free(&scene);
  }
  free(text);
  return status;
}

kz_status kz_app_check(const kz_options *options) {
  return kz_scene_answer(options, check_scene);
}

kz_status kz_app_keys(const kz_options *options) {
  if (options->prints && options->layout)
    print_layout(stdout);
  else if (options->prints)
    (options->json_schema ? kz_scene_schema : kz_scene_reference)(kz_scene_keys(), stdout);
  return KZ_OK;
}

void kz_app_version(FILE *out) {
  fprintf(out, "kapitza %s (%s)\n", KZ_VERSION, KZ_GIT_REVISION);
  fprintf(out, "compiler         %s\n", KZ_COMPILER);
  fprintf(out, "instruction set  %s: %s\n", KZ_ARCH, kz_instruction_names());
  fprintf(out, "MPI              %s\nHDF5             %s\nGSL              %s\nFFTW             %s\n",
          kz_parallel_library(), KZ_HDF5_VERSION, KZ_GSL_VERSION, KZ_FFTW_VERSION);
}

/* One line whatever the message holds: control characters become '?'. */
static void print_message(kz_status status) {
  fputs(status == KZ_STOPPED ? "kapitza: " : "kapitza: error: ", stderr);
  for (const char *c = kz_message(); *c;) {
    const int control = kz_control_bytes(c);
    fputc(control ? '?' : *c, stderr);
    c += control ? control : 1;
  }
  fputc('\n', stderr);
}

kz_status kz_message_print(kz_status status) {
  if (fflush(stdout) != 0 && status == KZ_OK) status = kz_fail(KZ_FAILED, "standard output cannot be written");
  if (status != KZ_OK && kz_message()[0]) print_message(status);
  kz_message_clear();
  return status;
}
