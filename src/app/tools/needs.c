/* The command needs: how large the amplitude of the pivot must be for a pendulum to stand upside down. */
#include "commands.h"
#include "json.h"
#include "kapitza/study_flutter.h"

static const double USUAL_QUALITY = 20;

/* Pendulum and shaker, SI. */
typedef struct {
  double length, frequency, quality_factor; /* m, Hz */
} rig;

/* Amplitudes of the pivot, m; NaN = none. */
typedef struct {
  const char *name, *words;
  double from, to;
} amplitudes;

/* Reads an option as the key of the same name is read. `text` NULL: it has not been given, and *value stays. */
static kz_status read_quantity(const char *option, const char *path, const char *text, double *value) {
  const kz_key *key = kz_key_find(kz_scene_keys(), path);
  const kz_node node = {.kind = KZ_SCALAR, .text = (char *)text, .plain = true};
  char accepts[512];
  if (!text) return KZ_OK;
  const bool bare = !kz_scalar_real(&node, value);
  const char *wrong =
      kz_unit_is_known(key->unit) ? kz_scalar_quantity(&node, key->unit, value) : kz_scalar_real(&node, value);
  if (!wrong && (*value < key->low || *value > key->high)) wrong = "is out of range";
  if (!wrong && bare && *value > kz_key_most_bare(key)) wrong = "is taken for metres; give its unit";
  if (!wrong) return KZ_OK;
  kz_key_accepts(kz_scene_keys(), key, accepts, sizeof accepts);
  return kz_fail(KZ_REFUSED, "--%s: \"%.40s\" %s; give %s", option, text, wrong, accepts);
}

/* As written; NULL = not given. */
typedef struct {
  const char *length, *frequency, *quality_factor;
} own_options;

static kz_status read_rig(const own_options *options, rig *r) {
  *r = (rig){.quality_factor = USUAL_QUALITY};
  if (!options->length || !options->frequency)
    return kz_fail(KZ_REFUSED, "needs: --%s is missing; kapitza needs --length 20 cm --frequency 50 Hz",
                   options->length ? "frequency" : "length");
  KZ_TRY(read_quantity("length", "pendulum.length", options->length, &r->length));
  KZ_TRY(read_quantity("frequency", "pendulum.frequency", options->frequency, &r->frequency));
  return read_quantity("quality-factor", "pendulum.quality_factor", options->quality_factor, &r->quality_factor);
}

/* Fills found [2]: standing, flutter. */
static kz_status find_amplitudes(const rig *r, amplitudes *found) {
  const double omega = 2 * M_PI * r->frequency, natural = sqrt(KZ_STANDARD_GRAVITY / r->length),
               ratio = natural / omega;
  const kz_pendulum p = {.k = ratio * ratio, .beta = ratio / r->quality_factor};
  if (!(p.k > 0 && p.k < 1 && p.beta > 0))
    return kz_fail(KZ_REFUSED,
                   "--frequency: %g Hz is not above that of the pendulum's own swings, %.4g Hz; give a higher one",
                   r->frequency, natural / (2 * M_PI));
  double from, to;
  kz_standing_drives(&p, &from, &to);
  double onset, end;
  kz_flutter_drives(&p, &onset, &end);
  found[0] = (amplitudes){"stands", "stands upside down", from * r->length, to * r->length};
  found[1] = (amplitudes){"flutters", "flutters", onset * r->length, end * r->length};
  return KZ_OK;
}

/* Peak acceleration of the pivot in units of gravity. */
static double needs_acceleration(const rig *r, double amplitude) {
  const double omega = 2 * M_PI * r->frequency;
  return amplitude * omega * omega / KZ_STANDARD_GRAVITY;
}

static void print_amplitudes(const rig *r, const amplitudes *a) {
  printf("%-19s", a->words);
  if (isnan(a->from)) {
    puts("at no amplitude");
    return;
  }
  printf("from %.4g mm (%.3g g)", 1e3 * a->from, needs_acceleration(r, a->from));
  isnan(a->to) ? puts(" on; no end was found")
               : printf(" to %.4g mm (%.3g g)\n", 1e3 * a->to, needs_acceleration(r, a->to));
}

static void print_person(const rig *r, const amplitudes *found) {
  printf("pendulum           length %.6g cm, own swings %.4g Hz, quality factor %.6g\n", 100 * r->length,
         sqrt(KZ_STANDARD_GRAVITY / r->length) / (2 * M_PI), r->quality_factor);
  printf("pivot              %.6g Hz; amplitudes (half of the stroke) and peak accelerations:\n", r->frequency);
  for (int i = 0; i < 2; i++) print_amplitudes(r, found + i);
}

static void print_json(const rig *r, const amplitudes *found) {
  kz_json *object = json_object_new_object();
  kz_json_add_real(object, "length", r->length);
  kz_json_add_real(object, "frequency", r->frequency);
  kz_json_add_real(object, "quality_factor", r->quality_factor);
  for (int i = 0; i < 2; i++) {
    char name[32];
    snprintf(name, sizeof name, "%s_g", found[i].name);
    kz_json_add(object, found[i].name, kz_json_pair(found[i].from, found[i].to));
    kz_json_add(object, name, kz_json_pair(needs_acceleration(r, found[i].from), needs_acceleration(r, found[i].to)));
  }
  kz_json_print(object, stdout);
}

static kz_status needs_run(const kz_options *options) {
  rig r;
  amplitudes found[2];
  if (!options->prints) return KZ_OK;
  KZ_TRY(read_rig(options->own, &r));
  KZ_TRY(find_amplitudes(&r, found));
  (options->json ? print_json : print_person)(&r, found);
  return KZ_OK;
}

#define OF(member) offsetof(own_options, member)
static const kz_option rows[] = {
    {"length", 0, "L", kz_option_text, OF(length), "length of a point mass on a light rod, such as 20 cm; needed",
     NULL},
    {"frequency", 0, "F", kz_option_text, OF(frequency),
     "frequency of the drive: Hz, or with a unit such as 3000 rpm; needed", NULL},
    {"quality-factor", 0, "Q", kz_option_text, OF(quality_factor), "quality factor of small swings; default: 20", NULL},
    {.name = NULL},
};
const kz_command kz_needs_command = {
    "needs",
    " --length L --frequency F",
    0,
    0,
    needs_run,
    "say between which amplitudes of the pivot a pendulum of --length stands upside down and flutters at --frequency",
    "json|length|frequency|quality-factor|help",
    rows,
    sizeof(own_options),
    .joins_units = true};
