/* Study `basin`: measures of the labelled grid, its groups in the file, its summary. */
#include "basin.h"

enum { MOST_FLAGS = 16000 }; /* an attribute of numbers holds 64 KiB */

/* Measures of the settled cells, NaN where those are the smaller part: basin entropy; the uncertainty exponent, and the
 * distances (rad) over which it was found. */
typedef struct {
  double entropy, boundary_entropy, nearest, farthest;
  kz_line exponent;
} measures;

/* Slope of ln(uncertain share) against ln(distance), distances 1, 2, 4, ... columns. */
static void find_exponent(double cell, const kz_counts *counts, measures *m) {
  double x[KZ_DISTANCES], y[KZ_DISTANCES];
  int n = 0;
  for (; n < KZ_DISTANCES && kz_uncertain_share(counts, n) > 0; n++) {
    x[n] = log(ldexp(1, n));
    y[n] = log(kz_uncertain_share(counts, n));
  }
  m->exponent = kz_fit_line(n, x, y);
  if (isnan(m->exponent.slope)) return;
  m->nearest = cell;
  m->farthest = ldexp(cell, n - 1);
}

static void print_measures(const measures *m, int64_t unsettled, FILE *summary) {
  if (isnan(m->entropy)) {
    fprintf(summary, "Basin entropy and uncertainty exponent are not computed, because most cells did not settle.\n");
    return;
  }
  fprintf(summary, "Basin entropy: %.4f, at the boundaries %.4f", m->entropy, m->boundary_entropy);
  if (!isnan(m->exponent.slope))
    fprintf(summary,
            ". Uncertainty exponent: %.3f +- %.3f (standard error of the fit), for distances from %.3g to %.3g rad",
            m->exponent.slope, m->exponent.slope_stderr, m->nearest, m->farthest);
  fprintf(summary, ".%s\n", unsettled > 0 ? " Both leave unsettled cells out." : "");
}

static kz_status write_measures(const kz_basin_plan *plan, const kz_window_summary *labels, kz_store *store,
                                FILE *summary) {
  measures m = {NAN, NAN, NAN, NAN, {.slope = NAN, .slope_stderr = NAN}};
  if (2 * labels->counts.unsettled <= labels->cells) {
    kz_entropy_of(&labels->counts, &m.entropy, &m.boundary_entropy);
    find_exponent(kz_axis_step(&plan->theta), &labels->counts, &m);
  }
  KZ_TRY(kz_store_real(store, "basin", "trapped_share", labels->trapped_share));
  KZ_TRY(kz_store_real(store, "basin", "step_error", labels->step_error));
  KZ_TRY(kz_store_real(store, "basin", "table_error", labels->table_error));
  KZ_TRY(kz_store_real(store, "basin", "basin_entropy", m.entropy));
  KZ_TRY(kz_store_real(store, "basin", "boundary_basin_entropy", m.boundary_entropy));
  KZ_TRY(kz_store_real(store, "basin", "uncertainty_exponent", m.exponent.slope));
  KZ_TRY(kz_store_real(store, "basin", "uncertainty_exponent_stderr", m.exponent.slope_stderr));
  KZ_TRY(kz_store_real(store, "basin", "uncertainty_exponent_nearest", m.nearest));
  KZ_TRY(kz_store_real(store, "basin", "uncertainty_exponent_farthest", m.farthest));
  print_measures(&m, labels->counts.unsettled, summary);
  return KZ_OK;
}

static kz_status write_numerics(const kz_scene *scene, kz_store *store) {
  const kz_basin_plan *plan = scene->basin;
  KZ_TRY(kz_store_text(store, "basin", "method", kz_method_names[plan->method]));
  KZ_TRY(kz_store_integer(store, "basin", "max_periods", plan->max_periods));
  KZ_TRY(kz_store_text(store, "basin", "scheme", kz_scheme_at(scene->numerics.scheme).name));
  KZ_TRY(kz_store_integer(store, "basin", "steps_per_period", scene->numerics.steps_per_period));
  KZ_TRY(kz_store_real(store, "basin", "tolerance", scene->asked.tolerance));
  KZ_TRY(kz_store_text(store, "basin", "interpolation", kz_interpolation_names[plan->interpolation]));
  KZ_TRY(kz_store_integer(store, "basin", "table_theta", plan->table_theta));
  return kz_store_integer(store, "basin", "table_velocity", plan->table_velocity);
}

/* Writes an axis; where doubles may not tell cells apart, also shares of the width and the centre as written. */
static kz_status write_axis(const kz_axis *axis, const char *name, kz_store *store) {
  char label[32];
  KZ_SCALE(store, "basin", name, axis->count, kz_axis_centre(axis, i));
  if (!kz_axis_is_centred(axis)) return KZ_OK;
  snprintf(label, sizeof label, "%s_offset", name);
  KZ_COLUMN(store, "basin", label, axis->count, double, kz_axis_share(axis, i));
  snprintf(label, sizeof label, "%s_centre", name);
  KZ_TRY(kz_store_text(store, "basin", label, axis->centre.text));
  snprintf(label, sizeof label, "%s_width", name);
  return kz_store_text(store, "basin", label, axis->width.text);
}

/* A name with the characters that CF allows: "rotation +1/2" is rotation_+1_in_2. */
static void print_word(const char *name, FILE *out) {
  for (const char *c = name; *c; c++) {
    if (*c == '/')
      fputs("_in_", out);
    else
      fputc(strchr("+-.@", *c) || (*c >= '0' && *c <= '9') || (*c >= 'A' && *c <= 'Z') || (*c >= 'a' && *c <= 'z')
                ? *c
                : '_',
            out);
  }
}

/* Whether another entry has the name too. */
static bool is_shared(const kz_catalogue *catalogue, int64_t which) {
  for (int64_t i = 0; i < catalogue->count; i++)
    if (i != which && strcmp(catalogue->entries[i].name, catalogue->entries[which].name) == 0) return true;
  return false;
}

/* Writes flag_values (-1 = not settled, ids) and flag_meanings of basin/attractor, up to MOST_FLAGS attractors. */
static kz_status write_flags(const kz_catalogue *catalogue, kz_store *store) {
  char *words = NULL;
  size_t bytes = 0;
  if (catalogue->count > MOST_FLAGS) return KZ_OK;
  FILE *out = open_memstream(&words, &bytes);
  if (!out) return kz_fail(KZ_FAILED, "out of memory for the meanings of the labels");
  fputs("not_settled", out);
  for (int64_t i = 0; i < catalogue->count; i++) {
    fputc(' ', out);
    print_word(catalogue->entries[i].name, out);
    if (is_shared(catalogue, i)) fprintf(out, "_%lld", (long long)i);
  }
  kz_status status = fclose(out) == 0 ? KZ_OK : kz_fail(KZ_FAILED, "out of memory for the meanings of the labels");
  if (status == KZ_OK) status = kz_store_flags(store, "basin", "attractor", -1, catalogue->count + 1, words);
  free(words);
  return status;
}

kz_status kz_basin_declare(const kz_scene *scene, const kz_tiles *tiles, kz_store *store) {
  KZ_TRY(write_axis(&scene->basin->theta, "theta", store));
  KZ_TRY(write_axis(&scene->basin->velocity, "velocity", store));
  return kz_chunks_declare(scene->basin, tiles, store);
}

static void print_settled(const kz_scene *scene, const kz_window_summary *labels, bool attracts, FILE *summary) {
  const long long unsettled = labels->counts.unsettled, cells = labels->cells;
  if (unsettled == 0)
    fprintf(summary, "All %lld cells settled within ", cells);
  else
    fprintf(summary, "%lld of %lld cells did not settle within ", unsettled, cells);
  kz_periods_print(scene->basin->max_periods, scene->parameters.pivot_frequency, summary);
  fputs(".\n", summary);
  if (unsettled > 0 && attracts)
    fprintf(
        summary,
        "Here a motion takes some %.0f periods to come e times closer to its attractor: a larger basin.max_periods or "
        "basin.attractors.max_period may settle more cells.\n",
        1 / (M_PI * scene->parameters.pendulum.beta));
}

static void print_decided(const kz_window_summary *labels, FILE *summary) {
  const long long undecided = labels->counts.evidence[KZ_UNDECIDED], averaged = labels->counts.evidence[KZ_AVERAGED];
  if (averaged > 0)
    fprintf(summary,
            "%lld cells end on a running state that averages along orbits show (evidence 12); no band round it was "
            "found that "
            "traps motions.\n",
            averaged);
  else if (undecided == 0)
    fputs("All cells are decided.\n", summary);
  if (undecided > 0) fprintf(summary, "%lld cells are undecided (evidence 3): %s\n", undecided, labels->advice);
}

kz_status kz_basin_write(const kz_scene *scene, const kz_catalogue *catalogue, const kz_window_summary *labels,
                         kz_store *store, FILE *summary) {
  const kz_basin_plan *plan = scene->basin;
  kz_catalogue_print(catalogue, &scene->parameters, true, summary);
  print_settled(scene, labels, catalogue->count > 0, summary);
  if (plan->method == KZ_METHOD_EXACT) {
    print_decided(labels, summary);
    KZ_TRY(kz_store_integer(store, "basin", "undecided", labels->counts.evidence[KZ_UNDECIDED]));
  }
  KZ_TRY(kz_catalogue_write(catalogue, &scene->parameters.pendulum, true, store));
  KZ_TRY(write_flags(catalogue, store));
  KZ_TRY(write_numerics(scene, store));
  KZ_TRY(kz_doubt_write(&labels->doubt, plan->method, store, summary));
  return write_measures(plan, labels, store, summary);
}
