/* The command where: where starts end, for people, as CSV or as JSON. */
#include "commands.h"
#include "json.h"
#include "where.h"

static void print_number(double value) {
  fputs(kz_shortest(value).text, stdout);
}

static const char *words_of(const char *precision) {
  if (strcmp(precision, "pairs") == 0) return "pairs of doubles";
  if (strcmp(precision, "arbitrary") == 0) return "as many digits as needed";
  return strcmp(precision, "double") == 0 ? "double precision" : "quad precision";
}

static void print_decision(const kz_ending *e) {
  const char *precision = kz_evidence_word(e->end.evidence);
  if (precision)
    printf("decided         yes, in %s", words_of(precision));
  else
    printf("decided         no: the start ends on %s or on %s, and quad precision cannot decide which", e->entry.name,
           e->other_name[0] ? e->other_name : "another attractor");
  if (!isnan(e->error)) printf(" (error at most %.2g rad when the trapping region holds the orbit)", e->error);
  putchar('\n');
}

static void print_start(const kz_coordinate start[2], double omega) {
  printf("theta = %.10g (%.6g deg), velocity = %.10g", start[0].high, start[0].high * 180 / M_PI, start[1].high);
  isnan(omega) ? puts("") : printf(" (%.6g rad/s)\n", start[1].high * omega);
}

/* A number of drive periods, and what they are in seconds. */
static void print_time(const char *words, int64_t periods, double omega) {
  printf("%-15s after ", words);
  kz_periods_print(periods, omega, stdout);
  puts("");
}

/* `omega`: of the pivot, rad/s; NaN where the scene is not in SI units, which are printed then too. */
static void print_person(const kz_coordinate start[2], const kz_ending *e, double omega, bool damped) {
  const bool si = !isnan(omega);
  print_start(start, omega);
  if (e->end.label < 0) {
    puts(damped ? "ends on         no known attractor: it has not settled"
                : "ends on         nothing: without damping there are no attractors");
    return;
  }
  printf("ends on         %s (attractor %d)\n", e->entry.name, (int)e->end.label);
  print_time("certain", e->end.periods, omega);
  if (e->near_time >= 0) print_time("within 1 deg", e->near_time, omega);
  print_decision(e);
  if (e->end.turns != KZ_NO_TURNS) printf("turns           %d\n", (int)e->end.turns);
  if (e->entry.row.period == 0) {
    if (kz_is_running(&e->entry.row))
      printf("period          none: it never closes\nmean velocity   %.10g\n", e->entry.row.mean_velocity);
    else
      puts("period          none: chaotic");
    return;
  }
  printf("period          %d\nwinding         %d\nstrobe points   theta, velocity%s\n", (int)e->entry.row.period,
         (int)e->entry.row.winding, si ? ", in deg and rad/s" : "");
  for (int i = 0; i < e->entry.row.period; i++) {
    printf("  %18.12f  %18.12f", e->entry.theta[i], e->entry.velocity[i]);
    si ? printf("  %12.6f  %12.6f\n", e->entry.theta[i] * 180 / M_PI, e->entry.velocity[i] * omega) : puts("");
  }
}

/* A property of a start: a member of a JSON object and a column of CSV. */
typedef struct {
  const char *name;
  enum { NUMBER, TEXT, FLAG, LIST } kind;
  double value;       /* NUMBER: NaN = none; LIST: factor of its numbers */
  const char *word;   /* TEXT: "" = none; FLAG: "true" or "false" */
  const double *list; /* LIST: a number for each strobe point, of which CSV has the first */
} member;
enum { MEMBERS = 21, MEMBERS_SI = 4 /* the last ones, which an SI scene adds */ };

/* Fills list [MEMBERS] and returns their number. */
static int list_members(const kz_coordinate start[2], const kz_ending *e, double omega, member *list) {
  const bool settled = e->end.label >= 0, has_turns = settled && e->end.turns != KZ_NO_TURNS;
  const char *precision = kz_evidence_word(e->end.evidence);
  const member all[MEMBERS] = {
      {"theta", NUMBER, .value = start[0].high},
      {"velocity", NUMBER, .value = start[1].high},
      {"attractor", NUMBER, .value = e->end.label},
      {"name", TEXT, .word = e->entry.name},
      {"period", NUMBER, .value = settled ? e->entry.row.period : NAN},
      {"winding", NUMBER, .value = settled ? e->entry.row.winding : NAN},
      {"settling_time", NUMBER, .value = settled ? (double)e->end.periods : NAN},
      {"decided", FLAG, .word = precision ? "true" : "false"},
      {"strobe_theta", LIST, .value = 1, .list = e->entry.theta},
      {"strobe_velocity", LIST, .value = 1, .list = e->entry.velocity},
      {"precision", TEXT, .word = precision ? precision : ""},
      {"error", NUMBER, .value = e->error},
      {"other_attractor", NUMBER, .value = e->end.other},
      {"other_name", TEXT, .word = e->other_name},
      {"near_time", NUMBER, .value = e->near_time >= 0 ? (double)e->near_time : NAN},
      {"turns", NUMBER, .value = has_turns ? e->end.turns : NAN},
      {"mean_velocity", NUMBER, .value = settled ? e->entry.row.mean_velocity : NAN},
      {"velocity_rad_per_s", NUMBER, .value = start[1].high * omega},
      {"settling_seconds", NUMBER, .value = settled ? (double)e->end.periods * 2 * M_PI / omega : NAN},
      {"near_seconds", NUMBER, .value = e->near_time >= 0 ? (double)e->near_time * 2 * M_PI / omega : NAN},
      {"strobe_velocity_rad_per_s", LIST, .value = omega, .list = e->entry.velocity},
  };
  memcpy(list, all, sizeof all);
  return isnan(omega) ? MEMBERS - MEMBERS_SI : MEMBERS;
}

/* The value of a member, as CSV has it. */
static void print_value(const member *m, bool has_strobes) {
  const double value = m->kind == LIST && has_strobes ? m->list[0] * m->value : m->value;
  if (m->kind == TEXT || m->kind == FLAG)
    fputs(m->word, stdout);
  else if (m->kind == LIST ? has_strobes : !isnan(value))
    print_number(value);
}

static kz_json *json_of(const member *m, int n) {
  if (m->kind == NUMBER) return kz_json_real(m->value);
  if (m->kind == FLAG) return json_object_new_boolean(m->word[0] == 't');
  if (m->kind == TEXT) return m->word[0] ? kz_json_text(m->word) : NULL;
  kz_json *list = json_object_new_array();
  for (int i = 0; i < n; i++) json_object_array_add(list, kz_json_real(m->list[i] * m->value));
  return list;
}

void kz_ending_add(kz_json *object, const kz_coordinate start[2], const kz_ending *e, double omega) {
  member list[MEMBERS];
  const int n = list_members(start, e, omega, list);
  for (const member *m = list; m < list + n; m++) kz_json_add(object, m->name, json_of(m, e->entry.row.period));
}

static void print_json(const kz_coordinate start[2], const kz_ending *e, double omega) {
  kz_json *object = json_object_new_object();
  kz_ending_add(object, start, e, omega);
  kz_json_print(object, stdout);
}

static void print_csv(const kz_coordinate start[2], const kz_ending *e, double omega) {
  member list[MEMBERS];
  const int n = list_members(start, e, omega, list);
  for (const member *m = list; m < list + n; m++) {
    if (m > list) putchar(',');
    print_value(m, e->entry.row.period > 0);
  }
  putchar('\n');
}

static void print_csv_names(const kz_coordinate start[2], const kz_ending *e, double omega) {
  member list[MEMBERS];
  const int n = list_members(start, e, omega, list);
  for (int i = 0; i < n; i++) printf("%s%c", list[i].name, i + 1 < n ? ',' : '\n');
}

static void print_endings(const kz_options *options, const kz_starts *starts, const kz_ending *endings, bool damped) {
  const bool table = options->n_operands == 2;
  const double omega = starts->pivot_frequency;
  if (table && !options->json) print_csv_names(starts->start[0], endings, omega);
  for (int64_t i = 0; i < starts->n; i++) {
    const kz_coordinate *start = starts->start[i];
    if (options->json || table)
      (options->json ? print_json : print_csv)(start, endings + i, omega);
    else
      print_person(start, endings + i, omega, damped);
  }
}

/* A number without a unit may be meant in degrees, and in a scene in SI units in rad/s. */
static void print_note(const kz_options *options, const kz_starts *starts) {
  const double speed = starts->start[0][1].high, angle = starts->start[0][0].high;
  double number;
  if (options->json || options->n_operands != 3) return;
  if (fabs(angle) > 4 * M_PI && !kz_text_real(options->operands[1], &number))
    printf("note            an angle without a unit is in rad; write \"%.6g deg\" for degrees\n", angle);
  if (isnan(starts->pivot_frequency) || speed == 0) return;
  if (strstr(options->operands[2], "/s")) return;
  printf("note            a velocity without a unit is in rad per drive radian: %.6g is %.6g rad/s; ", speed,
         speed * starts->pivot_frequency);
  printf("for rad/s write \"%.6g rad/s\"\n", speed);
}

static kz_status answer_where(const kz_options *options, const kz_scene *scene, const kz_starts *starts) {
  kz_ending *endings = kz_calloc((size_t)starts->n, sizeof *endings);
  const kz_status status = kz_where(scene, starts->n, starts->start, endings);
  const bool damped = scene->parameters.pendulum.beta > 0;
  if (status == KZ_OK) print_endings(options, starts, endings, damped);
  if (status == KZ_OK && !damped && (options->json || options->n_operands == 2)) kz_settling_warn(scene, stderr);
  if (status == KZ_OK) print_note(options, starts);
  kz_where_free(starts->n, endings);
  free(endings);
  return status;
}

static void print_boundary(const kz_boundary_point *point) {
  kz_json *object = json_object_new_object(), *ids = json_object_new_array(), *names = json_object_new_array();
  kz_json_add_text(object, "theta", point->theta);
  kz_json_add_text(object, "velocity", point->velocity);
  for (int i = 0; i < 2; i++) {
    json_object_array_add(ids, json_object_new_int64(point->attractor[i]));
    json_object_array_add(names, kz_json_text(point->name[i]));
  }
  kz_json_add(object, "attractors", ids);
  kz_json_add(object, "names", names);
  kz_json_print(object, stdout);
}

static kz_status answer_boundary(const kz_options *options, const kz_scene *scene, const kz_starts *starts) {
  kz_boundary_point point;
  KZ_TRY(kz_where_boundary(scene, starts->start, ((const kz_where_options *)options->own)->boundary, &point));
  if (options->json)
    print_boundary(&point);
  else
    printf("theta     %s\nvelocity  %s\nbetween   %s (attractor %d) and %s (attractor %d)\n", point.theta,
           point.velocity, point.name[0], (int)point.attractor[0], point.name[1], (int)point.attractor[1]);
  return KZ_OK;
}

static kz_status where_answer(const kz_options *options, const kz_scene *scene) {
  kz_starts starts;
  kz_status status = kz_starts_read(options, scene->parameters.pivot_frequency, &starts);
  if (status == KZ_OK) status = kz_studies_check(scene);
  if (status == KZ_OK)
    status = (((const kz_where_options *)options->own)->boundary > 0 ? answer_boundary : answer_where)(options, scene,
                                                                                                       &starts);
  kz_starts_free(&starts);
  return status;
}

static kz_status where_run(const kz_options *options) {
  return kz_scene_answer(options, where_answer);
}

static kz_status set_boundary(void *members, const kz_option *row, const char *argument) {
  kz_where_options *options = members;
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)argument, .plain = true};
  const char *wrong = kz_scalar_integer(&node, &options->boundary);
  if (wrong || options->boundary < 1 || options->boundary > KZ_BOUNDARY_MOST_DIGITS)
    return kz_fail(KZ_REFUSED, "--%s: \"%.40s\" %s; give a number of digits from 1 to %d", row->name, argument,
                   wrong ? wrong : "is out of range", KZ_BOUNDARY_MOST_DIGITS);
  return KZ_OK;
}

static const kz_option rows[] = {
    {"boundary", 0, "DIGITS", set_boundary, 0,
     "print the point between two starts at which their basins meet, correct to DIGITS decimal places", NULL},
    {.name = NULL},
};
const kz_command kz_where_command = {"where",
                                     " SCENE THETA VELOCITY",
                                     2,
                                     5,
                                     where_run,
                                     "say on which attractor a start ends; THETA is in rad from down, VELOCITY in rad "
                                     "per drive radian, with any number of "
                                     "digits, or both with units ('170 deg', of a scene in SI '3 rad/s'); write - in "
                                     "their place to read starts as CSV from "
                                     "standard input; --boundary takes two starts",
                                     "set|json|boundary|help",
                                     rows,
                                     sizeof(kz_where_options)};
