/* Rules between keys, and values that follow from others. Each rule complains at the node that a user would change. */
#include "rules.h"
#include "kapitza/study_basin.h"
#include "kapitza/study_orbit.h"
#include "kapitza/study_stability.h"
#include "../../study/sweep/plan.h"

/* Complains about a key where it is given. */
static void rules_refuse(kz_reading *reading, const char *path, const char *why) {
  if (kz_tree_find(reading->root, path)) kz_complain(reading, path, "%s", why);
}

static void basin_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin) return;
  kz_basin_plan *plan = scene->basin;
  kz_axis_set(reading, plan, plan->theta_edges, &plan->theta, "basin.theta");
  kz_axis_set(reading, plan, plan->velocity_edges, &plan->velocity, "basin.velocity");
  if (!plan->theta.centre.text[0]) {
    kz_theta_rules(reading, &plan->theta, "basin.theta");
    plan->theta_edges = (kz_edges){plan->theta.min, plan->theta.max};
  } else if (plan->theta.width.high > 2 * M_PI) {
    kz_complain(reading, "basin.theta.width", "%s is too wide; it must be at most 2 pi", plan->theta.width.text);
  }
  if (!plan->velocity.centre.text[0]) kz_axis_rules(reading, &plan->velocity, "basin.velocity");
}

/* A map table without method icm is allowed, but nothing uses it: the run says so, unless a method is named, as
 * in the resolved text of every scene. */
static void table_rules(kz_reading *reading, kz_scene *scene) {
  const bool given = kz_tree_find(reading->root, "basin.icm") && !kz_tree_find(reading->root, "basin.method");
  scene->basin->table_is_idle = given && isnan(scene->basin->accuracy) && scene->basin->method != KZ_METHOD_ICM;
}

static void attractors_rules(kz_reading *reading, kz_scene *scene) {
  if (scene->has_attractors && scene->has_basin)
    kz_complain(reading, "attractors",
                "repeats what basin does, which finds the attractors of its window itself; give one of them");
}

/* Complaint about a study, "KEY: what is wrong", at the key that is to be changed; NULL = nothing. */
static void lack_rule(kz_reading *reading, const char *lack, const char *study) {
  if (!lack) return;
  char key[16];
  snprintf(key, sizeof key, "%.*s", (int)strcspn(lack, ":"), lack);
  kz_complain(reading, kz_key_in(study, key).text, "%s", lack + strlen(key) + 2);
}

/* The studies beside which another one needs to stand, at the key `path` that needs them. */
static void need_rule(kz_reading *reading, const kz_study_need *need, const char *path) {
  char studies[64] = "";
  const char *words = need->studies, *word;
  for (int length; (word = kz_words_next(&words, &length));) {
    for (int i = 0; i < kz_study_count; i++)
      if (strlen(kz_studies[i]->name) == (size_t)length && strncmp(kz_studies[i]->name, word, (size_t)length) == 0 &&
          kz_study_is_wanted(kz_studies[i], reading->scene))
        return;
    snprintf(studies + strlen(studies), sizeof studies - strlen(studies), "%s%.*s", studies[0] ? " or " : "", length,
             word);
  }
  kz_complain(reading, path, "needs %s; add a %s study to the scene", need->what, studies);
}

/* Refuses keys that contradict orbit.attractor. */
static void orbit_attractor_rules(kz_reading *reading, kz_scene *scene) {
  need_rule(reading, &(kz_study_need){"a list of attractors", "basin|attractors"}, "orbit.attractor");
  rules_refuse(reading, "orbit.start", "contradicts attractor; give one of them");
  if (!scene->orbit->closed)
    rules_refuse(reading, "orbit.closed",
                 "contradicts attractor, whose orbit is closed; set true, or give a start instead of attractor");
  scene->orbit->closed = true;
  rules_refuse(reading, "orbit.period", "follows from orbit.attractor; leave it out");
  if (scene->orbit->model != KZ_PENDULUM)
    rules_refuse(reading, "orbit.model",
                 "has no attractors; choose the model pendulum, or give orbit.start instead of orbit.attractor");
}

static void orbit_rules(kz_reading *reading, kz_scene *scene) {
  kz_orbit_plan *orbit = scene->orbit;
  if (!scene->has_orbit) return;
  const bool linear = orbit->model == KZ_MATHIEU;
  if (orbit->attractor != KZ_UNSET_INTEGER)
    orbit_attractor_rules(reading, scene);
  else if (!kz_tree_find(reading->root, "orbit.start"))
    kz_complain(reading, "orbit.start", "is missing; give a mapping of theta and velocity, or an attractor instead");
  if (!linear) rules_refuse(reading, "orbit.about", "belongs to the model mathieu only; leave it out");
  if (orbit->model == KZ_EFFECTIVE && orbit->closed)
    rules_refuse(reading, "orbit.closed", "cannot be used with the model effective, which has no drive; set false");
  if (!orbit->closed) rules_refuse(reading, "orbit.period", "belongs to closed orbits only; add closed: true");
  if (linear && orbit->closed && orbit->period == KZ_UNSET_INTEGER)
    kz_complain(reading, "orbit.period",
                "is missing; give the period of the closed orbit, which cannot be found for the model mathieu");
  if (linear && orbit->about == KZ_UNSET_WORD) orbit->about = 0;
}

/* An axis of the stability chart, or NaN where the scene gives it in other words. */
static void stability_axis_rules(kz_reading *reading, kz_axis *axis, const char *path) {
  if (!kz_tree_find(reading->root, path)) {
    axis->min = axis->max = NAN;
    return;
  }
  if (axis->count == KZ_UNSET_INTEGER) axis->count = 1000;
  kz_axis_ends_rules(reading, axis, path);
}

static void stability_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_stability) return;
  kz_stability_plan *plan = scene->stability;
  stability_axis_rules(reading, &plan->k, "stability.k");
  stability_axis_rules(reading, &plan->m, "stability.m");
  stability_axis_rules(reading, &plan->a, "stability.a");
  stability_axis_rules(reading, &plan->q, "stability.q");
  if (isnan(plan->a.min) == isnan(plan->q.min)) return;
  kz_complain(reading, isnan(plan->a.min) ? "stability.a" : "stability.q",
              "is missing beside %s; give a mapping of min, max and count", isnan(plan->a.min) ? "q" : "a");
}

/* Whether the motions of a pendulum can be followed; `path` names what gives it. */
static void check_stiffness(kz_reading *reading, const kz_pendulum *pendulum, const char *path) {
  if (kz_stiffness(pendulum) <= KZ_MOST_STIFFNESS) return;
  kz_complain(reading, path,
              "gives abs(k) + abs(m) = %.3g; the program follows motions up to %g; use a weaker or faster drive",
              kz_stiffness(pendulum), KZ_MOST_STIFFNESS);
}

/* Converts a value written with a unit to the parameter's unit; *written = that unit, unless it has one. */
static void read_in_unit(kz_reading *reading, int32_t parameter, const kz_node *node, const char *path, double *value,
                         kz_written_unit *written) {
  const char *unit = kz_sweep_parameter_at(parameter)->unit;
  const char *wrong = !node || isnan(*value)     ? NULL
                      : strcmp(unit, "rad") == 0 ? kz_scalar_angle(node, value)
                                                 : kz_scalar_quantity(node, unit, value);
  if (wrong)
    kz_complain_at(reading, node, path, "\"%.60s\" %s; it must be a number%s%s, as pendulum.%s is", node->text, wrong,
                   unit[0] == '1' ? "" : " in ", unit[0] == '1' ? "" : unit, kz_sweep_parameter_at(parameter)->name);
  else if (node && !written->name[0])
    *written = kz_scalar_unit(node, unit);
}

/* One value of a key of the pendulum mapping: in the range of the key itself, and a pendulum. */
static void parameter_value(kz_reading *reading, const kz_scene *scene, int32_t parameter, const kz_node *node,
                            const char *path, double value) {
  kz_pendulum pendulum;
  const kz_short_text key = kz_key_in("pendulum", kz_sweep_parameter_at(parameter)->name);
  const double low = kz_key_find(reading->keys, key.text)->low;
  if (isnan(value)) return;
  if (value < low)
    kz_complain_at(reading, node, path, "%s is below what %s takes; %s%g", kz_shortest(value).text, key.text,
                   low == KZ_ABOVE_ZERO ? "above " : "at least ", low == KZ_ABOVE_ZERO ? 0.0 : low);
  else if (reading->message[0])
    return;
  else if (!kz_pendulum_at(scene, 1, &parameter, &value, &pendulum))
    kz_complain_at(
        reading, node, path,
        "%s gives no finite k, beta >= 0 and m, or an inertia below mass * radius^2; use a less extreme value",
        kz_shortest(value).text);
  else
    check_stiffness(reading, &pendulum, path);
}

/* The key of the pendulum mapping that `path` walks along. */
static void parameter_rule(kz_reading *reading, int32_t parameter, const char *path) {
  const char *name = kz_sweep_parameter_at(parameter)->name;
  if (!kz_tree_find(reading->root, kz_key_in("pendulum", name).text))
    kz_complain(reading, kz_key_in(path, "parameter").text,
                "%s is not given in the pendulum mapping; name a key that is written there", name);
}

/* The range of that key's values. */
static void parameter_values(kz_reading *reading, const kz_scene *scene, int32_t parameter, kz_axis *values,
                             const char *path) {
  if (parameter == KZ_UNSET_WORD) return;
  const kz_short_text min = kz_key_in(path, "min"), max = kz_key_in(path, "max");
  const kz_node *first = kz_tree_find(reading->root, min.text), *last = kz_tree_find(reading->root, max.text);
  read_in_unit(reading, parameter, first, min.text, &values->min, &values->written);
  read_in_unit(reading, parameter, last, max.text, &values->max, &values->written);
  kz_axis_rules(reading, values, path);
  parameter_rule(reading, parameter, path);
  parameter_value(reading, scene, parameter, first, min.text, values->min);
  parameter_value(reading, scene, parameter, last, max.text, values->max);
}

/* Values of a sweep that the scene lists. */
static void listed_values(kz_reading *reading, const kz_scene *scene, kz_sweep_plan *sweep) {
  static const char path[] = "sweep.values";
  double *value = sweep->listed.values;
  const int64_t count = sweep->listed.count;
  const kz_node *node = kz_tree_find(reading->root, path)->first;
  if (sweep->parameter == KZ_UNSET_WORD) return;
  if (count < 2) kz_complain_at(reading, node, path, "has one value; give two or more");
  parameter_rule(reading, sweep->parameter, "sweep");
  for (int64_t i = 0; i < count; i++, node = node->next) {
    read_in_unit(reading, sweep->parameter, node, path, value + i, &sweep->range.written);
    parameter_value(reading, scene, sweep->parameter, node, path, value[i]);
    if (i > 0 && !(value[i] - value[i - 1] > 8.0 * DBL_EPSILON * fabs(value[i])))
      kz_complain_at(reading, node, path, "%s is not above the value before it, %s; give ascending values",
                     kz_shortest(value[i]).text, kz_shortest(value[i - 1]).text);
  }
  sweep->values = (kz_axis){.min = value[0], .max = value[count - 1], .count = count, .written = sweep->range.written};
}

static void sweep_rules(kz_reading *reading, kz_scene *scene) {
  kz_sweep_plan *sweep = scene->sweep;
  if (!scene->has_sweep) return;
  if (scene->has_basin && !isnan(scene->basin->accuracy))
    kz_complain(reading, "basin.accuracy",
                "is chosen for one pendulum, and a sweep has many; give method, icm and numerics instead");
  if (sweep->listed.count > 0)
    listed_values(reading, scene, sweep);
  else if (!kz_sweep_is_plane(sweep))
    parameter_values(reading, scene, sweep->parameter, &sweep->range, "sweep");
  if (sweep->listed.count == 0) sweep->values = sweep->range;
}

/* Range that a mapping gives; returns the axis of a parameter. `other`: the mapping before, NULL = none. */
static const kz_plane_axis *range_rule(kz_reading *reading, const kz_key *key, char *axis, const kz_plane_axis *other) {
  kz_plane_axis *along = (kz_plane_axis *)axis;
  if (key->range == KZ_RANGE_ANGLES) kz_theta_rules(reading, (kz_axis *)axis, key->path);
  if (key->range == KZ_RANGE_VELOCITIES) kz_axis_rules(reading, (kz_axis *)axis, key->path);
  if (key->range != KZ_RANGE_PARAMETER || along->parameter == KZ_UNSET_WORD) return other;
  parameter_values(reading, reading->scene, along->parameter, &along->values, key->path);
  if (other && other->parameter == along->parameter)
    kz_complain(reading, kz_key_in(key->path, "parameter").text,
                "is also the parameter of the other axis; name another key of the pendulum mapping");
  return along;
}

/* Rules that the row and the keys of a study give. */
static void study_rules(kz_reading *reading, const kz_study *study) {
  kz_scene *scene = reading->scene;
  const kz_plane_axis *axis = NULL;
  for (const kz_key *key = study->keys; key->path; key++)
    if (key->range != KZ_RANGE_NONE)
      axis = range_rule(reading, key, *(char **)((char *)scene + study->plan) + key->range_offset, axis);
  if (study->lack) lack_rule(reading, study->lack(scene), study->name);
  for (size_t i = 0; i < sizeof study->needs / sizeof study->needs[0] && study->needs[i].what; i++)
    need_rule(reading, &study->needs[i], study->name);
  if (study->damped && !reading->message[0] && !(scene->parameters.pendulum.beta > 0))
    kz_complain(reading, study->name, "needs damping, because without it there are no attractors; give damping");
  if (study->follows && !reading->message[0]) check_stiffness(reading, &scene->parameters.pendulum, "pendulum");
}

static void studies_rules(kz_reading *reading, kz_scene *scene) {
  for (int i = 0; i < kz_study_count; i++)
    if (kz_study_is_wanted(kz_studies[i], scene)) study_rules(reading, kz_studies[i]);
}

/* Whether the pendulum, or one of the sweep's, has no mirror symmetry. */
static void symmetry_rules(kz_reading *reading, kz_scene *scene) {
  (void)reading;
  scene->basin->unmirrored =
      kz_drive_unmirrored_by(&scene->parameters.written) || scene->parameters.pendulum.unmirrored;
}

/* Refuses orbits for which the motion is too fast or the model does not hold. */
static void orbit_range_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_orbit || reading->message[0]) return;
  const double steps = kz_orbit_steps(scene), k = scene->parameters.pendulum.k;
  if (steps > KZ_MOST_ORBIT_STEPS)
    kz_complain(reading, "orbit",
                "needs %.3g steps a period for a motion this fast, at most %d are possible; use a slower start or "
                "weaker forces",
                steps, KZ_MOST_ORBIT_STEPS);
  if (scene->orbit->model == KZ_EFFECTIVE && fabs(k) >= 1)
    kz_complain(reading, "orbit.model",
                "effective averages over a fast drive, abs(k) < 1, but k = %.9g; use another model or a faster drive",
                k);
}

/* Sets basin.max_periods, if the scene does not, from the weakest damping. */
static void settling_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin || reading->message[0] || scene->basin->max_periods != KZ_UNSET_INTEGER) return;
  scene->basin->max_periods = kz_settling_scene(scene);
}

typedef void (*rule)(kz_reading *reading, kz_scene *scene);
static const rule rules[] = {basin_rules,     table_rules,       attractors_rules, orbit_rules,
                             stability_rules, kz_pendulum_rules, symmetry_rules,   studies_rules,
                             sweep_rules,     orbit_range_rules, settling_rules};

void kz_reading_rules(kz_reading *reading) {
  for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) rules[i](reading, reading->scene);
}
