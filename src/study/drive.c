/* The drive of a pendulum from the keys that describe it: wave form, further harmonics, tilt, ellipse, torque, phase of release. */
#include <math.h>
#include <string.h>

#include "kapitza/study.h"

/* Highest harmonic of the Fourier series that stands for a wave form with corners. */
enum { CORNERED = 7 };

/* Amplitude of cos j t of a wave form of height 1 that is at its top at t = 0. */
static double fourier(int32_t waveform, int j) {
  if (waveform <= KZ_SINE || j % 2 == 0 || j > CORNERED) return j == 1 ? 1 : 0;
  const double share = 4 / (M_PI * j);
  return waveform == KZ_SQUARE ? (j % 4 == 1 ? share : -share) : 2 * share / (M_PI * j);
}

/* The pivot's motion along its line, in units of m: cosine and sine of harmonic j. */
static void along(const kz_pendulum_keys *written, double m, int j, double *cosine, double *sine) {
  *cosine = m * fourier(written->waveform, j);
  *sine = 0;
  for (int64_t i = 0; i < written->harmonics.count; i++) {
    const kz_harmonic *h = written->harmonics.values + i;
    if (h->order != j) continue;
    *cosine += h->amplitude * cos(h->phase);
    *sine -= h->amplitude * sin(h->phase);
  }
}

/* Harmonic j of the pivot's motion in the plane: along the tilted line, and across it, a quarter of a drive period later. */
static void add_harmonic(const kz_pendulum_keys *written, int j, kz_pendulum *p) {
  const double tilt = isnan(written->tilt) ? 0 : written->tilt, ellipse = isnan(written->ellipse) ? 0 : written->ellipse;
  const double quarter = j * M_PI / 2, up = cos(tilt), aside = sin(tilt);
  double c, s;
  along(written, p->m, j, &c, &s);
  const double across_c = ellipse * (c * cos(quarter) - s * sin(quarter)),
               across_s = ellipse * (c * sin(quarter) + s * cos(quarter));
  p->vertical[j - 1][0] = up * c - aside * across_c - (j == 1 ? p->m : 0);
  p->vertical[j - 1][1] = up * s - aside * across_s;
  p->horizontal[j - 1][0] = aside * c + up * across_c;
  p->horizontal[j - 1][1] = aside * s + up * across_s;
}

static int highest_of(const kz_pendulum_keys *written) {
  int highest = written->waveform > KZ_SINE ? CORNERED : 1;
  for (int64_t i = 0; i < written->harmonics.count; i++)
    if (written->harmonics.values[i].order > highest) highest = (int)written->harmonics.values[i].order;
  return highest;
}

static bool has(double value) {
  return !isnan(value) && value != 0;
}

void kz_drive_resolve(const kz_parameters *parameters, kz_pendulum *p) {
  const kz_pendulum_keys *written = &parameters->written;
  const bool plane = has(written->tilt) || has(written->ellipse);
  if (plane || written->waveform > KZ_SINE || written->harmonics.count > 0) {
    p->harmonics = highest_of(written);
    for (int j = 1; j <= p->harmonics; j++) add_harmonic(written, j, p);
  }
  if (has(written->torque)) p->torque = written->torque;
  p->unmirrored = plane || has(written->torque);
}

/* A ramp of the drive is in units of m, which it ends at. */
static void resolve_ramp(const kz_parameters *parameters, kz_release *release) {
  const kz_pendulum_keys *written = &parameters->written;
  release->periods = written->ramp_periods;
  release->smooth = written->ramp_shape == KZ_RAMP_SMOOTH;
  if (written->ramp_key == KZ_RAMP_DAMPING)
    release->damping = written->ramp_from;
  else
    release->drive = written->ramp_from / parameters->pendulum.m;
}

void kz_release_resolve(const kz_parameters *parameters, kz_release *release) {
  const double phase = fmod(parameters->written.start_phase, 2 * M_PI);
  *release = (kz_release){.damping = parameters->pendulum.beta, .drive = 1};
  if (has(parameters->written.start_phase)) release->phase = phase < 0 ? phase + 2 * M_PI : phase;
  if (parameters->has_ramp && has(parameters->written.ramp_periods)) resolve_ramp(parameters, release);
}
