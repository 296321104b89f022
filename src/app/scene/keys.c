/* The table of a scene's keys: pendulum and numerics here, those of each study in its folder. */
#include <pthread.h>

#include "kapitza/study_key_rows.h"
#include "scene.h"

static char schemes[128];

static void join_schemes(void) {
  for (int32_t row = 0; row < kz_scheme_count(); row++) kz_words_add(schemes, sizeof schemes, kz_scheme_at(row).name);
}

/* The names of the kernel's table of schemes. */
static const char *scheme_words(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, join_schemes);
  return schemes;
}

#define MOST_HARMONICS KZ_STRINGIFY(KZ_HARMONICS)
#define PENDULUM(form_, name, unit_, low_, fallback, help, ...)                                             \
  KZ_ROW("pendulum." #name, KZ_KEY_REAL, fallback, KZ_ROW_AT(parameters.written.name), help, .unit = unit_, \
         .low = low_, .high = DBL_MAX, .form = form_, __VA_ARGS__)

/* Words for keys of the pendulum in books and papers. */
#define OTHER_WORDS                                                                                               \
  "g=torque_ratio, gamma of the equation, or "                                                                    \
  "gravity|q=quality_factor|omega_D=drive_frequency|omega_d=drive_frequency|"                                     \
  "F_D=torque_ratio|F=torque_ratio|drive_strength=torque_ratio|driving_torque=torque_ratio|forcing=torque_ratio|" \
  "i=i_dc|I=i_dc|current=i_dc|bias=i_dc|bias_current=i_dc|betac=beta_c|beta_C=beta_c|stewart_mccumber=beta_c"

static const kz_key own[] = {
    KZ_ROW_TEXT("title", "", title, "One line that names the scene in files and pictures."),

    KZ_ROW_MAPPING(
        "pendulum", NULL,
        "The pendulum, given in one of four ways (a, b, c, d). A scene with the study `stability` alone needs none.",
        .words = OTHER_WORDS),
    PENDULUM("ac", quality_factor, "", KZ_ABOVE_ZERO, "",
             "Quality factor Q = omega0 I/b, so that beta = 1/(Omega Q). Left out in (a): no damping.", .symbol = "Q"),
    PENDULUM("a", drive_frequency, "", KZ_ABOVE_ZERO, NULL,
             "Drive frequency over natural frequency, Omega = omega/omega0, so that k = 1/Omega^2.", .symbol = "Omega"),
    PENDULUM("a", drive_amplitude, "", -DBL_MAX, NULL, "Drive amplitude epsilon = (A/r)(M r^2/I), so that m = epsilon.",
             .symbol = "epsilon"),
    PENDULUM("b", k, "", -DBL_MAX, NULL, "Gravity, 1/Omega^2; 0 = none, below 0 = upward."),
    PENDULUM("b", damping, "", 0.0, NULL, "Damping, beta of theta'' + beta theta' + (k - m cos t) sin theta = 0.",
             .symbol = "beta"),
    PENDULUM("b", m, "", -DBL_MAX, NULL, "Drive amplitude, of any sign."),
    PENDULUM("c", length, "m", KZ_ABOVE_ZERO, "",
             "Length of a pendulum that is a point mass (I = M l^2). Another body needs mass, radius and inertia."),
    PENDULUM("c", frequency, "Hz", KZ_ABOVE_ZERO, "",
             "Frequency of the pivot, omega/(2 pi). Give this or pivot_frequency."),
    PENDULUM("c", amplitude, "m", -DBL_MAX, "", "Amplitude A of the pivot; m = M r A/I = A/l."),
    PENDULUM("c", decay_time, "s", KZ_ABOVE_ZERO, "",
             "Time in which small swings shrink by a factor e, 2 I/b. Instead of quality_factor."),
    PENDULUM("c", gravity, "m s-2", -DBL_MAX, "",
             "Gravity g; k = M g r/(I omega^2) = g/(l omega^2). Left out: 9.80665."),
    PENDULUM("c", mass, "kg", KZ_ABOVE_ZERO, "", "Mass M."),
    PENDULUM("c", radius, "m", KZ_ABOVE_ZERO, "", "Distance r from the pivot to the centre of mass."),
    PENDULUM("c", inertia, "kg m2", KZ_ABOVE_ZERO, "", "Moment of inertia I about the pivot; at least M r^2."),
    PENDULUM("c", friction, "kg m2 s-1", 0.0, "", "Friction b; beta = b/(I omega). Instead of quality_factor."),
    PENDULUM("c", pivot_amplitude, "m", -DBL_MAX, "", "Another name of amplitude."),
    PENDULUM("c", pivot_frequency, "rad s-1", KZ_ABOVE_ZERO, "",
             "Angular frequency omega of the pivot. Instead of frequency."),
    PENDULUM("c", constant_torque, "N m", -DBL_MAX, "", "Constant torque. It needs mass beside length."),
    PENDULUM("c", oscillating_torque, "N m", -DBL_MAX, "",
             "Amplitude of a torque that oscillates with the drive, as cos omega t."),
    PENDULUM("d", beta_c, "", KZ_ABOVE_ZERO, NULL,
             "Of a Josephson junction: McCumber's and Stewart's parameter, so that Q = sqrt(beta_c)."),
    PENDULUM("d", omega, "", KZ_ABOVE_ZERO, NULL,
             "Of a junction: angular frequency of the microwaves over that of the plasma, so that k = 1/omega^2."),
    PENDULUM("d", i_dc, "", -DBL_MAX, "", "Of a junction: constant current over the critical one; torque = k i_dc."),
    PENDULUM("d", i_ac, "", -DBL_MAX, "",
             "Of a junction: amplitude of the microwave current over the critical current."),
    KZ_ROW_REAL("pendulum.tilt", "rad", -M_PI, M_PI, "", parameters.written.tilt,
                "Angle between the pivot's path and the vertical."),
    KZ_ROW_REAL(
        "pendulum.ellipse", "", -10, 10, "", parameters.written.ellipse,
        "Makes the pivot's path an ellipse: the ratio of its axis across the path to the one along it; above 0 = "
        "clockwise."),
    KZ_ROW_REAL("pendulum.torque", "", -1e6, 1e6, "", parameters.written.torque,
                "Constant torque on the pendulum, in units of I omega^2."),
    KZ_ROW_REAL("pendulum.torque_amplitude", "", -1e6, 1e6, "", parameters.written.torque_amplitude,
                "Amplitude of a torque that oscillates with the drive, torque_amplitude cos t, in the same units."),
    KZ_ROW_REAL("pendulum.constant_torque_ratio", "", -1e6, 1e6, "", parameters.written.constant_torque_ratio,
                "The constant torque in units of M g r: torque = k constant_torque_ratio."),
    KZ_ROW("pendulum.torque_ratio", KZ_KEY_REAL, "", KZ_ROW_AT(parameters.written.torque_ratio),
           "Amplitude of the oscillating torque in units of M g r, as gamma of textbooks: torque_amplitude = k "
           "torque_ratio.",
           .unit = "", .low = -1e6, .high = 1e6, .symbol = "gamma"),
    KZ_ROW_WORD(
        "pendulum.waveform", "sine|square|triangle|samples", "", parameters.written.waveform,
        "Form of the drive in time, which is that of the pivot's downward acceleration; square and triangle: their "
        "Fourier "
        "series "
        "up to order 7; samples: of the list samples up to order 16."),
    KZ_ROW(
        "pendulum.samples", KZ_KEY_REALS, "", KZ_ROW_AT(parameters.written.samples),
        "The drive at equal times of a period, the first at t = 0, in units of drive_amplitude; its mean is left out.",
        .unit = "", .low = -1e6, .high = 1e6),
    KZ_ROW("pendulum.harmonics", KZ_KEY_HARMONICS, "", KZ_ROW_AT(parameters.written.harmonics),
           "Further harmonics of the drive: m amplitude cos(order t + phase), the phase in rad or degrees.",
           .unit = ""),
    KZ_ROW("pendulum.vertical", KZ_KEY_REALS, "", KZ_ROW_AT(parameters.written.vertical),
           "Coefficients of the equation, beside k - m cos t: cosine and sine of the first harmonic, of the second, "
           ".., " MOST_HARMONICS
           " at most, as the group pendulum of a result holds them. Instead of waveform, harmonics, tilt and ellipse.",
           .unit = "", .low = -1e7, .high = 1e7),
    KZ_ROW("pendulum.horizontal", KZ_KEY_REALS, "", KZ_ROW_AT(parameters.written.horizontal),
           "The same of a pivot that moves aside: b(t) of the equation.", .unit = "", .low = -1e7, .high = 1e7),

    KZ_ROW("numerics", KZ_KEY_MAPPING, "", KZ_ROW_NOWHERE, "How one drive period is integrated.", .unit = "",
           .former = "precision=basin.method exact"),
    KZ_ROW("numerics.scheme", KZ_KEY_WORD, "processed", KZ_ROW_AT(asked.scheme),
           "Integrator. processed: one kick a step, the fastest; the program takes split6 if it does not reach the "
           "tolerance; "
           "split schemes are exact in the damping; rk4: classical Runge-Kutta.",
           .unit = "", .words_from = scheme_words, .former = "split4=split6|split6-11=split6", KZ_ROW_CHOSEN),
    KZ_ROW_COUNT(
        "numerics.steps_per_period", 1, 100000, "auto", asked.steps_per_period,
        "Steps in a drive period. auto: as many as tolerance and speeds need (processed); the default of the scheme, "
        "or more "
        "for small cells (others).",
        .words = "auto", KZ_ROW_CHOSEN),
    KZ_ROW(
        "numerics.tolerance", KZ_KEY_REAL, "1e-12", KZ_ROW_AT(asked.tolerance),
        "Error of one drive period that auto allows the scheme processed, measured against quad precision; small cells "
        "allow "
        "less, and method exact a tenth of it where rounding lets it.",
        .unit = "rad", .low = 1e-15, .high = 0.01, KZ_ROW_CHOSEN),
    {.path = NULL},
};

static int64_t length_of(const kz_key *keys) {
  int64_t n = 0;
  while (keys[n].path) n++;
  return n;
}

static const kz_key *table;

/* Whether a row is that of the mapping of `path`, or of a key in it. */
static bool is_beside(const kz_key *row, const char *path) {
  const char *dot = strrchr(path, '.');
  const size_t length = dot ? (size_t)(dot - path) : 0;
  return dot && strncmp(row->path, path, length) == 0 && (row->path[length] == '.' || row->path[length] == '\0');
}

/* Frees `before` if an earlier part has joined it. */
static const char *join_text(const char *before, bool joined_before, const char *between, const char *after) {
  const size_t bytes = strlen(before) + strlen(between) + strlen(after) + 1;
  char *joined = kz_malloc(bytes);
  snprintf(joined, bytes, "%s%s%s", before, between, after);
  if (joined_before) free((char *)before);
  return joined;
}

/* Whether the help of a row is that of a study, to which no part has added. */
static bool is_as_written(const kz_key *row) {
  for (int i = 0; i < kz_study_count; i++)
    for (const kz_key *key = kz_studies[i]->keys; key->path; key++)
      if (key->help == row->help) return true;
  return false;
}

/* Adds the words and the help of a part's row to the same key of its study. */
static void keys_extend(kz_key *row, const kz_key *part) {
  const bool joined = !is_as_written(row);
  row->words = join_text(kz_key_words(row), joined, "|", kz_key_words(part));
  row->help = join_text(row->help, joined, " ", part->help);
}

static kz_key *find_row(kz_key *joined, int64_t n, const char *path) {
  for (kz_key *row = joined; row < joined + n; row++)
    if (strcmp(row->path, path) == 0) return row;
  return NULL;
}

/* Puts `keys` into the first `n` of `joined`, behind those of their mapping, or last; returns the number. */
static int64_t keys_add(kz_key *joined, int64_t n, const kz_key *keys) {
  for (; keys->path; keys++, n++) {
    int64_t at = n;
    kz_key *same = find_row(joined, n, keys->path);
    if (same) {
      keys_extend(same, keys);
      n--;
      continue;
    }
    while (at > 0 && !is_beside(joined + at - 1, keys->path)) at--;
    if (at == 0) at = n;
    memmove(joined + at + 1, joined + at, (size_t)(n - at) * sizeof *keys);
    joined[at] = *keys;
  }
  return n;
}

static void join_keys(void) {
  int64_t n = length_of(own);
  for (int i = 0; i < kz_study_count; i++) n += length_of(kz_studies[i]->keys);
  kz_key *joined = kz_calloc((size_t)n + 1, sizeof *joined);
  n = keys_add(joined, 0, own);
  for (int i = 0; i < kz_study_count; i++) n = keys_add(joined, n, kz_studies[i]->keys);
  table = joined;
}

const kz_key *kz_scene_keys(void) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  pthread_once(&once, join_keys);
  return table;
}
