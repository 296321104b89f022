#include "kapitza/study.h"

/* k = 1/Omega^2, beta = 1/(Omega Q), m = epsilon (BSG Eq. 2); no Q, no damping. */
static kz_pendulum from_quality(const kz_pendulum_keys *written) {
  const double omega = written->drive_frequency;
  const double q = written->quality_factor;
  return (kz_pendulum){
      .k = 1.0 / (omega * omega), .beta = isnan(q) ? 0.0 : 1.0 / (omega * q), .m = written->drive_amplitude};
}

/* Parameters of a Josephson junction, in units of its plasma frequency. */
static kz_pendulum from_junction(const kz_pendulum_keys *written) {
  const double omega = written->omega;
  return (kz_pendulum){.k = 1.0 / (omega * omega), .beta = 1.0 / (omega * sqrt(written->beta_c)), .m = 0};
}

/* Returns omega in rad/s, however it is written. */
static double pivot_frequency(const kz_pendulum_keys *written) {
  return isnan(written->frequency) ? written->pivot_frequency : 2 * M_PI * written->frequency;
}

static double inertia_of(const kz_pendulum_keys *written) {
  return isnan(written->length) ? written->inertia : written->mass * written->length * written->length;
}

/* Returns beta from whatever says how swings decay: b/(I omega), 2/(tau omega), or omega0/(Q omega); `lever` = M r/I,
 * 1/m. */
static double damping_of(const kz_pendulum_keys *written, double lever, double omega) {
  if (!isnan(written->decay_time)) return 2 / (written->decay_time * omega);
  if (!isnan(written->quality_factor)) return sqrt(lever * fabs(written->gravity)) / (written->quality_factor * omega);
  return written->friction / (inertia_of(written) * omega);
}

/* A torque in units of I omega^2, however it is written: so, in units of M g r, or in N m. */
static double torque_of(const kz_pendulum_keys *written, double k, double own, double ratio, double current,
                        double moment) {
  const double omega = pivot_frequency(written);
  if (!isnan(own)) return own;
  if (!isnan(ratio)) return k * ratio;
  if (!isnan(current)) return k * current;
  return isnan(moment) ? 0 : moment / (inertia_of(written) * omega * omega);
}

static void set_torques(const kz_pendulum_keys *written, kz_pendulum *p) {
  p->torque = torque_of(written, p->k, written->torque, written->constant_torque_ratio, written->i_dc,
                        written->constant_torque);
  p->torque_amplitude = torque_of(written, p->k, written->torque_amplitude, written->torque_ratio, written->i_ac,
                                  written->oscillating_torque);
}

/* k = M g r/(I omega^2), m = M r A/I (BSG Eq. 1 in drive time); M r/I = 1/l of a point mass. */
static kz_pendulum from_si(const kz_pendulum_keys *written) {
  const double lever =
      isnan(written->length) ? written->mass * written->radius / written->inertia : 1 / written->length;
  const double omega = pivot_frequency(written);
  return (kz_pendulum){.k = lever * written->gravity / (omega * omega),
                       .beta = damping_of(written, lever, omega),
                       .m = lever * (isnan(written->amplitude) ? written->pivot_amplitude : written->amplitude)};
}

double kz_point_inertia(const kz_pendulum_keys *written) {
  return written->mass * written->radius * written->radius;
}

bool kz_inertia_is_possible(const kz_pendulum_keys *written) {
  return written->inertia >= kz_point_inertia(written) * (1 - 1e-9);
}

static kz_pendulum from_written(const kz_pendulum_keys *written) {
  if (!isnan(written->drive_frequency)) return from_quality(written);
  if (!isnan(written->omega)) return from_junction(written);
  if (!isnan(pivot_frequency(written))) return from_si(written);
  return (kz_pendulum){.k = written->k, .beta = written->damping, .m = written->m};
}

/* Q = sqrt|k|/beta, Omega = 1/sqrt k, where they are defined and not given. */
static void fill_defined(kz_parameters *parameters) {
  const kz_pendulum *p = &parameters->pendulum;
  const kz_pendulum_keys *written = &parameters->written;
  const bool given = !isnan(written->drive_frequency), junction = !isnan(written->omega);
  parameters->drive_amplitude = p->m;
  parameters->pivot_frequency = pivot_frequency(written);
  parameters->drive_frequency = given ? written->drive_frequency : junction ? written->omega : NAN;
  parameters->quality_factor = junction ? sqrt(written->beta_c) : written->quality_factor;
  if (!given && !junction && p->k > 0.0) parameters->drive_frequency = 1.0 / sqrt(p->k);
  if (!given && isnan(written->quality_factor) && p->k != 0.0 && p->beta > 0.0)
    parameters->quality_factor = sqrt(fabs(p->k)) / p->beta;
}

double kz_si_factor(double omega, const char **unit) {
  const struct {
    const char *of, *si;
    double factor;
  } units[] = {{"drive periods", "s", 2 * M_PI / omega}, {"rad per drive radian", "rad/s", omega}};
  for (int i = 0; i < 2 && !isnan(omega); i++) {
    if (strcmp(*unit, units[i].of) != 0) continue;
    *unit = units[i].si;
    return units[i].factor;
  }
  return 1;
}

void kz_periods_print(int64_t periods, double omega, FILE *out) {
  const char *unit = "drive periods";
  const double factor = kz_si_factor(omega, &unit);
  fprintf(out, "%lld drive periods", (long long)periods);
  if (!isnan(omega)) fprintf(out, " (%.4g %s)", (double)periods * factor, unit);
}

void kz_rate_print(const kz_parameters *parameters, double rate, double error, FILE *out) {
  const kz_pendulum_keys *written = &parameters->written;
  const bool si = !isnan(parameters->pivot_frequency);
  const bool natural = !isnan(written->drive_frequency) || !isnan(written->omega);
  const double omega = si ? parameters->pivot_frequency : natural ? parameters->drive_frequency : 1;
  const double factor = omega / (2 * M_PI);
  fprintf(out, "%.4g +- %.2g per drive period, %.4g +- %.2g per %s", rate, error, rate * factor, error * factor,
          si        ? "s"
          : natural ? "1/omega0"
                    : "drive radian");
}

kz_status kz_parameters_resolve(kz_parameters *parameters) {
  kz_pendulum p = from_written(&parameters->written);
  set_torques(&parameters->written, &p);
  if (!isfinite(p.k) || !isfinite(p.beta) || !isfinite(p.m) || !isfinite(p.torque) || !isfinite(p.torque_amplitude))
    return kz_fail(
        KZ_REFUSED,
        "gives k = %g, beta = %g, m = %g, torque = %g, torque_amplitude = %g, not all finite; use less extreme "
        "parameters",
        p.k, p.beta, p.m, p.torque, p.torque_amplitude);
  const char *wrong = kz_drive_contradiction(&parameters->written);
  if (wrong) return kz_fail(KZ_REFUSED, "%s", wrong);
  parameters->pendulum = p;
  fill_defined(parameters);
  kz_drive_resolve(parameters, &p);
  parameters->pendulum = p;
  return KZ_OK;
}

double kz_pendulums_parted(const kz_pendulum *a, const kz_pendulum *b) {
  double size = fabs(a->k) + fabs(a->m) + a->beta;
  double difference = fabs(a->k - b->k) + fabs(a->m - b->m) + fabs(a->beta - b->beta) + fabs(a->torque - b->torque) +
                      fabs(a->torque_amplitude - b->torque_amplitude);
  if (kz_is_mirrored(a) != kz_is_mirrored(b)) return INFINITY;
  for (int j = 0; j < KZ_HARMONICS; j++)
    for (int i = 0; i < 2; i++)
      difference += fabs(a->vertical[j][i] - b->vertical[j][i]) + fabs(a->horizontal[j][i] - b->horizontal[j][i]);
  return difference / size;
}
