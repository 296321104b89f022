/* The drive of a pendulum from the keys that describe it: wave form, further harmonics, tilt, ellipse, torque. */
#include <float.h>

#include "kapitza/study.h"

/* Highest harmonics of the Fourier series that stand for a wave form with corners, and for samples. */
enum { CORNERED = 7, SAMPLED = 16 };

static bool drive_has(double value) {
  return !isnan(value) && value != 0;
}

const kz_drive_key kz_drive_keys[] = {
    {"pendulum.tilt", offsetof(kz_pendulum_keys, tilt)},
    {"pendulum.ellipse", offsetof(kz_pendulum_keys, ellipse)},
    {"pendulum.torque", offsetof(kz_pendulum_keys, torque)},
    {"pendulum.torque_amplitude", offsetof(kz_pendulum_keys, torque_amplitude)},
    {"pendulum.constant_torque_ratio", offsetof(kz_pendulum_keys, constant_torque_ratio)},
    {"pendulum.torque_ratio", offsetof(kz_pendulum_keys, torque_ratio)},
    {"pendulum.constant_torque", offsetof(kz_pendulum_keys, constant_torque)},
    {"pendulum.oscillating_torque", offsetof(kz_pendulum_keys, oscillating_torque)},
    {"pendulum.i_dc", offsetof(kz_pendulum_keys, i_dc)},
    {"pendulum.i_ac", offsetof(kz_pendulum_keys, i_ac)},
    {NULL, 0},
};

const char *kz_drive_unmirrored_by(const kz_pendulum_keys *written) {
  const kz_drive_key *key = kz_drive_keys;
  while (key->path && isnan(*(const double *)((const char *)written + key->offset))) key++;
  return key->path;
}

const char *kz_drive_made_by(const kz_pendulum_keys *written) {
  const char *path = kz_drive_unmirrored_by(written);
  if (path) return path;
  if (written->harmonics.count > 0) return "pendulum.harmonics";
  if (written->vertical.count > 0) return "pendulum.vertical";
  return written->horizontal.count > 0 ? "pendulum.horizontal" : "pendulum.waveform";
}

static bool has_coefficients(const kz_pendulum_keys *written) {
  return written->vertical.count > 0 || written->horizontal.count > 0;
}

/* Harmonics of samples below this part of the largest are rounding. */
static const double LEAST = 1e-9;

/* Harmonic j of samples, j up to half their number: cosine and sine. */
static void harmonic_of(const kz_reals *samples, int j, double form[2]) {
  const double share = (2 * j == samples->count ? 1.0 : 2.0) / (double)samples->count;
  form[0] = form[1] = 0;
  for (int64_t i = 0; i < samples->count; i++) {
    const double angle = 2 * M_PI * (double)(i * j % samples->count) / (double)samples->count;
    form[0] += share * samples->values[i] * cos(angle);
    form[1] += share * samples->values[i] * sin(angle);
  }
}

/* The highest harmonic of samples that counts. */
static int highest_of_samples(const kz_reals *samples) {
  const int most = (int)(samples->count / 2 < SAMPLED ? samples->count / 2 : SAMPLED);
  double size[SAMPLED + 1] = {0}, largest = 0, form[2];
  int highest = 1;
  for (int j = 1; j <= most; j++) {
    harmonic_of(samples, j, form);
    size[j] = hypot(form[0], form[1]);
    largest = fmax(largest, size[j]);
  }
  for (int j = 1; j <= most; j++)
    if (size[j] > LEAST * largest) highest = j;
  return highest;
}

/* Harmonic j of the wave form, which is at its top at t = 0 but for samples: cosine and sine. */
static void drive_fourier(const kz_pendulum_keys *written, int j, double form[2]) {
  const bool corners = written->waveform == KZ_SQUARE || written->waveform == KZ_TRIANGLE;
  const double share = 4 / (M_PI * j);
  form[0] = j == 1, form[1] = 0;
  if (corners && (j % 2 == 0 || j > CORNERED))
    form[0] = 0;
  else if (corners)
    form[0] = written->waveform == KZ_SQUARE ? (j % 4 == 1 ? share : -share) : 2 * share / (M_PI * j);
  if (written->waveform != KZ_SAMPLES) return;
  form[0] = 0;
  if (j <= highest_of_samples(&written->samples)) harmonic_of(&written->samples, j, form);
}

/* The largest difference between the harmonics and the samples less their mean. */
static double distance_from_samples(const kz_reals *samples) {
  double rest[KZ_LIST_MAX], mean = 0, largest = 0, form[2];
  const int highest = highest_of_samples(samples);
  for (int64_t i = 0; i < samples->count; i++) mean += samples->values[i] / (double)samples->count;
  for (int64_t i = 0; i < samples->count; i++) rest[i] = samples->values[i] - mean;
  for (int j = 1; j <= highest; j++) {
    harmonic_of(samples, j, form);
    for (int64_t i = 0; i < samples->count; i++) {
      const double angle = 2 * M_PI * (double)(i * j % samples->count) / (double)samples->count;
      rest[i] -= form[0] * cos(angle) + form[1] * sin(angle);
    }
  }
  for (int64_t i = 0; i < samples->count; i++) largest = fmax(largest, fabs(rest[i]));
  return largest;
}

const char *kz_drive_contradiction(const kz_pendulum_keys *written) {
  const bool shaped = written->waveform > KZ_SINE || written->harmonics.count > 0 || drive_has(written->tilt) ||
                      drive_has(written->ellipse);
  if (!has_coefficients(written) || !shaped) return NULL;
  return "vertical and horizontal are the whole drive beside k and m; leave out waveform and the other keys of its "
         "form";
}

void kz_drive_print(const kz_parameters *parameters, FILE *out) {
  const kz_pendulum_keys *written = &parameters->written;
  if (written->waveform != KZ_SAMPLES) return;
  fprintf(out,
          "Drive: harmonics up to order %d stand for %lld samples; they are off by %.2g of drive_amplitude at most.\n",
          highest_of_samples(&written->samples), (long long)written->samples.count,
          distance_from_samples(&written->samples));
}

void kz_symmetries_print(const kz_pendulum *p, FILE *out) {
  static const char *const IMAGES[] = {"-theta(t)", "-theta(t + pi)", "pi + theta(t + pi)"}; /* by KZ_SYMMETRY_ bit */
  const int32_t symmetries = kz_symmetries(p);
  const char *before = "Symmetry: with a motion theta(t) also ";
  if (isnan(p->k)) return;
  for (int i = 0; i < 3; i++) {
    if (!(symmetries >> i & 1)) continue;
    fprintf(out, "%s%s", before, IMAGES[i]);
    before = ", ";
  }
  fputs(symmetries ? ".\n" : "Symmetry: none.\n", out);
}

/* The pivot's motion along its line: cosine and sine of harmonic j. */
static void drive_along(const kz_pendulum_keys *written, double m, int j, double *cosine, double *sine) {
  double form[2];
  drive_fourier(written, j, form);
  *cosine = m * form[0];
  *sine = m * form[1];
  for (int64_t i = 0; i < written->harmonics.count; i++) {
    const kz_harmonic *h = written->harmonics.values + i;
    if (h->order != j) continue;
    *cosine += m * (h->amplitude * cos(h->phase));
    *sine -= m * (h->amplitude * sin(h->phase));
  }
}

/* Harmonic j of the pivot's motion: along the tilted line, and across it a quarter of a drive period later. */
static void add_harmonic(const kz_pendulum_keys *written, int j, kz_pendulum *p) {
  const double tilt = isnan(written->tilt) ? 0 : written->tilt,
               ellipse = isnan(written->ellipse) ? 0 : written->ellipse;
  const double quarter = j * M_PI / 2, aside = sin(tilt);
  const double up = fabs(cos(tilt)) > DBL_EPSILON ? cos(tilt) : 0; /* 90 deg is horizontal, though no double is pi/2 */
  double c, s;
  drive_along(written, p->m, j, &c, &s);
  const double across_c = ellipse * (c * cos(quarter) - s * sin(quarter)),
               across_s = ellipse * (c * sin(quarter) + s * cos(quarter));
  p->vertical[j - 1][0] = up * c - aside * across_c - (j == 1 ? p->m : 0);
  p->vertical[j - 1][1] = up * s - aside * across_s;
  p->horizontal[j - 1][0] = aside * c + up * across_c;
  p->horizontal[j - 1][1] = aside * s + up * across_s;
}

static int highest_of(const kz_pendulum_keys *written) {
  int highest = written->waveform > KZ_SINE ? CORNERED : 1;
  if (written->waveform == KZ_SAMPLES) highest = highest_of_samples(&written->samples);
  for (int64_t i = 0; i < written->harmonics.count; i++)
    if (written->harmonics.values[i].order > highest) highest = (int)written->harmonics.values[i].order;
  return highest;
}

/* Coefficients as written; harmonics: the highest so far. True if one is not 0. */
static bool drive_take(const kz_reals *list, double harmonic[KZ_HARMONICS][2], int32_t *harmonics) {
  bool any = false;
  for (int64_t i = 0; i < list->count && i < 2 * KZ_HARMONICS; i++) {
    harmonic[i / 2][i % 2] = list->values[i];
    any = any || list->values[i] != 0;
    if (i / 2 >= *harmonics) *harmonics = (int32_t)(i / 2) + 1;
  }
  return any;
}

void kz_drive_resolve(const kz_parameters *parameters, kz_pendulum *p) {
  const kz_pendulum_keys *written = &parameters->written;
  const bool plane = drive_has(written->tilt) || drive_has(written->ellipse);
  drive_take(&written->vertical, p->vertical, &p->harmonics);
  const bool aside = drive_take(&written->horizontal, p->horizontal, &p->harmonics);
  if (plane || written->waveform > KZ_SINE || written->harmonics.count > 0) {
    p->harmonics = highest_of(written);
    for (int j = 1; j <= p->harmonics; j++) add_harmonic(written, j, p);
  }
  p->unmirrored = plane || aside || drive_has(p->torque) || drive_has(p->torque_amplitude);
}

void kz_drive_form(const kz_parameters *parameters, kz_pendulum *form) {
  const double unit = parameters->pendulum.m;
  *form = (kz_pendulum){.m = 1};
  if (isnan(parameters->pendulum.k)) return;
  kz_drive_resolve(parameters, form);
  if (!has_coefficients(&parameters->written)) return;
  form->m = drive_has(unit); /* coefficients are not in units of m */
  for (int j = 0; j < KZ_HARMONICS && form->m > 0; j++)
    for (int part = 0; part < 2; part++) form->vertical[j][part] /= unit;
}

void kz_pivot_at(const kz_parameters *parameters, double phase, double place[2]) {
  const kz_pendulum *p = &parameters->pendulum;
  place[0] = 0;
  place[1] = p->m * cos(phase);
  for (int j = 1; j <= p->harmonics; j++) { /* a harmonic of the acceleration is j^2 times that of the path */
    const double c = cos(j * phase) / (j * j), s = sin(j * phase) / (j * j);
    place[0] += p->horizontal[j - 1][0] * c + p->horizontal[j - 1][1] * s;
    place[1] += p->vertical[j - 1][0] * c + p->vertical[j - 1][1] * s;
  }
}
