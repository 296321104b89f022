/* model: the pendulum, what drives it, its symmetry and bounds (Fortran; the layer above common).
 *
 * theta'' + beta theta' + a(t) sin theta - b(t) cos theta = torque
 * a = k - m cos t - sum_j (vertical[j-1][0] cos j t + vertical[j-1][1] sin j t)
 * b = sum_j (horizontal[j-1][0] cos j t + horizontal[j-1][1] sin j t)
 * theta in rad from the DOWN position, t in drive radians; a period is 2 pi. Without the further terms this is BSG Eq. 2 and BUT Eq.
 * 9 in drive time: {k, beta, m} alone. */
#ifndef KAPITZA_MODEL_H
#define KAPITZA_MODEL_H

#include <stdint.h>

#include "kapitza/common.h"

enum { KZ_HARMONICS = 16 };

typedef struct {
  double k;    /* 1/Omega^2; 0 = no gravity, < 0 = gravity upward */
  double beta; /* damping, >= 0 */
  double m;    /* drive, any sign */
  double torque;
  double vertical[KZ_HARMONICS][2]; /* amplitudes of cosine and sine of harmonics 1, 2, .. */
  double horizontal[KZ_HARMONICS][2];
  int32_t harmonics;  /* highest harmonic of these; 0 = none */
  int32_t unmirrored; /* 1 where there is a torque or a horizontal drive */
} kz_pendulum;

/* One harmonic of the drive: amplitude cos(order t + phase). */
typedef struct {
  int64_t order;
  double amplitude, phase; /* as m; rad */
} kz_harmonic;
typedef struct {
  int64_t count;
  kz_harmonic values[KZ_HARMONICS];
} kz_harmonics;

/* Wave forms of the drive. */
enum { KZ_SINE = 0, KZ_SQUARE = 1, KZ_TRIANGLE = 2, KZ_SAMPLES = 3 };

/* A bound of |a(t)| + |b(t)| + |torque|. */
double kz_stiffness(const kz_pendulum *pendulum);

/* 1 where (theta, velocity) -> (-theta, -velocity) takes motions to motions: no torque, no horizontal drive. */
int32_t kz_is_mirrored(const kz_pendulum *pendulum);

/* 1 where the drive is k - m cos t alone. */
int32_t kz_is_sine(const kz_pendulum *pendulum);

/* Bounds for enclosures, up to rounding in extended precision. sizes [n]: of the Taylor coefficients of h (a(t) sin - b(t) cos) over a
 * step h in units of it, whatever its beginning; the largest of these forces for times with |Im t| <= r; and during step i of length h
 * from t = 0 on. */
void kz_force_sizes(const kz_pendulum *pendulum, long double h, int32_t n, long double *sizes);
long double kz_force_majorant(const kz_pendulum *pendulum, long double r);
long double kz_force_largest(const kz_pendulum *pendulum, int32_t i, long double h);

/* The slow motion where the drive is fast (BSG Eq. 10): theta'' + beta theta' + pull sin theta = 0 with
 * pull = k + m^2/2 cos theta u/(u^2 + beta^2), u = 1 - k cos theta. The fraction, and the pull, at cos theta. */
double kz_slow_fraction(double k, double beta, double cosine);
double kz_slow_pull(double k, double beta, double m, double cosine);

/* How motions begin. They are released at t = phase; until t = 2 pi periods damping and drive come, linearly in time or smoothly, from other
 * values to those of the pendulum. */
typedef struct {
  double phase;   /* rad, from 0 to below 2 pi */
  double periods; /* of the ramp, drive periods; 0 = none */
  double damping; /* beta at t = 0 */
  double drive;   /* all that drives the pendulum at t = 0, in units of what does after the ramp */
  int32_t smooth; /* 1: as a cubic that begins and ends without a kink */
} kz_release;

/* Strobes (t = 2 pi, 4 pi, ..) up to the one after which the drive has its final form; 0 where it has from the beginning. */
int64_t kz_release_strobes(const kz_release *release);

#endif
