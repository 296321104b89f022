#include "catalogue.h"

#include <inttypes.h>

enum { SAMPLES = 96, LINES_PER_PERIOD = 8 };

void kz_catalogue_free(kz_catalogue *catalogue) {
  for (int64_t i = 0; i < catalogue->count; i++) {
    free(catalogue->entries[i].theta);
    free(catalogue->entries[i].velocity);
  }
  free(catalogue->entries);
  free(catalogue->id_of);
  *catalogue = (kz_catalogue){0};
}

static void catalogue_fill(kz_entry *entry, const kz_dynamics *dynamics, int64_t number) {
  kz_dynamics_attractor(dynamics, number, &entry->row);
  entry->theta = kz_calloc((size_t)(entry->row.period + 1), sizeof(double));
  entry->velocity = kz_calloc((size_t)(entry->row.period + 1), sizeof(double));
  kz_dynamics_strobe(dynamics, number, entry->theta, entry->velocity);
  kz_orbit_name(entry->row.period, entry->row.winding, entry->row.centre, entry->name);
  if (entry->row.centre > 1) entry->row.amplitude = NAN;
}

void kz_catalogue_make(const kz_dynamics *dynamics, const int64_t *reached, kz_catalogue *catalogue) {
  int64_t known = kz_dynamics_count(dynamics);
  KZ_AUTOFREE int64_t *order = kz_calloc((size_t)known + 1, sizeof *order);
  *catalogue = (kz_catalogue){.entries = kz_calloc((size_t)known + 1, sizeof(kz_entry)),
                              .id_of = kz_calloc((size_t)known + 1, sizeof(int32_t))};
  kz_dynamics_order(dynamics, order);
  for (int64_t i = 0; i <= known; i++) catalogue->id_of[i] = -1;
  for (int64_t i = 0; i < known; i++) {
    kz_entry entry = {.fraction = NAN};
    catalogue_fill(&entry, dynamics, order[i]);
    if (reached && reached[order[i]] == 0 && reached[entry.row.mirror] == 0) {
      free(entry.theta);
      free(entry.velocity);
      continue;
    }
    catalogue->id_of[order[i]] = (int32_t)catalogue->count;
    catalogue->entries[catalogue->count++] = entry;
  }
  for (int64_t i = 0; i < catalogue->count; i++)
    catalogue->entries[i].mirror = catalogue->id_of[catalogue->entries[i].row.mirror];
}

int64_t kz_catalogue_longest(const kz_catalogue *catalogue) {
  int64_t most = 1;
  for (int64_t i = 0; i < catalogue->count; i++)
    if (catalogue->entries[i].row.period > most) most = catalogue->entries[i].row.period;
  return most;
}

#define COLUMN(type, name, expression) KZ_COLUMN(store, group, name, catalogue->count, type, expression)

/* Columns of several values an attractor; NaN where undefined: beyond its period, multipliers of chaos. */
static kz_status write_matrices(const kz_catalogue *catalogue, int64_t phases, const char *group, kz_store *store) {
  const kz_entry *e = catalogue->entries;
  const int64_t n = catalogue->count;
#define POINTS(name, field)                        \
  KZ_COLUMN(store, group, name, n *phases, double, \
            i % phases < e[i / phases].row.period ? e[i / phases].field[i % phases] : NAN)
#define MULTIPLIERS(name, field) \
  KZ_COLUMN(store, group, name, 2 * n, double, e[i / 2].row.period > 0 ? e[i / 2].row.field[i % 2] : NAN)
  POINTS("strobe_theta", theta);
  POINTS("strobe_velocity", velocity);
  MULTIPLIERS("multiplier_re", multiplier_re);
  MULTIPLIERS("multiplier_im", multiplier_im);
  return KZ_OK;
}

kz_status kz_catalogue_write_motions(const kz_catalogue *catalogue, const char *group, const char *dimension,
                                     kz_store *store) {
  const kz_entry *e = catalogue->entries;
  const int64_t phases = kz_catalogue_longest(catalogue);
  KZ_TRY(kz_store_dimension(store, group, dimension, catalogue->count, NULL));
  KZ_TRY(kz_store_dimension(store, group, "phase", phases, NULL));
  KZ_TRY(kz_store_dimension(store, group, "pair", 2, NULL));
  COLUMN(int32_t, "period", e[i].row.period);
  COLUMN(int32_t, "winding", e[i].row.winding);
  COLUMN(int8_t, "centre", e[i].row.centre);
  COLUMN(const char *, "name", e[i].name);
  COLUMN(int8_t, "symmetric", e[i].row.symmetric);
  return write_matrices(catalogue, phases, group, store);
}

static kz_status write_columns(const kz_catalogue *catalogue, bool with_fraction, kz_store *store) {
  const char *group = "attractors";
  const kz_entry *e = catalogue->entries;
  COLUMN(int32_t, "mirror", e[i].mirror == (int32_t)i && !e[i].row.symmetric ? -1 : e[i].mirror);
  COLUMN(double, "amplitude", e[i].row.amplitude);
  COLUMN(double, "mean_velocity", e[i].row.mean_velocity);
  COLUMN(double, "lyapunov", e[i].row.lyapunov);
  COLUMN(double, "lyapunov_error", e[i].row.lyapunov_error);
  if (with_fraction) COLUMN(double, "fraction", e[i].fraction);
  return KZ_OK;
}

double *kz_nan_filled(int64_t n) {
  double *values = kz_malloc((size_t)(n + 1) * sizeof *values);
  for (int64_t i = 0; i < n; i++) values[i] = NAN;
  return values;
}

/* Lines of one closed orbit, from its first listed strobe point; those beyond what the samples carry stay NaN. */
static kz_status lines_of(const kz_entry *entry, const kz_flow *flow, int64_t lines, double *amplitude, double *phase,
                          int32_t *dominant) {
  int64_t n = entry->row.period, samples = n * SAMPLES, most = samples / 2 < lines ? samples / 2 : lines;
  KZ_AUTOFREE double *theta = kz_malloc((size_t)(samples + 1) * sizeof *theta),
                     *velocity = kz_malloc((size_t)(samples + 1) * sizeof *velocity);
  const kz_record record = {.periods = n,
                            .samples_per_period = SAMPLES,
                            .rotation = (double)entry->row.winding / (double)n,
                            .centre = entry->row.centre == KZ_ABOUT_INVERTED ? M_PI : 0.0,
                            .closed = true};
  kz_sample(flow, n, SAMPLES, entry->theta[0], entry->velocity[0], theta, velocity);
  KZ_TRY(kz_spectrum_lines(&record, theta, most, amplitude, phase));
  *dominant = (int32_t)kz_spectrum_dominant(most, amplitude);
  return KZ_OK;
}

/* The lines of every closed orbit. */
static kz_status write_spectra(const kz_catalogue *catalogue, const kz_pendulum *pendulum, int64_t lines,
                               kz_store *store) {
  const int64_t n = catalogue->count;
  KZ_AUTOFREE double *amplitude = kz_nan_filled(n * lines), *phase = kz_nan_filled(n * lines);
  KZ_AUTOFREE int32_t *dominant = kz_calloc((size_t)n + 1, sizeof *dominant);
  kz_numerics fine;
  kz_numerics_fine(pendulum, &fine);
  KZ_AUTOFREE_BY(kz_flow_freed) kz_flow *flow = kz_flow_create(pendulum, &fine);
  for (int64_t i = 0; i < n; i++)
    if (catalogue->entries[i].row.period > 0)
      KZ_TRY(lines_of(catalogue->entries + i, flow, lines, amplitude + i * lines, phase + i * lines, dominant + i));
  KZ_TRY(kz_store_variable(store, "attractors", "line_amplitude", amplitude));
  KZ_TRY(kz_store_variable(store, "attractors", "line_phase", phase));
  return kz_store_variable(store, "attractors", "dominant_line", dominant);
}

kz_status kz_catalogue_write(const kz_catalogue *catalogue, const kz_pendulum *pendulum, bool with_fraction,
                             kz_store *store) {
  const int64_t lines = LINES_PER_PERIOD * kz_catalogue_longest(catalogue) + 1;
  KZ_TRY(kz_catalogue_write_motions(catalogue, "attractors", "attractor", store));
  KZ_TRY(kz_store_dimension(store, "attractors", "line", lines, NULL));
  KZ_TRY(write_columns(catalogue, with_fraction, store));
  return write_spectra(catalogue, pendulum, lines, store);
}

enum { COLUMNS = 6, CELL_BYTES = 24 };
typedef char table_row[COLUMNS][CELL_BYTES];

/* Fills the row of an attractor, beside its id and name. */
static void fill_row(const kz_entry *e, table_row row) {
  snprintf(row[0], CELL_BYTES, "%d", e->row.period);
  snprintf(row[1], CELL_BYTES, kz_is_running(&e->row) ? "-" : "%d", e->row.winding);
  snprintf(row[2], CELL_BYTES, isnan(e->row.amplitude) ? "-" : "%.2f deg", e->row.amplitude * 180 / M_PI);
  snprintf(row[3], CELL_BYTES, e->row.period == 0 ? "-" : "%.6f",
           hypot(e->row.multiplier_re[0], e->row.multiplier_im[0]));
  snprintf(row[4], CELL_BYTES, "%.5f", e->row.lyapunov);
  snprintf(row[5], CELL_BYTES, "%.3f %%", 100 * e->fraction);
}

/* The exponents of attractors that never close, and the mean velocities of running states. */
static void print_open(const kz_catalogue *catalogue, const kz_parameters *parameters, FILE *summary) {
  for (int64_t i = 0; i < catalogue->count; i++) {
    const kz_attractor *row = &catalogue->entries[i].row;
    if (row->period > 0 || isnan(row->lyapunov_error)) continue;
    if (kz_is_running(row)) fprintf(summary, "      mean velocity of %" PRId64 ": %.10g\n", i, row->mean_velocity);
    fprintf(summary, "      exponent of %" PRId64 ": ", i);
    kz_rate_print(parameters, row->lyapunov, row->lyapunov_error, summary);
    fputc('\n', summary);
  }
}

void kz_catalogue_print(const kz_catalogue *catalogue, const kz_parameters *parameters, bool with_fraction,
                        FILE *summary) {
  static const char *const titles[COLUMNS] = {"period", "winding", "amplitude", "multiplier", "exponent", "share"};
  static const int widths[COLUMNS] = {6, 7, 9, 10, 8, 8};
  const int64_t n = catalogue->count;
  const int columns = with_fraction ? COLUMNS : COLUMNS - 1;
  bool differs[COLUMNS] = {false};
  if (n == 0) return;
  KZ_AUTOFREE table_row *rows = kz_malloc((size_t)n * sizeof *rows);
  for (int64_t i = 0; i < n; i++) {
    fill_row(catalogue->entries + i, rows[i]);
    for (int c = 0; c < columns; c++) differs[c] = differs[c] || n == 1 || strcmp(rows[i][c], rows[0][c]) != 0;
  }
  fprintf(summary, "  id  %-21s", "name");
  for (int c = 0; c < columns; c++)
    if (differs[c]) fprintf(summary, "  %*s", widths[c], titles[c]);
  fputc('\n', summary);
  for (int64_t i = 0; i < n; i++) {
    fprintf(summary, "%4lld  %-21s", (long long)i, catalogue->entries[i].name);
    for (int c = 0; c < columns; c++)
      if (differs[c]) fprintf(summary, "  %*s", widths[c], rows[i][c]);
    fputc('\n', summary);
  }
  for (int c = 0; c < columns; c++)
    if (!differs[c]) fprintf(summary, "      %s of each: %s\n", titles[c], rows[0][c]);
  print_open(catalogue, parameters, summary);
}
