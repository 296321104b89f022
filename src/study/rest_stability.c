/* Whether the pendulum stays at rest, down and inverted, and which amplitudes of the pivot would change it. */
#include "kapitza/study.h"

/* Drives that are looked at; how often a change is looked for between two of them, and at how many drives. */
enum { POINTS = 4000, ROUNDS = 7, PARTS = 64 };

/* |k| + |m| up to which the answer takes less than a second. */
static const double STIFFEST = 1e5;

/* The interval of drives m about `at` in which the position keeps its answer, or the next one in which it is stable. */
typedef struct {
  bool stable;      /* at the scene's drive */
  double low, high; /* drives where it begins and ends to be stable; NaN = none was found */
} rest;

/* How drives are written by the user: m * scale, in `unit`, called `name`. */
typedef struct {
  const char *name, *unit;
  double scale;
} drive_words;

/* Whether the position is stable at n drives, `step` apart. */
static void look_at(const kz_pendulum *form, double k, double beta, double first, double step, int n, uint8_t *stable) {
  KZ_AUTOFREE double *ks = kz_malloc((size_t)(5 * n) * sizeof *ks);
  double *betas = ks + n, *ms = betas + n, *growth = ms + n, *angle = growth + n;
  for (int i = 0; i < n; i++) {
    ks[i] = k;
    betas[i] = beta;
    ms[i] = first + step * i;
  }
  kz_linear_floquet(form, n, ks, betas, ms, growth, angle, stable);
}

/* Without gravity a position is neutral at a drive of 0 and stable at every small one, which rounding hides. */
static bool is_weightless(double k) {
  return !(fabs(k) > 0);
}

/* The drive between two of different answers at which the answer changes. */
static double change_between(const kz_pendulum *form, double k, double beta, double below, double above) {
  double part = above - below;
  for (int round = 0; round < ROUNDS; round++) {
    uint8_t stable[PARTS];
    int same = 0;
    part /= PARTS - 1;
    look_at(form, k, beta, below, part, PARTS, stable);
    while (same < PARTS - 2 && stable[same + 1] == stable[0]) same++;
    below += part * same;
  }
  return below + part / 2;
}

/* The nearest change from place `at` on in steps of `by`, and the place behind it; NaN where none is met. */
static double next_change(const kz_pendulum *form, const uint8_t *stable, double step, double k, double beta, int *at,
                          int by) {
  for (int i = *at; i >= 0 && i + by >= 0 && i + by < POINTS; i += by) {
    if (stable[i] == stable[i + by]) continue;
    *at = i + by;
    if (i + *at == 1 && is_weightless(k)) return 0;
    return change_between(form, k, beta, step * (by > 0 ? i : i + by), step * (by > 0 ? i + by : i));
  }
  *at = -1;
  return NAN;
}

/* The position at which gravity counts as k and the drive `form` as m; `most`: the largest drive that is looked at. */
static rest rest_look(const kz_pendulum *form, double k, double beta, double m, double most) {
  KZ_AUTOFREE uint8_t *stable = kz_malloc(POINTS);
  const double step = most / (POINTS - 1);
  look_at(form, k, beta, 0, step, POINTS, stable);
  int here = (int)lrint(fabs(m) / step), up, down;
  if (here == 0 && is_weightless(k) && fabs(m) > 0)
    here = 1;
  else
    look_at(form, k, beta, fabs(m), 0, 1, stable + here);
  if (is_weightless(k)) stable[0] = false;
  rest found = {.stable = stable[here], .low = NAN, .high = NAN};
  up = down = here;
  if (found.stable) {
    found.low = next_change(form, stable, step, k, beta, &down, -1);
    found.high = next_change(form, stable, step, k, beta, &up, 1);
  } else {
    found.low = next_change(form, stable, step, k, beta, &up, 1);
    if (up >= 0) {
      found.high = next_change(form, stable, step, k, beta, &up, 1);
    } else { /* none above: the last one below */
      found.high = next_change(form, stable, step, k, beta, &down, -1);
      found.low = next_change(form, stable, step, k, beta, &down, -1);
    }
  }
  return found;
}

/* Standing and falling are distinguished up to this drive, or a few times the one that stands by the slow equation. */
static double most_of(double k, double m) {
  return 4 * fmax(fmax(fabs(m), sqrt(2 * fabs(k))), 0.25);
}

void kz_standing_drives(const kz_pendulum *p, double *low, double *high) {
  const rest inverted = rest_look(NULL, -p->k, p->beta, 0, most_of(p->k, 0));
  *low = inverted.low;
  *high = inverted.high;
}

static drive_words words_of(const kz_parameters *p) {
  const kz_pendulum_keys *w = &p->written;
  if (!isnan(w->drive_amplitude)) return (drive_words){"drive_amplitude", "", 1};
  if (isnan(p->pivot_frequency)) return (drive_words){"m", "", 1};
  const double length = isnan(w->length) ? w->inertia / (w->mass * w->radius) : w->length;
  return (drive_words){isnan(w->amplitude) ? "pivot_amplitude" : "amplitude", " mm", 1e3 * length};
}

/* A limit to four digits, on its stable side: at what is printed the position is stable. */
static double rest_rounded(double value, double (*to_the_side)(double)) {
  enum { DIGITS = 4 };
  if (!(value > 0)) return value;
  const double unit = pow(10, floor(log10(value)) + 1 - DIGITS);
  return to_the_side(value / unit) * unit;
}

/* One position; `sign`: that of the drives, whose limits are counted from 0. */
static void print_position(const char *name, const rest *r, const drive_words *words, double sign, FILE *out) {
  const double low = rest_rounded(r->low * words->scale, ceil), high = rest_rounded(r->high * words->scale, floor);
  fprintf(out, "Rest %s: %s", name, r->stable ? "stable" : "unstable");
  if (isnan(low) && isnan(high)) {
    fputs(".", out);
    return;
  }
  const char *away = sign < 0 ? "down" : "up";
  fprintf(out, r->stable ? " (for %s" : " (stable for %s", words->name);
  if (low <= 0)
    fputs(sign < 0 ? " below 0," : " above 0,", out);
  else if (!isnan(low))
    fprintf(out, " from %.4g%s", sign * low, words->unit);
  if (!isnan(high) && !(low > 0)) fprintf(out, " %s", away);
  if (!isnan(high)) fprintf(out, " to %.4g%s", sign * high, words->unit);
  if (!isnan(low) && isnan(high)) fprintf(out, " %s", away);
  fputs(").", out);
}

/* The drive with the other sign, or as it is. */
static kz_pendulum rest_times(const kz_pendulum *form, double sign) {
  kz_pendulum turned = *form;
  turned.m *= sign;
  for (int j = 0; j < form->harmonics; j++)
    for (int part = 0; part < 2; part++) turned.vertical[j][part] *= sign;
  return turned;
}

void kz_rest_print(const kz_parameters *parameters, FILE *out) {
  const kz_pendulum *p = &parameters->pendulum;
  if (isnan(p->k)) return;
  if (kz_stiffness(p) > STIFFEST) {
    fprintf(out, "Rest: stability is not computed, because |k| + |m| is above %g.\n", STIFFEST);
    return;
  }
  if (!kz_is_mirrored(p)) {
    fputs("Rest: none, because the drive across the vertical or the torque moves the pendulum.\n", out);
    return;
  }
  kz_pendulum form;
  kz_drive_form(parameters, &form);
  const double m = form.m > 0 ? p->m : 1, sign = m < 0 ? -1 : 1;
  const kz_pendulum about_down = rest_times(&form, sign), about_inverted = rest_times(&form, -sign);
  const double most = most_of(p->k, m);
  const drive_words words = words_of(parameters);
  rest down = rest_look(&about_down, p->k, p->beta, m, most),
       inverted = rest_look(&about_inverted, -p->k, p->beta, m, most);
  if (!(form.m > 0)) down.low = down.high = inverted.low = inverted.high = NAN; /* no key scales this drive */
  print_position("down", &down, &words, sign, out);
  fputc(' ', out);
  print_position("inverted", &inverted, &words, sign, out);
  fputc('\n', out);
}
