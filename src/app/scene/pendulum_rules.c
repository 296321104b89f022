/* Rules of the mapping pendulum: keys that a laboratory's pendulum needs, and k, beta and m from them. */
#include "rules.h"

static bool is_given(double value) {
  return !isnan(value);
}

/* Whether a torque is given in N m. */
static bool has_moment(const kz_pendulum_keys *w) {
  return is_given(w->constant_torque) || is_given(w->oscillating_torque);
}

/* Whether the keys of a pendulum in SI units are the ones that are used. */
static bool is_laboratory(const kz_pendulum_keys *w) {
  return is_given(w->length) || is_given(w->mass) || is_given(w->radius) || is_given(w->inertia) ||
         is_given(w->friction) || is_given(w->decay_time) || is_given(w->gravity) || is_given(w->amplitude) ||
         is_given(w->pivot_amplitude) || is_given(w->frequency) || is_given(w->pivot_frequency) || has_moment(w);
}

/* Adds one thing that is missing to the list. */
static void pendulum_rules_lack(char *list, size_t bytes, bool missing, const char *what) {
  if (missing) snprintf(list + strlen(list), bytes - strlen(list), "%s%s", list[0] ? "; " : "", what);
}

/* One message that names all missing keys, each with the keys that could replace it. */
static void check_complete(kz_reading *reading, const kz_pendulum_keys *w) {
  char list[700] = "";
  const size_t n = sizeof list;
  const bool body = is_given(w->radius) || is_given(w->inertia);
  const bool needs_mass = (is_given(w->friction) || has_moment(w)) && !is_given(w->inertia);
  if (!body && !is_given(w->length))
    pendulum_rules_lack(list, n, true, "length (of a point mass; of another body mass, radius and inertia)");
  pendulum_rules_lack(list, n, (body || needs_mass) && !is_given(w->mass),
                      body ? "mass" : "mass (beside friction or a torque)");
  pendulum_rules_lack(list, n, body && !is_given(w->radius), "radius");
  pendulum_rules_lack(list, n, body && !is_given(w->inertia), "inertia");
  pendulum_rules_lack(list, n, !is_given(w->frequency) && !is_given(w->pivot_frequency),
                      "frequency (in Hz; or pivot_frequency in rad/s)");
  pendulum_rules_lack(list, n, !is_given(w->amplitude) && !is_given(w->pivot_amplitude), "amplitude (of the pivot)");
  pendulum_rules_lack(list, n, !is_given(w->quality_factor) && !is_given(w->decay_time) && !is_given(w->friction),
                      "quality_factor (or decay_time, or friction)");
  if (list[0]) kz_complain_at(reading, NULL, "pendulum.amplitude", "the pendulum lacks: %s", list);
}

/* Refuses two keys that give the same quantity. */
static void check_once(kz_reading *reading, const kz_pendulum_keys *w) {
  const struct {
    double one, other;
    const char *name, *path;
  } pairs[] = {{w->pivot_frequency, w->frequency, "pivot_frequency", "pendulum.frequency"},
               {w->pivot_amplitude, w->amplitude, "pivot_amplitude", "pendulum.amplitude"},
               {w->length, w->radius, "length", "pendulum.radius"},
               {w->length, w->inertia, "length", "pendulum.inertia"},
               {w->quality_factor, w->decay_time, "quality_factor", "pendulum.decay_time"},
               {w->quality_factor, w->friction, "quality_factor", "pendulum.friction"},
               {w->decay_time, w->friction, "decay_time", "pendulum.friction"},
               {w->torque, w->constant_torque_ratio, "torque", "pendulum.constant_torque_ratio"},
               {w->torque, w->constant_torque, "torque", "pendulum.constant_torque"},
               {w->torque, w->i_dc, "torque", "pendulum.i_dc"},
               {w->constant_torque_ratio, w->constant_torque, "constant_torque_ratio", "pendulum.constant_torque"},
               {w->constant_torque_ratio, w->i_dc, "constant_torque_ratio", "pendulum.i_dc"},
               {w->torque_amplitude, w->torque_ratio, "torque_amplitude", "pendulum.torque_ratio"},
               {w->torque_amplitude, w->oscillating_torque, "torque_amplitude", "pendulum.oscillating_torque"},
               {w->torque_amplitude, w->i_ac, "torque_amplitude", "pendulum.i_ac"},
               {w->torque_ratio, w->oscillating_torque, "torque_ratio", "pendulum.oscillating_torque"},
               {w->torque_ratio, w->i_ac, "torque_ratio", "pendulum.i_ac"}};
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++)
    if (is_given(pairs[i].one) && is_given(pairs[i].other))
      kz_complain(reading, pairs[i].path, "contradicts %s, which gives the same; give one of them", pairs[i].name);
}

static void check_laboratory(kz_reading *reading, const kz_pendulum_keys *w) {
  check_complete(reading, w);
  if (reading->message[0] || !is_given(w->inertia) || kz_inertia_is_possible(w)) return;
  kz_complain(reading, "pendulum.inertia",
              "%s is below pendulum.mass * pendulum.radius^2 = %s, the least that a body can have; give at least that",
              kz_shortest(w->inertia).text, kz_shortest(kz_point_inertia(w)).text);
}

/* The list of samples and the wave form "samples" need each other. */
static void check_samples(kz_reading *reading, const kz_pendulum_keys *w) {
  enum { FEWEST = 4 };
  const bool list = kz_tree_find(reading->root, "pendulum.samples");
  if (w->waveform == KZ_SAMPLES && !list)
    kz_complain(reading, "pendulum.waveform",
                "samples needs the list pendulum.samples; give it, or choose another form");
  else if (list && w->waveform != KZ_SAMPLES)
    kz_complain(reading, "pendulum.samples", "is for pendulum.waveform: samples; choose it, or leave the list out");
  else if (list && w->samples.count < FEWEST)
    kz_complain(reading, "pendulum.samples", "has %lld values; give at least %d", (long long)w->samples.count, FEWEST);
}

/* A cosine and a sine for each harmonic. */
static void check_coefficients(kz_reading *reading, const kz_reals *list, const char *path) {
  if (list->count % 2 != 0 || list->count > 2 * KZ_HARMONICS)
    kz_complain(reading, path, "has %lld values; give a cosine and a sine for each harmonic, of %d harmonics at most",
                (long long)list->count, KZ_HARMONICS);
}

/* Numbers without a unit are SI: they are listed for a note, and refused where millimetres must have been meant. */
static void check_units(kz_reading *reading, kz_scene *scene) {
  for (const kz_key *key = reading->keys; key->path; key++) {
    const kz_node *node = strncmp(key->path, "pendulum.", 9) == 0 ? kz_tree_find(reading->root, key->path) : NULL;
    double value;
    if (!node || !kz_unit_is_known(key->unit) || kz_scalar_real(node, &value)) continue;
    if (fabs(value) > kz_key_most_bare(key))
      kz_complain(reading, key->path, "%s is taken for %s m, more than a laboratory has; give its unit, such as %s mm",
                  node->text, node->text, node->text);
    const size_t n = strlen(scene->bare);
    snprintf(scene->bare + n, sizeof scene->bare - n, "%s%s %s %s", n > 0 ? ", " : "", key->path + 9, node->text,
             key->unit);
  }
}

void kz_pendulum_rules(kz_reading *reading, kz_scene *scene) {
  kz_pendulum_keys *written = &scene->parameters.written;
  if (!kz_tree_child(reading->root, "pendulum")) { /* a scene with the study stability alone needs no pendulum */
    scene->parameters.pendulum = (kz_pendulum){NAN, NAN, NAN};
    scene->parameters.quality_factor = scene->parameters.drive_frequency = scene->parameters.drive_amplitude = NAN;
    scene->parameters.pivot_frequency = NAN;
    return;
  }
  check_once(reading, written);
  check_samples(reading, written);
  check_coefficients(reading, &written->vertical, "pendulum.vertical");
  check_coefficients(reading, &written->horizontal, "pendulum.horizontal");
  if (is_laboratory(written)) {
    check_laboratory(reading, written);
    check_units(reading, scene);
    if (!is_given(written->gravity)) written->gravity = KZ_STANDARD_GRAVITY;
  }
  if (reading->message[0] || kz_parameters_resolve(&scene->parameters) == KZ_OK) return;
  char wrong[256];
  snprintf(wrong, sizeof wrong, "%s", kz_message());
  kz_message_clear();
  kz_complain(reading, "pendulum", "%s", wrong);
}
