/* The pendulum, its drive, its symmetry, and bounds of its forces (Fortran, above common).
 *
 * theta'' + beta theta' + a(t) sin theta - b(t) cos theta = torque + torque_amplitude cos t
 * a = k - m cos t - sum_j (vertical[j-1][0] cos j t + vertical[j-1][1] sin j t)
 * b = sum_j (horizontal[j-1][0] cos j t + horizontal[j-1][1] sin j t)
 * theta in rad from the DOWN position, t in drive radians; a period is 2 pi. If vertical, horizontal and both torques
 * are 0, the pendulum is {k, beta, m} and the equation is BSG Eq. 2, or BUT Eq. 9 in drive time. */
#pragma once

#include "kapitza/common.h"

#define KZ_HARMONICS 24

typedef struct {
  double k;                           /* 1/Omega^2; 0 = no gravity, < 0 = gravity upward */
  double beta;                        /* Damping, >= 0 */
  double m;                           /* Drive, any sign */
  double torque;                      /* Constant torque, in units of I omega^2 */
  double torque_amplitude;            /* Amplitude of the oscillating torque, in these units */
  double vertical[KZ_HARMONICS][2];   /* Amplitudes of cosine and sine of harmonics 1, 2, .. */
  double horizontal[KZ_HARMONICS][2]; /* Amplitudes of the horizontal drive */
  int32_t harmonics;                  /* Highest harmonic in use; 0 = none */
  int32_t unmirrored;                 /* 1 if there is a torque or a horizontal drive, else 0 */
} kz_pendulum;

/* One harmonic of the drive: amplitude cos(order t + phase). */
typedef struct {
  int64_t order;
  double amplitude, phase; /* Units of m; rad */
} kz_harmonic;
typedef struct {
  int64_t count;
  kz_harmonic values[KZ_HARMONICS];
} kz_harmonics;

/* Wave forms of the drive. */
enum { KZ_SINE = 0, KZ_SQUARE = 1, KZ_TRIANGLE = 2, KZ_SAMPLES = 3 };

/* Upper bound of |a(t)| + |b(t)| + |torque| + |torque_amplitude| over all t. */
double kz_stiffness(const kz_pendulum *described_pendulum);

/* Symmetries, by which -theta(t), -theta(t + pi) or pi + theta(t + pi) is a motion if theta(t) is one. */
enum { KZ_SYMMETRY_MIRROR = 1, KZ_SYMMETRY_HALF_PERIOD = 2, KZ_SYMMETRY_HALF_TURN = 4 };
/* Returns the sum of the symmetries of a pendulum. */
int32_t kz_symmetries(const kz_pendulum *pendulum);
/* Symmetry by which attractors and cycles have images: KZ_SYMMETRY_MIRROR, else KZ_SYMMETRY_HALF_PERIOD, else 0. */
int32_t kz_pairing_symmetry(const kz_pendulum *pendulum);
/* 1 if mirror images (-theta, -velocity) of motions are motions, without torque and horizontal drive; else 0. */
int32_t kz_is_mirrored(const kz_pendulum *pendulum);
/* 1 if anything of the equation depends on time, else 0. */
int32_t kz_is_driven(const kz_pendulum *pendulum);

/* 1 if the drive is k - m cos t, without further harmonics and torque; else 0. */
int32_t kz_is_sine(const kz_pendulum *pendulum);

/* The slow motion under a fast drive (BSG Eq. 10), theta'' + beta theta' + pull sin theta = 0 with pull = k + m^2/2 cos
 * theta u/(u^2 + beta^2), u = 1 - k cos theta. kz_slow_fraction is u/(u^2 + beta^2); `cosine` is cos theta. */
double kz_slow_fraction(double k, double beta, double cosine);
double kz_slow_pull(double k, double beta, double m, double cosine);
