/* Sampled runs: the time of a run from a part of its work. */
#include "kapitza/parallel.h"

/* A stage takes this part of the time that is left, or one tile. */
static const double PART = 0.2;

void kz_sampling_begin(kz_sampling *s, double patience) {
  const double now = kz_processor_clock();
  *s = (kz_sampling){.weight = 1, .stands_for = 1, .since = now, .until = now + patience, .last = now + patience};
}

double kz_sampling_seconds(const kz_sampling *s) {
  return s->counted + (kz_processor_clock() - s->since) * s->weight;
}

double kz_sampling_weight(const kz_run *run) {
  return run && run->sample ? run->sample->weight : 1;
}

double kz_sampling_stands_for(const kz_run *run) {
  return run && run->sample ? run->sample->stands_for : 1;
}

void kz_sampling_weigh(const kz_run *run, double factor) {
  if (!run || !run->sample) return;
  kz_sampling *s = run->sample;
  const double now = kz_processor_clock();
  s->counted += (now - s->since) * s->weight;
  s->since = now;
  s->weight *= factor;
}

kz_sampling_mark kz_sampling_mark_now(const kz_run *run) {
  if (!run || !run->sample) return (kz_sampling_mark){0};
  const kz_sampling *s = run->sample;
  const double now = kz_processor_clock(), left = s->until - now;
  return (kz_sampling_mark){kz_sampling_seconds(s), now + (left > 0 ? PART * left : 0)};
}

bool kz_sampling_enough(const kz_run *run, const kz_sampling_mark *mark, double done) {
  if (!run || !run->sample || done <= 0 || done >= 1 || kz_processor_clock() < mark->until) return false;
  run->sample->counted += (kz_sampling_seconds(run->sample) - mark->seconds) * (1 / done - 1);
  return true;
}
