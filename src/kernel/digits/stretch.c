/* Stretches of an orbit in any number of digits: whole drive periods, and before them the parts of periods from a release on, to the end of its
 * ramp. src/model/release.f90 has them in quads. */
#include "step.h"

/* Up to the next strobe, or to the end of the ramp. */
static void set_end(kz_stretch *s, int64_t bits) {
  const double strobe = (double)s->strobe + 1, ramp = s->release.periods;
  s->changes = kz_number_is_less(&s->begin, ramp);
  kz_number_of_double(s->changes && ramp < strobe ? ramp : strobe, &s->span);
  kz_number_subtract(&s->span, &s->span, &s->begin, bits);
}

/* Drive periods from the strobe at or before the release. */
static void set_release(kz_stretch *s, int64_t bits) {
  KZ_NUMBER(turn);
  kz_number_two_pi(&turn, bits);
  kz_number_of_double(s->release.phase, &s->begin);
  kz_number_divide(&s->begin, &s->begin, &turn, bits);
  kz_number_floor(&turn, &s->begin);
  kz_number_subtract(&s->begin, &s->begin, &turn, bits);
}

void kz_stretch_begin(kz_stretch *s, int64_t strobe, int64_t bits) {
  s->strobe = strobe;
  s->is_whole = strobe >= kz_release_strobes(&s->release);
  s->changes = false;
  if (s->is_whole) return;
  if (strobe == 0)
    set_release(s, bits);
  else
    kz_number_of_double((double)strobe, &s->begin);
  set_end(s, bits);
}

bool kz_stretch_next(kz_stretch *s, int64_t bits) {
  if (!s->changes || s->release.periods >= (double)s->strobe + 1) return false;
  kz_number_of_double(s->release.periods, &s->begin);
  set_end(s, bits);
  return true;
}
