/* Cycles as ends of paths, and guesses between them: the attractor's motion blended into the saddle's. */
#include "guide.h"

/* Points a period of the discretised action, and steps of the flow for each, of a pendulum with small forces. */
enum { SAMPLES = 24, STEPS_OF_A_SAMPLE = 3, COARSE_STEPS = 1 };

kz_escape_flow kz_escape_flow_of(const kz_pendulum *pendulum) {
  const kz_pendulum with_derivatives[3] = {*pendulum, {.k = 1}, {.m = 1}};
  kz_numerics fine;
  kz_numerics_fine(pendulum, &fine);
  const int32_t more = 1 + (fine.steps_per_period - 1) / (SAMPLES * STEPS_OF_A_SAMPLE), samples = SAMPLES * more;
  return (kz_escape_flow){pendulum, kz_hamilton_create(with_derivatives, STEPS_OF_A_SAMPLE * samples),
                          kz_hamilton_create(with_derivatives, COARSE_STEPS * samples), samples};
}

void kz_escape_flow_free(kz_escape_flow *flow) {
  kz_hamilton_free(flow->flow);
  kz_hamilton_free(flow->coarse);
}

bool kz_escape_cycle_find(const kz_escape_flow *flow, int64_t period, bool attracts, const double *theta,
                          const double *velocity, kz_escape_cycle *cycle) {
  *cycle = (kz_escape_cycle){.period = period};
  cycle->end = kz_calloc((size_t)period, sizeof *cycle->end);
  cycle->turns = kz_calloc((size_t)period, sizeof *cycle->turns);
  cycle->theta = kz_calloc((size_t)(period * flow->samples), sizeof *cycle->theta);
  KZ_AUTOFREE double (*sample)[4] = kz_malloc((size_t)flow->samples * sizeof *sample);
  for (int64_t j = 0; j < period; j++) {
    if (!kz_path_end_find(flow->flow, period, attracts, theta[j], velocity[j], cycle->end + j)) return false;
    kz_hamilton_sample(flow->flow, flow->samples, 1, cycle->end[j].state, sample[0]);
    double *out = cycle->theta + j * flow->samples;
    out[0] = cycle->end[j].state[0];
    for (int32_t i = 1; i < flow->samples; i++) out[i] = sample[i - 1][0];
    const double ends = sample[flow->samples - 1][0], next = j + 1 < period ? theta[j + 1] : theta[0];
    const int64_t turns = cycle->turns[j] + llrint((ends - next) / (2 * M_PI));
    if (j + 1 < period)
      cycle->turns[j + 1] = turns;
    else
      cycle->winding = turns;
  }
  return true;
}

void kz_escape_cycle_free(kz_escape_cycle *cycle) {
  free(cycle->end);
  free(cycle->turns);
  free(cycle->theta);
}

/* Angle on the line at a sample of period `t`, counted from strobe 0 of the cycle. */
static double angle_of(const kz_escape_cycle *cycle, int32_t samples, int64_t t, int64_t sample) {
  const int64_t phase = ((t % cycle->period) + cycle->period) % cycle->period, whole = (t - phase) / cycle->period;
  return cycle->theta[phase * samples + sample] + 2 * M_PI * (double)(cycle->turns[phase] + cycle->winding * whole);
}

void kz_escape_guess(const kz_escape_flow *flow, const kz_escape_cycle *from, const kz_escape_cycle *to,
                     const kz_guess *guess, double *theta, double turns[2]) {
  const int32_t samples = flow->samples;
  const int64_t n = guess->periods, t = (int64_t)guess->change;
  const int64_t at = (int64_t)((guess->change - (double)t) * samples);
  const double apart = angle_of(to, samples, t - n, at) - angle_of(from, samples, guess->phase + t, at);
  turns[0] = -(double)from->turns[guess->phase];
  turns[1] = guess->turn - rint((apart + 2 * M_PI * (0 - turns[0])) / (2 * M_PI));
  for (int64_t i = 0; i <= n * samples; i++) {
    const double a = angle_of(from, samples, guess->phase + i / samples, i % samples) + 2 * M_PI * turns[0];
    const double b = angle_of(to, samples, i / samples - n, i % samples) + 2 * M_PI * turns[1];
    const double s = fmin(1, fmax(0, ((double)i / samples - guess->change) / guess->width + 0.5));
    theta[i] = a + (b - a) * s * s * s * (10 - 15 * s + 6 * s * s);
  }
  turns[0] = 0;
}
