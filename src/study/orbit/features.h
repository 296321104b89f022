/* Features of an orbit: centre, period, winding, lines, turning points, strobe points. */
#ifndef KAPITZA_STUDY_FEATURES_H
#define KAPITZA_STUDY_FEATURES_H

#include "motion.h"

typedef struct {
  bool closed;
  int64_t period;  /* n; of an open record what its lines tell, 0 = nothing */
  int64_t winding; /* net turns in n periods; of an open record without n in the whole record */
  int centre;      /* KZ_ABOUT_DOWN ... */
  double origin;   /* rad: the angle that deflections are counted from, a multiple of pi; 0 where there is no centre */
  bool symmetric;  /* its own mirror image; false for an open record */
  bool
      chaotic; /* an open record without period whose neighbours part; its lines are those of the velocity (its angle may drift) */
  char name[KZ_NAME_LENGTH];
  int64_t n_lines;        /* lines j = 0 .. n_lines - 1 */
  int64_t record_periods; /* line j lies at j / record_periods drive frequencies */
  int64_t dominant;
  double *amplitude, *phase;
  int64_t n_turning;
  kz_turning_point *turning;
} kz_orbit_features;

/* The features of a record; `period` = n of a closed orbit (the record's first n periods are one cycle), 0 = open; `parting` =
 * its neighbours part for good. KZ_FAILED where memory ran out, or where the lines of a closed orbit contradict n. */
kz_status kz_orbit_features_make(const kz_motion *motion, int64_t period, bool parting, kz_orbit_features *features);
void kz_orbit_features_free(kz_orbit_features *features);

#endif
