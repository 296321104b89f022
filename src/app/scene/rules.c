/* Rules between keys, and values that follow from others. Each rule complains at the node that a user would change. */
#include <math.h>
#include <stdio.h>

#include "axis_rules.h"
#include "pendulum_rules.h"

static void basin_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin) return;
  kz_basin_plan *plan = &scene->basin;
  kz_axis_set(reading, plan, plan->theta_edges, &plan->theta, "basin.theta");
  kz_axis_set(reading, plan, plan->velocity_edges, &plan->velocity, "basin.velocity");
  if (!plan->theta.centre.text[0]) {
    kz_theta_rules(reading, &plan->theta, "basin.theta");
    plan->theta_edges = (kz_edges){plan->theta.min, plan->theta.max};
  } else if (plan->theta.width.high > 2 * M_PI) {
    kz_complain(reading, kz_tree_find(reading->root, "basin.theta.width"), "basin.theta.width",
                "%s is too wide; it must be at most 2 pi", plan->theta.width.text);
  }
  if (!plan->velocity.centre.text[0]) kz_axis_rules(reading, &plan->velocity, "basin.velocity");
}

/* A map table without method icm: nothing is wrong with it, but nothing uses it either. Who chooses another method by an option knows. */
static void table_rules(kz_reading *reading, kz_scene *scene) {
  const kz_node *method = kz_tree_find(reading->root, "basin.method");
  const bool given = kz_tree_find(reading->root, "basin.icm") && !(method && method->line == 0);
  scene->basin.table_is_idle = given && isnan(scene->basin.accuracy) && scene->basin.method != KZ_METHOD_ICM;
}

/* undecided: decide needs method exact and a build with FLINT. */
static void undecided_rules(kz_reading *reading, kz_scene *scene) {
  const kz_node *node = kz_tree_find(reading->root, "basin.undecided");
  if (!scene->has_basin || scene->basin.undecided == KZ_UNDECIDED_FLAG) return;
  if (scene->basin.method != KZ_METHOD_EXACT || !isnan(scene->basin.accuracy))
    kz_complain(reading, node, "basin.undecided", "decide needs basin.method: exact; choose that method, or flag");
  else if (kz_arbitrary_bits() < KZ_MOST_BITS)
    kz_complain(reading, node, "basin.undecided", "decide needs a build with FLINT (Arb); leave it out");
}

/* The sizes of shocks must increase. */
static void shocks_rules(kz_reading *reading, kz_scene *scene) {
  const kz_reals *sizes = &scene->basin.shocks.sizes;
  const kz_node *node = kz_tree_find(reading->root, "basin.shocks.sizes");
  if (!scene->has_basin || !scene->basin.has_shocks) return;
  if (sizes->count < 1 || sizes->count > KZ_MOST_SHOCK_SIZES)
    kz_complain(reading, node, "basin.shocks.sizes", "has %lld values; give 1 to %d", (long long)sizes->count,
                KZ_MOST_SHOCK_SIZES);
  for (int64_t i = 1; i < sizes->count; i++)
    if (!(sizes->values[i] > sizes->values[i - 1]))
      kz_complain(reading, node, "basin.shocks.sizes", "%s is not above the size before it; give sizes in rising order",
                  kz_shortest(sizes->values[i]).text);
}

static void attractors_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_attractors) return;
  kz_theta_rules(reading, &scene->attractors.theta, "attractors.theta");
  kz_axis_rules(reading, &scene->attractors.velocity, "attractors.velocity");
  if (scene->has_basin)
    kz_complain(reading, kz_tree_child(reading->root, "attractors"), "attractors",
                "repeats what basin does, which finds the attractors of its window itself; give one of them");
}

static void saddles_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_saddles) return;
  kz_theta_rules(reading, &scene->saddles.theta, "saddles.theta");
  kz_axis_rules(reading, &scene->saddles.velocity, "saddles.velocity");
}

static void edge_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_edge) return;
  if (!scene->has_basin && !scene->has_attractors)
    kz_complain(reading, kz_tree_child(reading->root, "edge"), "edge",
                "needs a list of attractors; add a basin or attractors study to the scene");
  else if (!reading->message[0] && !(scene->parameters.pendulum.beta > 0))
    kz_complain(reading, kz_tree_child(reading->root, "edge"), "edge",
                "needs damping, because without it there are no attractors; give damping");
}

static void manifolds_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_manifolds || scene->has_saddles) return;
  kz_complain(reading, kz_tree_child(reading->root, "manifolds"), "manifolds",
              "needs a list of unstable cycles; add a saddles study to the scene");
}

/* Complains about `name` of the study orbit where it is given. */
static void orbit_refuse(kz_reading *reading, const char *name, const char *why) {
  const kz_node *node = kz_tree_find(reading->root, name);
  if (node) kz_complain(reading, node, name, "%s", why);
}

/* Refuses keys that contradict orbit.attractor. */
static void orbit_attractor_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin && !scene->has_attractors)
    orbit_refuse(reading, "orbit.attractor", "needs a list of attractors; add a basin or attractors study to the scene");
  orbit_refuse(reading, "orbit.start", "contradicts attractor; give one of them");
  if (!scene->orbit.closed)
    orbit_refuse(reading, "orbit.closed",
                 "contradicts attractor, whose orbit is closed; set true, or give a start instead of attractor");
  scene->orbit.closed = true;
  orbit_refuse(reading, "orbit.period", "follows from orbit.attractor; leave it out");
  if (scene->orbit.model != KZ_PENDULUM)
    orbit_refuse(reading, "orbit.model",
                 "has no attractors; choose the model pendulum, or give orbit.start instead of orbit.attractor");
}

static void orbit_rules(kz_reading *reading, kz_scene *scene) {
  kz_orbit_plan *orbit = &scene->orbit;
  if (!scene->has_orbit) return;
  const bool linear = orbit->model == KZ_MATHIEU;
  if (orbit->attractor != KZ_UNSET_INTEGER)
    orbit_attractor_rules(reading, scene);
  else if (!kz_tree_find(reading->root, "orbit.start"))
    kz_complain(reading, NULL, "orbit.start", "is missing; give a mapping of theta and velocity, or an attractor instead");
  if (!linear) orbit_refuse(reading, "orbit.about", "belongs to the model mathieu only; leave it out");
  if (orbit->model == KZ_EFFECTIVE && orbit->closed)
    orbit_refuse(reading, "orbit.closed", "cannot be used with the model effective, which has no drive; set false");
  if (!orbit->closed) orbit_refuse(reading, "orbit.period", "belongs to closed orbits only; add closed: true");
  if (linear && orbit->closed && orbit->period == KZ_UNSET_INTEGER)
    kz_complain(reading, NULL, "orbit.period",
                "is missing; give the period of the closed orbit, which cannot be found for the model mathieu");
  if (linear && orbit->about == KZ_UNSET_WORD) orbit->about = 0;
}

static void stability_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_stability) return;
  kz_ends_rules(reading, &scene->stability.k, "stability.k");
  kz_ends_rules(reading, &scene->stability.m, "stability.m");
}

static void tradeoff_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_tradeoff || scene->has_basin) return;
  kz_complain(reading, kz_tree_child(reading->root, "tradeoff"), "tradeoff", "needs a window; add a basin study to the scene");
}

/* Whether the motions of a pendulum can be followed; `path` names what gives it. */
static void check_stiffness(kz_reading *reading, const kz_pendulum *pendulum, const char *path) {
  if (kz_stiffness(pendulum) <= KZ_MOST_STIFFNESS) return;
  kz_complain(reading, kz_tree_find(reading->root, path), path,
              "gives abs(k) + abs(m) = %.3g; the program follows motions up to %g; use a weaker or faster drive",
              kz_stiffness(pendulum), KZ_MOST_STIFFNESS);
}

/* The scene's own pendulum, where a study follows motions of it. */
static void stiffness_rules(kz_reading *reading, kz_scene *scene) {
  const bool follows = scene->has_basin || scene->has_attractors || scene->has_saddles || scene->has_orbit;
  if (follows && !reading->message[0]) check_stiffness(reading, &scene->parameters.pendulum, "pendulum");
}

/* Converts a value that was written with a unit to the unit of the parameter. */
static void read_in_unit(kz_reading *reading, int32_t parameter, const char *path, double *value) {
  const char *unit = kz_sweep_parameters[parameter].unit;
  const kz_node *node = kz_tree_find(reading->root, path);
  const char *wrong = node && !isnan(*value) ? kz_scalar_quantity(node, unit, value) : NULL;
  if (wrong)
    kz_complain(reading, node, path, "\"%.60s\" %s; it must be a number%s%s, as pendulum.%s is", node->text, wrong,
                unit[0] == '1' ? "" : " in ", unit[0] == '1' ? "" : unit, kz_sweep_parameters[parameter].name);
}

/* One value of a key of the pendulum mapping: in the range of the key itself, and a pendulum. */
static void parameter_value(kz_reading *reading, const kz_scene *scene, int32_t parameter, const char *path, double value) {
  char key[64];
  kz_pendulum pendulum;
  const kz_node *node = kz_tree_find(reading->root, path);
  snprintf(key, sizeof key, "pendulum.%s", kz_sweep_parameters[parameter].name);
  const double low = kz_key_find(reading->keys, key)->low;
  if (isnan(value)) return;
  if (value < low)
    kz_complain(reading, node, path, "%s is below what %s takes; %s%g", kz_shortest(value).text, key,
                low == KZ_ABOVE_ZERO ? "above " : "at least ", low == KZ_ABOVE_ZERO ? 0.0 : low);
  else if (reading->message[0])
    return;
  else if (!kz_pendulum_at(scene, 1, &parameter, &value, &pendulum))
    kz_complain(reading, node, path,
                "%s gives no finite k, beta >= 0 and m, or an inertia below mass * radius^2; use a less extreme value",
                kz_shortest(value).text);
  else
    check_stiffness(reading, &pendulum, path);
}

/* The values of a key of the pendulum mapping that `path` walks along. */
static void parameter_values(kz_reading *reading, const kz_scene *scene, int32_t parameter, kz_axis *values, const char *path) {
  char key[64], name[64];
  if (parameter == KZ_UNSET_WORD) return;
  snprintf(name, sizeof name, "%s.min", path);
  read_in_unit(reading, parameter, name, &values->min);
  snprintf(name, sizeof name, "%s.max", path);
  read_in_unit(reading, parameter, name, &values->max);
  kz_axis_rules(reading, values, path);
  snprintf(key, sizeof key, "pendulum.%s", kz_sweep_parameters[parameter].name);
  snprintf(name, sizeof name, "%s.parameter", path);
  if (!kz_tree_find(reading->root, key))
    kz_complain(reading, kz_tree_find(reading->root, name), name,
                "%s is not given in the pendulum mapping; name a key that is written there",
                kz_sweep_parameters[parameter].name);
  snprintf(name, sizeof name, "%s.min", path);
  parameter_value(reading, scene, parameter, name, values->min);
  snprintf(name, sizeof name, "%s.max", path);
  parameter_value(reading, scene, parameter, name, values->max);
}

static void sweep_rules(kz_reading *reading, kz_scene *scene) {
  kz_sweep_plan *sweep = &scene->sweep;
  if (!scene->has_sweep) return;
  kz_theta_rules(reading, &sweep->theta, "sweep.theta");
  kz_axis_rules(reading, &sweep->velocity, "sweep.velocity");
  if (scene->has_basin && !isnan(scene->basin.accuracy))
    kz_complain(reading, kz_tree_find(reading->root, "basin.accuracy"), "basin.accuracy",
                "is chosen for one pendulum, and a sweep has many; give method, icm and numerics instead");
  parameter_values(reading, scene, sweep->parameter, &sweep->values, "sweep");
}

static void chart_axis_rules(kz_reading *reading, kz_scene *scene, kz_chart_axis *axis, const char *path) {
  parameter_values(reading, scene, axis->parameter, &axis->values, path);
}

static void chart_rules(kz_reading *reading, kz_scene *scene) {
  kz_chart_plan *chart = &scene->chart;
  if (!scene->has_chart) return;
  chart_axis_rules(reading, scene, &chart->x, "chart.x");
  chart_axis_rules(reading, scene, &chart->y, "chart.y");
  if (chart->x.parameter == chart->y.parameter && chart->y.parameter != KZ_UNSET_WORD)
    kz_complain(reading, kz_tree_find(reading->root, "chart.y.parameter"), "chart.y.parameter",
                "is also the parameter of chart.x; name another key of the pendulum mapping");
  if (chart->velocity.count != 1 && chart->velocity.count != chart->theta.count)
    kz_complain(reading, kz_tree_find(reading->root, "chart.start.velocity"), "chart.start.velocity",
                "has %lld values for %lld angles; give one for each angle, or one for all", (long long)chart->velocity.count,
                (long long)chart->theta.count);
}

/* Whether the pendulum, or one of the sweep's, has no mirror symmetry. */
static void symmetry_rules(kz_reading *reading, kz_scene *scene) {
  const kz_pendulum_keys *written = &scene->parameters.written;
  (void)reading;
  scene->basin.unmirrored =
      !isnan(written->tilt) || !isnan(written->ellipse) || !isnan(written->torque) || !isnan(written->torque_amplitude);
}

/* Refuses orbits for which the motion is too fast or the model does not hold. */
static void orbit_range_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_orbit || reading->message[0]) return;
  const double steps = kz_orbit_steps(scene), k = scene->parameters.pendulum.k;
  if (steps > KZ_MOST_ORBIT_STEPS)
    kz_complain(
        reading, kz_tree_find(reading->root, "orbit"), "orbit",
        "needs %.3g steps a period for a motion this fast, at most %d are possible; use a slower start or weaker forces", steps,
        KZ_MOST_ORBIT_STEPS);
  if (scene->orbit.model == KZ_EFFECTIVE && fabs(k) >= 1)
    kz_complain(reading, kz_tree_find(reading->root, "orbit.model"), "orbit.model",
                "effective averages over a fast drive, abs(k) < 1, but k = %.9g; use another model or a faster drive", k);
}

/* Sets basin.max_periods, if the scene does not, from the weakest damping. */
static void settling_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin || reading->message[0] || scene->basin.max_periods != KZ_UNSET_INTEGER) return;
  scene->basin.max_periods = kz_settling_scene(scene);
}

typedef void (*rule)(kz_reading *reading, kz_scene *scene);
static const rule rules[] = {basin_rules,     table_rules, undecided_rules, shocks_rules,   attractors_rules,  saddles_rules,
                             manifolds_rules, orbit_rules, stability_rules, tradeoff_rules, kz_pendulum_rules, symmetry_rules,
                             stiffness_rules, sweep_rules, chart_rules,     edge_rules,     orbit_range_rules, settling_rules};

void kz_reading_rules(kz_reading *reading) {
  for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) rules[i](reading, reading->scene);
}
