/* Properties of a pendulum: attractors, labelled starts and picture, map derivatives, shocks; made if needed. */
#include "measures.h"

enum {
  PILOTS = 512, /* starts of the search; others that end nowhere known start another one */
  ROUNDS = 2    /* Rounds of the search at most */
};

/* Starts spread evenly over a window, rad and rad per drive radian. */
static void measured_spread(const kz_window *window, const kz_measures_plan *plan, double *start) {
  kz_dynamics_starts(window, plan->seed, plan->starts, start);
  for (int64_t i = 0; i < plan->starts; i++) start[2 * i] *= M_PI;
}

/* Starts carried by the quantiles from the unit square to the Gaussian distribution. */
static void spread_by_weight(const kz_measures_plan *plan, double *start) {
  static const kz_window unit = {0, 1, 0, 1};
  const double least = 0x1p-54;
  measured_spread(&unit, plan, start);
  for (int64_t i = 0; i < plan->starts; i++) {
    const double p = fmin(fmax(start[2 * i], least), 1 - least), q = fmin(fmax(start[2 * i + 1], least), 1 - least);
    start[2 * i] = plan->options.weight.theta + plan->options.weight.theta_spread * kz_normal_quantile(p);
    start[2 * i + 1] = plan->options.weight.velocity + plan->options.weight.velocity_spread * kz_normal_quantile(q);
  }
}

/* The centres of the cells of the picture. */
static void cells_of(const kz_measures_plan *plan, double *start) {
  const int64_t cells = plan->options.cells;
  kz_axis theta = plan->theta, velocity = plan->velocity;
  theta.count = velocity.count = cells;
  for (int64_t i = 0; i < cells * cells; i++) {
    start[2 * i] = kz_axis_centre(&theta, i % cells);
    start[2 * i + 1] = kz_axis_centre(&velocity, i / cells);
  }
}

/* Lays out the sets that are needed, one after the other; returns how many starts there are. */
static int64_t lay_out(int32_t needs, kz_measured *m) {
  const kz_measures_plan *plan = m->plan;
  m->starts.n = needs & KZ_NEEDS_STARTS ? plan->starts : 0;
  m->weighted.n = needs & KZ_NEEDS_WEIGHTED ? plan->starts : 0;
  m->picture.n = needs & KZ_NEEDS_PICTURE ? plan->options.cells * plan->options.cells : 0;
  const int64_t n = m->starts.n + m->weighted.n + m->picture.n;
  m->start = kz_malloc(2 * (size_t)n * sizeof *m->start + 1);
  m->id = kz_malloc((size_t)n * sizeof *m->id + 1);
  m->time = kz_malloc((size_t)n * sizeof *m->time + 1);
  kz_ended *const sets[] = {&m->starts, &m->weighted, &m->picture};
  int64_t first = 0;
  for (int i = 0; i < 3; first += sets[i++]->n) {
    sets[i]->start = m->start + 2 * first;
    sets[i]->id = m->id + first;
    sets[i]->time = m->time + first;
  }
  const kz_window window = kz_window_of(&plan->theta, &plan->velocity);
  if (m->starts.n > 0) measured_spread(&window, plan, m->start);
  if (m->weighted.n > 0) spread_by_weight(plan, m->start + 2 * m->starts.n);
  if (m->picture.n > 0) cells_of(plan, m->start + 2 * (m->starts.n + m->weighted.n));
  return n;
}

/* The attractors that the labels name, and those of the search if nothing has labels. */
static void make_catalogue(int64_t n, const kz_label *label, const int32_t *found, int64_t pilots, kz_measured *m) {
  KZ_AUTOFREE int64_t *reached = kz_calloc((size_t)kz_dynamics_count(m->dynamics) + 1, sizeof *reached);
  for (int64_t i = 0; i < pilots; i++) reached[kz_larger(found[i], 0)]++;
  for (int64_t i = 0; i < n; i++) reached[label[i].label > 0 ? label[i].label : 0]++;
  kz_catalogue_make(m->dynamics, reached, &m->catalogue);
  for (int64_t i = 0; i < n; i++) {
    m->id[i] = label[i].label > 0 ? (int16_t)m->catalogue.id_of[label[i].label] : -1;
    m->time[i] = label[i].periods;
  }
}

static kz_status label_all(kz_way way, int32_t needs, int64_t max_periods, const kz_run *run, kz_measured *m) {
  const kz_measures_plan *plan = m->plan;
  const int64_t n = lay_out(needs, m), pilots = kz_smaller(plan->starts, PILOTS);
  const kz_search search = {
      .window = kz_window_of(&plan->theta, &plan->velocity), /* without grown regions: times count to the ellipses */
      .starts = pilots,
      .seed = plan->seed,
      .max_periods = max_periods};
  const kz_search_on on = {ROUNDS, pilots, NULL};
  KZ_AUTOFREE int32_t *found = kz_malloc((size_t)pilots * sizeof *found);
  KZ_AUTOFREE kz_label *label = kz_calloc((size_t)n + 1, sizeof *label);
  kz_labeller labeller = kz_pair_labeller(m->start, max_periods, way, m->dynamics);
  labeller.run = run;
  labeller.stage = "measures";
  KZ_TRY(kz_search_window(run, m->dynamics, &search, found));
  if (n > 0) KZ_TRY(kz_label_and_search(&labeller, &on, n, NULL, label));
  make_catalogue(n, label, found, pilots, m);
  return KZ_OK;
}

static void find_tangents(const kz_pendulum *pendulum, const kz_numerics *numerics, kz_measured *m) {
  int64_t n = 0;
  for (int64_t id = 0; id < m->catalogue.count; id++) n += m->catalogue.entries[id].row.period;
  KZ_AUTOFREE_BY(kz_flow_freed) kz_flow *flow = kz_flow_create(pendulum, numerics);
  m->tangent = kz_malloc((size_t)n * sizeof *m->tangent + 1);
  n = 0;
  for (int64_t id = 0; id < m->catalogue.count; id++) {
    const kz_entry *entry = m->catalogue.entries + id;
    for (int64_t phase = 0; phase < entry->row.period; phase++) {
      double theta = entry->theta[phase], velocity = entry->velocity[phase];
      int64_t turns = 0;
      kz_advance_tangent(flow, 1, 1, &theta, &velocity, &turns, m->tangent[n++].matrix);
    }
  }
}

static kz_status find_shocks(int32_t needs, int64_t max_periods, const kz_run *run, kz_measured *m) {
  const kz_measure_options *options = &m->plan->options;
  kz_resilience_plan plan = {.scale = options->shock_scale,
                             .farthest = 2 * kz_axis_fastest(&m->plan->velocity),
                             .tolerance = options->shock_tolerance,
                             .smallest = !(needs & (KZ_NEEDS_SHOCKS | KZ_NEEDS_SPREAD)),
                             .max_periods = max_periods};
  if (needs & KZ_NEEDS_SPREAD) plan.sizes = options->sizes;
  m->point = kz_resilience_list(m->dynamics, &m->catalogue, &m->n_points);
  return kz_resilience_run(run, m->dynamics, &plan, m->n_points, m->point);
}

kz_status kz_measured_make(const kz_pendulum *pendulum, const kz_numerics *numerics, const kz_measures_plan *plan,
                           kz_way way, int32_t needs, const kz_run *run, kz_measured *measured) {
  const int64_t max_periods = kz_settling_periods(pendulum->beta);
  *measured = (kz_measured){.plan = plan, .dynamics = kz_dynamics_create(pendulum, numerics, plan->max_period)};
  KZ_TRY(label_all(way, needs, max_periods, run, measured));
  if (needs & KZ_NEEDS_TANGENTS) find_tangents(pendulum, numerics, measured);
  return needs & (KZ_NEEDS_SHOCKS | KZ_NEEDS_SPREAD | KZ_NEEDS_SMALLEST)
             ? find_shocks(needs, max_periods, run, measured)
             : KZ_OK;
}

void kz_measured_free(kz_measured *measured) {
  kz_dynamics_free(measured->dynamics);
  kz_catalogue_free(&measured->catalogue);
  free(measured->tangent);
  free(measured->point);
  free(measured->start);
  free(measured->id);
  free(measured->time);
  *measured = (kz_measured){0};
}
