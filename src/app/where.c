/* The command where: where starts end, for people, as CSV or as JSON. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app.h"

static void print_number(double value) {
  char text[32];
  kz_scalar_print(value, text);
  fputs(text, stdout);
}

static const char *words_of(const char *precision) {
  if (strcmp(precision, "pairs") == 0) return "pairs of doubles";
  if (strcmp(precision, "arbitrary") == 0) return "as many digits as needed";
  return strcmp(precision, "double") == 0 ? "double precision" : "quad precision";
}

static void print_decision(const kz_ending *e) {
  if (e->precision)
    printf("decided         yes, in %s", words_of(e->precision));
  else
    printf("decided         no: the start ends on %s or on %s, and quad precision cannot tell which", e->name,
           e->other_name[0] ? e->other_name : "another attractor");
  if (!isnan(e->error)) printf(" (error at most %.2g rad when the trapping region holds the orbit)", e->error);
  putchar('\n');
}

/* The start, with a note where its angle looks like degrees. */
static void print_start(const kz_coordinate start[2], double omega) {
  printf("theta = %.10g (%.6g deg), velocity = %.10g", start[0].high, start[0].high * 180 / M_PI, start[1].high);
  isnan(omega) ? puts("") : printf(" (%.6g rad/s)\n", start[1].high * omega);
  if (fabs(start[0].high) > 4 * M_PI)
    printf("note            an angle without a unit is in rad; write \"%.6g deg\" for degrees\n", start[0].high);
}

/* `omega`: of the pivot, rad/s; NaN where the scene is not in SI units, which are printed then too. */
static void print_person(const kz_coordinate start[2], const kz_ending *e, double omega) {
  const bool si = !isnan(omega);
  print_start(start, omega);
  if (e->attractor < 0) {
    puts("ends on         no known attractor: it has not settled");
    return;
  }
  printf("ends on         %s (attractor %d)\n", e->name, (int)e->attractor);
  printf("settling time   %lld drive periods", (long long)e->settling_time);
  si ? printf(" (%.4g s)\n", (double)e->settling_time * 2 * M_PI / omega) : puts("");
  print_decision(e);
  if (e->period == 0) {
    puts("period          none: chaotic");
    return;
  }
  printf("period          %d\nwinding         %d\nstrobe points   theta, velocity%s\n", (int)e->period, (int)e->winding,
         si ? ", in deg and rad/s" : "");
  for (int i = 0; i < e->period; i++) {
    printf("  %18.12f  %18.12f", e->strobe_theta[i], e->strobe_velocity[i]);
    si ? printf("  %12.6f  %12.6f\n", e->strobe_theta[i] * 180 / M_PI, e->strobe_velocity[i] * omega) : puts("");
  }
}

static void print_list(const char *name, int n, const double *values, double unit) {
  printf(", \"%s\": [", name);
  for (int i = 0; i < n; i++) {
    if (i > 0) fputs(", ", stdout);
    print_number(values[i] * unit);
  }
  putchar(']');
}

static void print_word(const char *name, const char *value) {
  const char *quote = value[0] ? "\"" : "";
  printf(", \"%s\": %s%s%s", name, quote, value[0] ? value : "null", quote);
}

/* What an SI scene adds: rad/s and seconds. */
static void print_si(const kz_coordinate start[2], const kz_ending *e, double omega) {
  fputs(", \"velocity_rad_per_s\": ", stdout);
  print_number(start[1].high * omega);
  fputs(", \"settling_seconds\": ", stdout);
  if (e->attractor < 0)
    fputs("null", stdout);
  else
    print_number((double)e->settling_time * 2 * M_PI / omega);
  print_list("strobe_velocity_rad_per_s", e->period, e->strobe_velocity, omega);
}

void kz_ending_print(const kz_coordinate start[2], const kz_ending *e, double omega) {
  fputs("\"theta\": ", stdout);
  print_number(start[0].high);
  fputs(", \"velocity\": ", stdout);
  print_number(start[1].high);
  printf(", \"attractor\": %d", (int)e->attractor);
  if (e->attractor < 0)
    fputs(", \"name\": null, \"period\": null, \"winding\": null, \"settling_time\": null", stdout);
  else
    printf(", \"name\": \"%s\", \"period\": %d, \"winding\": %d, \"settling_time\": %lld", e->name, (int)e->period,
           (int)e->winding, (long long)e->settling_time);
  printf(", \"decided\": %s", e->precision ? "true" : "false");
  print_list("strobe_theta", e->period, e->strobe_theta, 1);
  print_list("strobe_velocity", e->period, e->strobe_velocity, 1);
  print_word("precision", e->precision ? e->precision : "");
  fputs(", \"error\": ", stdout);
  if (isnan(e->error))
    fputs("null", stdout);
  else
    print_number(e->error);
  printf(", \"other_attractor\": %d", (int)e->other);
  print_word("other_name", e->other_name);
  if (!isnan(omega)) print_si(start, e, omega);
}

static void print_json(const kz_coordinate start[2], const kz_ending *e, double omega) {
  putchar('{');
  kz_ending_print(start, e, omega);
  puts("}");
}

/* A row has the first strobe point of the orbit; columns without a value stay empty. */
static void print_csv(const kz_coordinate start[2], const kz_ending *e, double omega) {
  print_number(start[0].high);
  putchar(',');
  print_number(start[1].high);
  printf(",%d,", (int)e->attractor);
  if (e->attractor < 0)
    fputs(",,,", stdout);
  else
    printf("%s,%d,%d,%lld", e->name, (int)e->period, (int)e->winding, (long long)e->settling_time);
  printf(",%s,", e->precision ? "true" : "false");
  if (e->period > 0) print_number(e->strobe_theta[0]);
  putchar(',');
  if (e->period > 0) print_number(e->strobe_velocity[0]);
  printf(",%s,", e->precision ? e->precision : "");
  if (!isnan(e->error)) print_number(e->error);
  printf(",%d,%s", (int)e->other, e->other_name);
  if (!isnan(omega)) {
    putchar(',');
    print_number(start[1].high * omega);
    putchar(',');
    if (e->attractor >= 0) print_number((double)e->settling_time * 2 * M_PI / omega);
    putchar(',');
    if (e->period > 0) print_number(e->strobe_velocity[0] * omega);
  }
  putchar('\n');
}

static void print_endings(const kz_options *options, const kz_starts *starts, const kz_ending *endings) {
  const bool table = options->n_operands == 2;
  const double omega = starts->pivot_frequency;
  if (table && !options->json)
    printf(
        "theta,velocity,attractor,name,period,winding,settling_time,decided,strobe_theta,strobe_velocity,"
        "precision,error,other_attractor,other_name%s\n",
        isnan(omega) ? "" : ",velocity_rad_per_s,settling_seconds,strobe_velocity_rad_per_s");
  for (int64_t i = 0; i < starts->n; i++) {
    const kz_coordinate *start = starts->start[i];
    if (options->json || table)
      (options->json ? print_json : print_csv)(start, endings + i, omega);
    else
      print_person(start, endings + i, omega);
  }
}

static kz_status answer_where(const kz_options *options, const kz_scene *scene, const kz_starts *starts) {
  kz_ending *endings = kz_calloc((size_t)starts->n, sizeof *endings);
  const kz_status status = kz_where(scene, starts->n, starts->start, endings);
  if (status == KZ_OK) print_endings(options, starts, endings);
  kz_where_free(starts->n, endings);
  free(endings);
  return status;
}

static kz_status answer_boundary(const kz_options *options, const kz_scene *scene, const kz_starts *starts) {
  kz_boundary_point point;
  KZ_TRY(kz_where_boundary(scene, starts->start, options->boundary, &point));
  if (options->json)
    printf("{\"theta\": \"%s\", \"velocity\": \"%s\", \"attractors\": [%d, %d], \"names\": [\"%s\", \"%s\"]}\n", point.theta,
           point.velocity, (int)point.attractor[0], (int)point.attractor[1], point.name[0], point.name[1]);
  else
    printf("theta     %s\nvelocity  %s\nbetween   %s (attractor %d) and %s (attractor %d)\n", point.theta, point.velocity,
           point.name[0], (int)point.attractor[0], point.name[1], (int)point.attractor[1]);
  return KZ_OK;
}

static kz_status answer(const kz_options *options, const kz_scene *scene, const kz_starts *starts) {
  KZ_TRY(kz_studies_check(scene));
  return (options->boundary > 0 ? answer_boundary : answer_where)(options, scene, starts);
}

kz_status kz_app_where(const kz_options *options) {
  char *text;
  size_t length;
  kz_scene scene;
  kz_starts starts = {0};
  if (!options->speaks) return KZ_OK;
  KZ_TRY(kz_scene_load(options->scene, &text, &length));
  kz_status status = kz_scene_read(text, length, options->scene, options->n_sets, options->sets, &scene);
  if (status == KZ_OK) {
    status = kz_starts_read(options, scene.parameters.pivot_frequency, &starts);
    if (status == KZ_OK) status = answer(options, &scene, &starts);
    status = kz_scene_locate(status, text, length, options->scene, options->n_sets, options->sets);
    kz_scene_free(&scene);
  }
  kz_starts_free(&starts);
  free(text);
  return status;
}
