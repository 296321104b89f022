/* The catalogue of attractors as users see it: their order, their names, their group in the file. */
#pragma once

#include "kapitza/study_catalogue.h"

/* Lists attractors with reached [number] != 0 and their mirror images; NULL: all. The caller frees it. */
void kz_catalogue_make(const kz_dynamics *dynamics, const int64_t *reached, kz_catalogue *catalogue);
void kz_catalogue_free(kz_catalogue *catalogue);

/* The longest period of an attractor, at least 1. */
int64_t kz_catalogue_longest(const kz_catalogue *catalogue);

/* Writes group /attractors, with the lines of every closed orbit; `fraction` only `with_fraction`. */
kz_status kz_catalogue_write(const kz_catalogue *catalogue, const kz_pendulum *pendulum, bool with_fraction,
                             kz_store *store);

/* Writes the common part of the groups attractors and saddles: dimensions, kind, name, strobe points, multipliers. */
kz_status kz_catalogue_write_motions(const kz_catalogue *catalogue, const char *group, const char *dimension,
                                     kz_store *store);
/* Rows of the tables of variables that both groups share. */
#define KZ_MOTION_VARIABLES(dimension)                                                                                 \
  {"phase", KZ_INT32, {"phase"}, NONE, "place of the strobe point along the orbit"},                                   \
      {"pair", KZ_INT32, {"pair"}, NONE, "place of the Floquet multiplier, larger modulus first"},                     \
      {"winding",                                                                                                      \
       KZ_INT32,                                                                                                       \
       {dimension},                                                                                                    \
       NONE,                                                                                                           \
       "net turns in one period, + counterclockwise; of a running state 1 or -1"},                                     \
      {"centre", KZ_INT8, {dimension}, NONE, "what the orbit moves about", {CENTRES}},                                 \
      {"symmetric", KZ_INT8, {dimension}, NONE, "whether the orbit is its own mirror image", {"no", "yes"}},           \
      {"mirror", KZ_INT32, {dimension}, NONE, "id of the mirror image under (theta, velocity) -> -(theta, velocity)"}, \
      {"strobe_theta", KZ_REAL, {dimension, "phase"}, ANGLE, "angle of the strobe point from down"},                   \
      {"strobe_velocity", KZ_REAL, {dimension, "phase"}, VELOCITY, "angular velocity of the strobe point"},            \
      {"multiplier_re",                                                                                                \
       KZ_REAL,                                                                                                        \
       {dimension, "pair"},                                                                                            \
       NONE,                                                                                                           \
       "Floquet multiplier over one period of the orbit, real part"},                                                  \
      {"multiplier_im",                                                                                                \
       KZ_REAL,                                                                                                        \
       {dimension, "pair"},                                                                                            \
       NONE,                                                                                                           \
       "Floquet multiplier over one period of the orbit, imaginary part"}

/* n NaNs; the caller frees them. */
double *kz_nan_filled(int64_t n);

/* Prints the table of attractors, and the exponents of chaotic ones with their errors. */
void kz_catalogue_print(const kz_catalogue *catalogue, const kz_parameters *parameters, bool with_fraction,
                        FILE *summary);
