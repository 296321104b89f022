/* Resolves the numerics of a scene for each of its studies (kz_numerics_resolve, kz_orbit_steps and kz_orbit_numerics
 * of study.h); steps and terms of the processed splitting, from the speeds and the tolerance. Not collective. */
#pragma once

#include "kapitza/dynamics.h"
#include "step_check.h"

/* Motions of a basin's cells. Allowed errors are shares of a cell, except in exact, which carries errors. */
kz_step_motions kz_motions_of_basin(const kz_scene *scene);

/* Samples a period of `orbit`: for turning points and spectra, a multiple of the scene's samples_per_period. */
int64_t kz_orbit_samples(const kz_scene *scene);

/* True if `scheme`, a row of the kernel's table, is the processed splitting. */
bool kz_is_processed(int32_t scheme);

/* The largest speed, rad per drive radian, within one drive period from the starts of a window, with a margin. For a
 * map table with `rows` nodes of the velocity it includes the nodes, because images of faster nodes would have other
 * coordinates than their neighbours. rows = 0: no table. */
double kz_fastest_motion(const kz_pendulum *pendulum, const kz_window *window, int64_t rows);

/* The cheapest processed splitting whose error of a drive period is at most `tolerance` (rad), up to speeds of
 * `fastest` (rad per drive radian); split6 with its default steps if there is none. Method exact takes a tenth of the
 * tolerance if rounding allows it. series: as in kz_numerics. */
kz_numerics kz_processed_or_split(const kz_pendulum *pendulum, kz_kept_series *series, int32_t method, double tolerance,
                                  double fastest);
