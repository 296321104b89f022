/* Rules between keys, and values that follow from others. Each rule complains at the node that a user would change. */
#include <math.h>
#include <stdio.h>

#include "kapitza/study.h"
#include "scene.h"

typedef struct {
  char text[32];
} decimal;

/* The number as a user would write it. */
static decimal shortest(double value) {
  decimal number;
  kz_scalar_print(value, number.text);
  return number;
}

/* min < max, and cells that double precision can tell apart. `path` names the mapping of the axis. */
static void check_axis(kz_reading *reading, const kz_axis *axis, const char *path) {
  char name[128];
  if (isnan(axis->min) || isnan(axis->max)) return;
  snprintf(name, sizeof name, "%s.max", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  const double cell = (axis->max - axis->min) / (double)(axis->count > 0 ? axis->count : 1);
  if (axis->max <= axis->min)
    kz_complain(reading, node, name, "%s is too small; it must be greater than min = %s", shortest(axis->max).text,
                shortest(axis->min).text);
  else if (cell < 8.0 * DBL_EPSILON * fmax(fabs(axis->min), fabs(axis->max)))
    kz_complain(reading, node, name,
                "%s leaves cells of width %g, too narrow for double precision; use a wider window or a smaller count",
                shortest(axis->max).text, cell);
}

static bool is_exact(const kz_basin_plan *plan) {
  return isnan(plan->accuracy) ? plan->method == KZ_METHOD_EXACT : plan->accuracy >= 1;
}

/* A window by its middle: cells that pairs of doubles can tell apart, and the method where doubles cannot. */
static void check_centred(kz_reading *reading, const kz_basin_plan *plan, const kz_axis *axis, const char *path) {
  static const double pairs = 0x1p-102; /* some last places of a pair of doubles */
  char name[128];
  snprintf(name, sizeof name, "%s.width", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  const double cell = axis->width.high / (double)(axis->count > 0 ? axis->count : 1);
  if (cell < pairs * fmax(fabs(axis->centre.high), axis->width.high))
    kz_complain(reading, node, name,
                "%s leaves cells of width %g, too narrow for 32 digits; use a wider window or a smaller count",
                axis->width.text, cell);
  else if (kz_axis_is_deep(axis) && !is_exact(plan))
    kz_complain(reading, node, name, "%s leaves cells of width %g, too narrow for double precision; choose basin.method exact",
                axis->width.text, cell);
}

/* The axis of a basin from its edges, or from its centre and width. */
static void set_axis(kz_reading *reading, const kz_basin_plan *plan, kz_edges edges, kz_axis *axis, const char *path) {
  char name[128];
  axis->min = edges.min;
  axis->max = edges.max;
  if (!axis->centre.text[0] && !axis->width.text[0]) return;
  const bool has_centre = axis->centre.text[0];
  snprintf(name, sizeof name, "%s.%s", path, has_centre ? "width" : "centre");
  if (!has_centre || !axis->width.text[0]) {
    kz_complain(reading, NULL, name, "is missing beside %s; give both", has_centre ? "centre" : "width");
    return;
  }
  axis->min = axis->centre.high - axis->width.high / 2;
  axis->max = axis->centre.high + axis->width.high / 2;
  check_centred(reading, plan, axis, path);
}

/* Both edges or neither; neither is the whole circle. */
static void theta_window(kz_reading *reading, kz_axis *theta, const char *path) {
  char min[128], max[128];
  snprintf(min, sizeof min, "%s.min", path);
  snprintf(max, sizeof max, "%s.max", path);
  const kz_node *min_node = kz_tree_find(reading->root, min), *max_node = kz_tree_find(reading->root, max);
  if (min_node && !max_node) kz_complain(reading, NULL, max, "is missing beside min; give both or neither");
  if (max_node && !min_node) kz_complain(reading, NULL, min, "is missing beside max; give both or neither");
  if (!min_node && !max_node) {
    theta->min = -M_PI;
    theta->max = M_PI;
  }
  check_axis(reading, theta, path);
  if (theta->max - theta->min > 2.0 * M_PI)
    kz_complain(reading, max_node, max, "%s makes the window %s rad wide; it must be at most 2 pi", shortest(theta->max).text,
                shortest(theta->max - theta->min).text);
}

static void basin_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin) return;
  kz_basin_plan *plan = &scene->basin;
  set_axis(reading, plan, plan->theta_edges, &plan->theta, "basin.theta");
  set_axis(reading, plan, plan->velocity_edges, &plan->velocity, "basin.velocity");
  if (!plan->theta.centre.text[0]) {
    theta_window(reading, &plan->theta, "basin.theta");
    plan->theta_edges = (kz_edges){plan->theta.min, plan->theta.max};
  } else if (plan->theta.width.high > 2 * M_PI) {
    kz_complain(reading, kz_tree_find(reading->root, "basin.theta.width"), "basin.theta.width",
                "%s is too wide; it must be at most 2 pi", plan->theta.width.text);
  }
  if (!plan->velocity.centre.text[0]) check_axis(reading, &plan->velocity, "basin.velocity");
}

/* Sizes of shocks go up, as an axis does. */
static void shocks_rules(kz_reading *reading, kz_scene *scene) {
  const kz_reals *sizes = &scene->basin.shocks.sizes;
  const kz_node *node = kz_tree_find(reading->root, "basin.shocks.sizes");
  if (!scene->has_basin || !scene->basin.has_shocks) return;
  if (sizes->count < 1 || sizes->count > KZ_MOST_SHOCK_SIZES)
    kz_complain(reading, node, "basin.shocks.sizes", "has %lld values; from 1 to %d", (long long)sizes->count,
                KZ_MOST_SHOCK_SIZES);
  for (int64_t i = 1; i < sizes->count; i++)
    if (!(sizes->values[i] > sizes->values[i - 1]))
      kz_complain(reading, node, "basin.shocks.sizes", "%s does not exceed the size before it; sizes must go up",
                  shortest(sizes->values[i]).text);
}

static void attractors_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_attractors) return;
  theta_window(reading, &scene->attractors.theta, "attractors.theta");
  check_axis(reading, &scene->attractors.velocity, "attractors.velocity");
  if (scene->has_basin)
    kz_complain(reading, kz_tree_child(reading->root, "attractors"), "attractors",
                "stands beside basin, which finds the attractors of its window itself; give one of them");
}

static void saddles_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_saddles) return;
  theta_window(reading, &scene->saddles.theta, "saddles.theta");
  check_axis(reading, &scene->saddles.velocity, "saddles.velocity");
}

static void edge_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_edge) return;
  if (!scene->has_basin && !scene->has_attractors)
    kz_complain(reading, kz_tree_child(reading->root, "edge"), "edge",
                "has no catalogue of ends; add a basin or attractors study to the scene");
  else if (!reading->message[0] && !(scene->parameters.pendulum.beta > 0))
    kz_complain(reading, kz_tree_child(reading->root, "edge"), "edge",
                "needs damping: without it nothing attracts, and there are no basins");
}

static void manifolds_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_manifolds || scene->has_saddles) return;
  kz_complain(reading, kz_tree_child(reading->root, "manifolds"), "manifolds",
              "has no cycles to grow from; add a saddles study to the scene");
}

/* Complains about `name` of the study orbit where it is given. */
static void orbit_refuse(kz_reading *reading, const char *name, const char *why) {
  const kz_node *node = kz_tree_find(reading->root, name);
  if (node) kz_complain(reading, node, name, "%s", why);
}

/* The keys that an attractor answers itself. */
static void orbit_attractor_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin && !scene->has_attractors)
    orbit_refuse(reading, "orbit.attractor", "has no catalogue to choose from; add a basin or attractors study to the scene");
  orbit_refuse(reading, "orbit.start", "contradicts attractor; give one of them");
  if (!scene->orbit.closed)
    orbit_refuse(reading, "orbit.closed",
                 "contradicts attractor, whose orbit is closed; set true, or give a start instead of attractor");
  scene->orbit.closed = true;
  orbit_refuse(reading, "orbit.period", "is known from attractor; leave it out");
  if (scene->orbit.model != KZ_PENDULUM)
    orbit_refuse(reading, "orbit.model", "has no attractors of the catalogue; choose the model pendulum, or give a start");
}

static void orbit_rules(kz_reading *reading, kz_scene *scene) {
  kz_orbit_plan *orbit = &scene->orbit;
  if (!scene->has_orbit) return;
  const bool linear = orbit->model == KZ_MATHIEU;
  if (orbit->attractor != KZ_UNSET_INTEGER)
    orbit_attractor_rules(reading, scene);
  else if (!kz_tree_find(reading->root, "orbit.start"))
    kz_complain(reading, NULL, "orbit.start", "is missing; give a mapping of theta and velocity, or an attractor instead");
  if (!linear) orbit_refuse(reading, "orbit.about", "belongs to the model mathieu alone; leave it out");
  if (orbit->model == KZ_EFFECTIVE && orbit->closed)
    orbit_refuse(reading, "orbit.closed", "cannot be used with the model effective, which has no drive; set false");
  if (!orbit->closed) orbit_refuse(reading, "orbit.period", "belongs to closed orbits alone; add closed: true");
  if (linear && orbit->closed && orbit->period == KZ_UNSET_INTEGER)
    kz_complain(reading, NULL, "orbit.period",
                "is missing; give the period of the closed orbit, which cannot be found for the model mathieu");
  if (linear && orbit->about == KZ_UNSET_WORD) orbit->about = 0;
}

/* Values from min to max, both included: one value where they are equal. */
static void check_ends(kz_reading *reading, const kz_axis *axis, const char *path) {
  char name[128];
  snprintf(name, sizeof name, "%s.max", path);
  const kz_node *node = kz_tree_find(reading->root, name);
  if (axis->count == 1 && axis->max != axis->min)
    kz_complain(reading, node, name, "%s differs from min = %s; they must be equal because count is 1",
                shortest(axis->max).text, shortest(axis->min).text);
  else if (axis->count > 1 && axis->max <= axis->min)
    kz_complain(reading, node, name, "%s is too small; it must be greater than min = %s", shortest(axis->max).text,
                shortest(axis->min).text);
}

static void stability_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_stability) return;
  check_ends(reading, &scene->stability.k, "stability.k");
  check_ends(reading, &scene->stability.m, "stability.m");
}

static void tradeoff_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_tradeoff || scene->has_basin) return;
  kz_complain(reading, kz_tree_child(reading->root, "tradeoff"), "tradeoff",
              "has no window to label; add a basin study to the scene");
}

/* Whether the motions of a pendulum can be followed; `path` names what gives it. */
static void check_stiffness(kz_reading *reading, const kz_pendulum *pendulum, const char *path) {
  if (kz_stiffness(pendulum) <= KZ_MOST_STIFFNESS) return;
  kz_complain(reading, kz_tree_find(reading->root, path), path,
              "gives abs(k) + abs(m) = %.3g; motions are followed up to %g: a weaker or faster drive", kz_stiffness(pendulum),
              KZ_MOST_STIFFNESS);
}

/* The scene's own pendulum, where a study follows motions of it. */
static void stiffness_rules(kz_reading *reading, kz_scene *scene) {
  const bool follows = scene->has_basin || scene->has_attractors || scene->has_saddles || scene->has_orbit;
  if (follows && !reading->message[0]) check_stiffness(reading, &scene->parameters.pendulum, "pendulum");
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
    kz_complain(reading, node, path, "%s is below what %s takes; %s%g", shortest(value).text, key,
                low == KZ_ABOVE_ZERO ? "above " : "at least ", low == KZ_ABOVE_ZERO ? 0.0 : low);
  else if (reading->message[0])
    return;
  else if (!kz_pendulum_at(scene, 1, &parameter, &value, &pendulum))
    kz_complain(reading, node, path,
                "%s gives no finite k, beta >= 0 and m, or an inertia below mass * radius^2; a less extreme value",
                shortest(value).text);
  else
    check_stiffness(reading, &pendulum, path);
}

/* The values of a key of the pendulum mapping that `path` walks along. */
static void parameter_values(kz_reading *reading, const kz_scene *scene, int32_t parameter, const kz_axis *values,
                             const char *path) {
  char key[64], name[64];
  if (parameter == KZ_UNSET_WORD) return;
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
  theta_window(reading, &sweep->theta, "sweep.theta");
  check_axis(reading, &sweep->velocity, "sweep.velocity");
  check_axis(reading, &sweep->values, "sweep");
  if (scene->has_basin && !isnan(scene->basin.accuracy))
    kz_complain(reading, kz_tree_find(reading->root, "basin.accuracy"), "basin.accuracy",
                "is chosen for one pendulum, and a sweep has many; give method, icm and numerics instead");
  if (scene->has_basin && scene->basin.method == KZ_METHOD_EXACT)
    kz_complain(reading, kz_tree_find(reading->root, "basin.method"), "basin.method",
                "exact labels the cells of one pendulum, and a sweep has many; choose direct or icm");
  parameter_values(reading, scene, sweep->parameter, &sweep->values, "sweep");
}

static void chart_axis_rules(kz_reading *reading, kz_scene *scene, const kz_chart_axis *axis, const char *path) {
  check_axis(reading, &axis->values, path);
  parameter_values(reading, scene, axis->parameter, &axis->values, path);
}

static void chart_rules(kz_reading *reading, kz_scene *scene) {
  const kz_chart_plan *chart = &scene->chart;
  if (!scene->has_chart) return;
  chart_axis_rules(reading, scene, &chart->x, "chart.x");
  chart_axis_rules(reading, scene, &chart->y, "chart.y");
  if (chart->x.parameter == chart->y.parameter && chart->y.parameter != KZ_UNSET_WORD)
    kz_complain(reading, kz_tree_find(reading->root, "chart.y.parameter"), "chart.y.parameter",
                "is that of chart.x too; name another key of the pendulum mapping");
  if (chart->velocity.count != 1 && chart->velocity.count != chart->theta.count)
    kz_complain(reading, kz_tree_find(reading->root, "chart.start.velocity"), "chart.start.velocity",
                "has %lld values for %lld angles; give one for each angle, or one for all", (long long)chart->velocity.count,
                (long long)chart->theta.count);
}

/* Scheme and steps that the scene comes to, for one that is right. */
static void numerics_rules(kz_reading *reading, kz_scene *scene) {
  if (!reading->message[0]) kz_numerics_resolve(scene);
}

/* No body has less inertia about the pivot than its mass in one point. */
static void inertia_rules(kz_reading *reading, kz_scene *scene) {
  const kz_pendulum_keys *written = &scene->parameters.written;
  if (reading->message[0] || isnan(written->inertia) || kz_inertia_is_possible(written)) return;
  kz_complain(reading, kz_tree_find(reading->root, "pendulum.inertia"), "pendulum.inertia",
              "%s is below pendulum.mass * pendulum.radius^2 = %s, the least of any body; at least that",
              shortest(written->inertia).text, shortest(kz_point_inertia(written)).text);
}

/* k, beta, m from the form that the scene chose; only a reading without complaints has it whole. */
static void pendulum_rules(kz_reading *reading, kz_scene *scene) {
  if (!kz_tree_child(reading->root, "pendulum")) { /* stability alone does without */
    scene->parameters.pendulum = (kz_pendulum){NAN, NAN, NAN};
    scene->parameters.quality_factor = scene->parameters.drive_frequency = scene->parameters.drive_amplitude = NAN;
    scene->parameters.pivot_frequency = NAN;
    return;
  }
  inertia_rules(reading, scene);
  const kz_pendulum_keys *written = &scene->parameters.written;
  if (!isnan(written->frequency) && !isnan(written->pivot_frequency))
    kz_complain(reading, kz_tree_find(reading->root, "pendulum.frequency"), "pendulum.frequency",
                "contradicts pivot_frequency, which gives the same in rad s-1; give one of them");
  if (!isnan(written->mass) && isnan(written->frequency) && isnan(written->pivot_frequency))
    kz_complain(reading, NULL, "pendulum.pivot_frequency",
                "is missing; it must be a number above 0 in rad s-1, or give frequency in Hz");
  if (reading->message[0] || kz_parameters_resolve(&scene->parameters) == KZ_OK) return;
  char wrong[256];
  snprintf(wrong, sizeof wrong, "%s", kz_message());
  kz_message_clear();
  kz_complain(reading, kz_tree_child(reading->root, "pendulum"), "pendulum", "%s", wrong);
}

/* What the resolved pendulum does not allow an orbit. */
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

/* As long as the weakest damping needs, where the scene does not say. */
static void settling_rules(kz_reading *reading, kz_scene *scene) {
  if (!scene->has_basin || reading->message[0] || scene->basin.max_periods != KZ_UNSET_INTEGER) return;
  scene->basin.max_periods = kz_settling_scene(scene);
}

typedef void (*rule)(kz_reading *reading, kz_scene *scene);
static const rule rules[] = {basin_rules, shocks_rules,    attractors_rules,  saddles_rules,  manifolds_rules,
                             orbit_rules, stability_rules, tradeoff_rules,    pendulum_rules, stiffness_rules,
                             sweep_rules,
                             chart_rules, edge_rules,      orbit_range_rules, settling_rules, numerics_rules};

void kz_reading_rules(kz_reading *reading) {
  for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) rules[i](reading, reading->scene);
}
