/* The command where: its starts, and how ends are told to programs. */
#pragma once

#include "../app.h"
#include "kapitza/study_where.h"

/* What its own options say. */
typedef struct {
  int64_t boundary; /* digits of --boundary; 0 = not given */
} kz_where_options;

/* The starts, from the operands or from lines "theta,velocity" of standard input. start [n] = theta and velocity, as
 * doubles, or both in all digits if one of them has more. KZ_REFUSED names the operand or the line. The caller frees
 * *starts in every case. */
typedef struct {
  int64_t n;
  kz_coordinate (*start)[2];
  double pivot_frequency; /* rad/s, for velocities in rad/s; NaN if the scene is not in SI units */
} kz_starts;
kz_status kz_starts_read(const kz_options *options, double pivot_frequency, kz_starts *starts);
void kz_starts_free(kz_starts *starts);

struct json_object;
/* Adds "theta", "velocity", and where the start ends to an object (json.h); also in SI units unless `omega`, the
 * frequency of the pivot in rad/s, is NaN. */
void kz_ending_add(struct json_object *object, const kz_coordinate start[2], const kz_ending *ending, double omega);
