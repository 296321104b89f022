/* How many places of the census see each curve, and what this says of curves that are missing. */
#include <inttypes.h>

#include "numerics/share.h"
#include "lines.h"
#include "growth.h"

static const char *const GROUP = "atlas";

#define COLUMN(type, name, n, expression) KZ_COLUMN(store, "atlas", name, n, type, expression)

/* Decades of the widest band of curves, the widest first: that of 1e-4 is the last of the summary. */
enum { DECADES = 6, SUMMARY_DECADES = 4 };
typedef struct {
  int64_t *places; /* [curves]: that see it */
  double *band;    /* [curves] */
  int64_t curves[DECADES], seen[DECADES], once[DECADES], twice[DECADES];
  double missing[DECADES], low[DECADES], high[DECADES];
} tally;

static void tally_free(tally *t) {
  free(t->places);
  free(t->band);
}

/* Estimates curves that no place sees, less `unknown` known ones, of n decades from the widest on. */
static void tally_estimate(const tally *t, int first, int n, double *missing, double *low, double *high) {
  kz_unseen all = {0, 0};
  double known = 0;
  for (int i = first; i < first + n; i++) {
    const kz_unseen unseen = kz_unseen_of(t->once[i], t->twice[i]);
    all.number += unseen.number, all.variance += unseen.variance;
    known += (double)(t->curves[i] - t->seen[i]);
  }
  kz_unseen_interval(all, low, high);
  *missing = fmax(0, all.number - known), *low = fmax(0, *low - known), *high = fmax(0, *high - known);
}

static double decade_band(int64_t i) {
  return pow(10, -(double)i - 1);
}

static void take_tally(const kz_atlas *atlas, tally *t) {
  *t = (tally){.places = kz_calloc((size_t)atlas->n_curves + 1, sizeof *t->places),
               .band = kz_calloc((size_t)atlas->n_curves + 1, sizeof *t->band)};
  kz_atlas_count_sightings(atlas, t->places);
  for (int64_t i = 0; i < atlas->n_curves; i++) {
    int64_t decade = 0;
    t->band[i] = kz_atlas_widest(atlas, atlas->curve + i);
    while (decade < DECADES - 1 && t->band[i] < decade_band(decade)) decade++;
    t->curves[decade]++;
    t->seen[decade] += t->places[i] > 0, t->once[decade] += t->places[i] == 1, t->twice[decade] += t->places[i] == 2;
  }
  for (int i = 0; i < DECADES; i++) tally_estimate(t, i, 1, t->missing + i, t->low + i, t->high + i);
}

/* The probability that the list of a random point lacks a motion, at most: the bands of missing curves are as long as a
 * side, and as wide as the widest of their decade. A place within a band sees its curve, so that one that n places do
 * not see counts for at most 1 / (e n). */
static double tally_lacking(const kz_atlas *atlas, const tally *t) {
  double p = 0;
  for (int i = 0; i < DECADES; i++) p += t->high[i] * 10 * decade_band(i);
  return fmin(1, fmax(p, exp(-1) / (double)atlas->places));
}

static kz_status write_tally(const kz_atlas *atlas, const tally *t, kz_store *store) {
  double missing, low, high;
  tally_estimate(t, 0, SUMMARY_DECADES, &missing, &low, &high);
  KZ_TRY(kz_store_integer(store, GROUP, "places", atlas->places));
  KZ_TRY(kz_store_integer(store, GROUP, "cycles", atlas->cycles));
  KZ_TRY(kz_store_integer(store, GROUP, "dropped", atlas->dropped));
  KZ_TRY(kz_store_real(store, GROUP, "missing_low", low));
  KZ_TRY(kz_store_real(store, GROUP, "missing_high", high));
  KZ_TRY(kz_store_real(store, GROUP, "lacking_high", tally_lacking(atlas, t)));
  COLUMN(double, "curve_band", atlas->n_curves, t->band[i]);
  COLUMN(int32_t, "curve_places", atlas->n_curves, t->places[i]);
  KZ_TRY(kz_store_dimension(store, GROUP, "decade", DECADES, NULL));
  COLUMN(double, "decade_band", DECADES, i + 1 < DECADES ? decade_band(i) : 0);
  COLUMN(int32_t, "decade_curves", DECADES, t->curves[i]);
  COLUMN(int32_t, "decade_seen", DECADES, t->seen[i]);
  COLUMN(int32_t, "decade_once", DECADES, t->once[i]);
  COLUMN(int32_t, "decade_twice", DECADES, t->twice[i]);
  COLUMN(double, "decade_missing", DECADES, t->missing[i]);
  COLUMN(double, "decade_missing_low", DECADES, t->low[i]);
  COLUMN(double, "decade_missing_high", DECADES, t->high[i]);
  return KZ_OK;
}

static void print_tally(const kz_atlas *atlas, const tally *t, FILE *summary) {
  double missing, low, high;
  int64_t curves = 0;
  tally_estimate(t, 0, SUMMARY_DECADES, &missing, &low, &high);
  for (int i = 0; i < SUMMARY_DECADES; i++) curves += t->curves[i];
  fprintf(summary,
          "  census: %" PRId64 " cycles of %" PRId64
          " random places were followed to their births; an estimated %.0f to %.0f of "
          "%.0f curves with bands above %.0e of the plane are missing; a list lacks a motion with a probability of at "
          "most %.1g\n",
          atlas->cycles, atlas->places, floor(low), ceil(high), (double)curves + ceil(high),
          decade_band(SUMMARY_DECADES - 1), tally_lacking(atlas, t));
  if (atlas->dropped > 0)
    fprintf(summary,
            "  warning: %" PRId64
            " cycles or points of curves found no room in records and were not followed; more curves may be "
            "missing than estimated\n",
            atlas->dropped);
}

kz_status kz_atlas_write_tally(const kz_atlas *atlas, kz_store *store, FILE *summary) {
  KZ_AUTOFREE_BY(tally_free) tally t;
  take_tally(atlas, &t);
  print_tally(atlas, &t, summary);
  return write_tally(atlas, &t, store);
}
