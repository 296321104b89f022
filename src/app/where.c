/* The command where: where starts end, for people, as CSV or as JSON. */
#include <math.h>
#include <stdlib.h>

#include "app.h"

static void print_number(double value) {
  char text[32];
  kz_scalar_print(value, text);
  fputs(text, stdout);
}

static void print_person(const double *start, const kz_ending *e) {
  printf("theta = %.10g, velocity = %.10g\n", start[0], start[1]);
  if (e->attractor < 0) {
    puts("ends on         nothing known: it has not settled");
    return;
  }
  printf("ends on         %s (attractor %d)\n", e->name, (int)e->attractor);
  printf("settling time   %lld drive periods\n", (long long)e->settling_time);
  printf("decided         %s\n", e->decided ? "yes: it ends so in quad precision too, and from a rounding beside"
                                            : "no: quad precision, or a start one rounding beside, ends elsewhere");
  if (e->period == 0) {
    puts("period          none: chaotic");
    return;
  }
  printf("period          %d\nwinding         %d\nstrobe points   theta, velocity\n", (int)e->period, (int)e->winding);
  for (int i = 0; i < e->period; i++) printf("  %18.12f  %18.12f\n", e->strobe_theta[i], e->strobe_velocity[i]);
}

static void print_list(const char *name, int n, const double *values) {
  printf(", \"%s\": [", name);
  for (int i = 0; i < n; i++) {
    if (i > 0) fputs(", ", stdout);
    print_number(values[i]);
  }
  putchar(']');
}

static void print_json(const double *start, const kz_ending *e) {
  fputs("{\"theta\": ", stdout);
  print_number(start[0]);
  fputs(", \"velocity\": ", stdout);
  print_number(start[1]);
  printf(", \"attractor\": %d", (int)e->attractor);
  if (e->attractor < 0)
    fputs(", \"name\": null, \"period\": null, \"winding\": null, \"settling_time\": null", stdout);
  else
    printf(", \"name\": \"%s\", \"period\": %d, \"winding\": %d, \"settling_time\": %lld", e->name, (int)e->period,
           (int)e->winding, (long long)e->settling_time);
  printf(", \"decided\": %s", e->decided ? "true" : "false");
  print_list("strobe_theta", e->period, e->strobe_theta);
  print_list("strobe_velocity", e->period, e->strobe_velocity);
  puts("}");
}

/* The first strobe point stands for the orbit; what there is not stays empty. */
static void print_csv(const double *start, const kz_ending *e) {
  print_number(start[0]);
  putchar(',');
  print_number(start[1]);
  printf(",%d,", (int)e->attractor);
  if (e->attractor < 0)
    fputs(",,,", stdout);
  else
    printf("%s,%d,%d,%lld", e->name, (int)e->period, (int)e->winding, (long long)e->settling_time);
  printf(",%s,", e->decided ? "true" : "false");
  if (e->period > 0) print_number(e->strobe_theta[0]);
  putchar(',');
  if (e->period > 0) print_number(e->strobe_velocity[0]);
  putchar('\n');
}

static void print_endings(const kz_options *options, int64_t n, const double *starts, const kz_ending *endings) {
  const bool table = options->n_operands == 2;
  void (*print)(const double *, const kz_ending *) = options->json ? print_json : table ? print_csv : print_person;
  if (table && !options->json)
    puts("theta,velocity,attractor,name,period,winding,settling_time,decided,strobe_theta,strobe_velocity");
  for (int64_t i = 0; i < n; i++) print(starts + 2 * i, endings + i);
}

static kz_status answer(const kz_options *options, const kz_scene *scene, int64_t n, const double *starts) {
  KZ_TRY(kz_studies_check(scene));
  kz_ending *endings = calloc((size_t)n, sizeof *endings);
  if (!endings) return kz_fail(KZ_FAILED, "out of memory for %lld starts", (long long)n);
  const kz_status status = kz_where(scene, n, starts, endings);
  if (status == KZ_OK) print_endings(options, n, starts, endings);
  kz_where_free(n, endings);
  free(endings);
  return status;
}

kz_status kz_app_where(const kz_options *options) {
  char *text;
  size_t length;
  kz_scene scene;
  double *starts = NULL;
  int64_t n;
  if (!options->speaks) return KZ_OK;
  KZ_TRY(kz_scene_load(options->scene, &text, &length));
  kz_status status = kz_scene_read(text, length, options->scene, options->n_sets, options->sets, &scene);
  if (status == KZ_OK) {
    status = kz_starts_read(options, &n, &starts);
    if (status == KZ_OK) status = answer(options, &scene, n, starts);
    status = kz_scene_locate(status, text, length, options->scene, options->n_sets, options->sets);
    kz_scene_free(&scene);
  }
  free(starts);
  free(text);
  return status;
}
