/* The choice of steps and terms of the processed splitting, from the speeds and the tolerance of a scene. Not collective. */
#ifndef KAPITZA_STUDY_PROCESSED_H
#define KAPITZA_STUDY_PROCESSED_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* True if `scheme`, a row of the kernel's table, is the processed splitting. */
bool kz_is_processed(int32_t scheme);

/* The largest speed, rad per drive radian, within one drive period from the starts of a window, with a margin. For a map table with `rows`
 * nodes of the velocity it includes the nodes, because images of faster nodes would have other coordinates than their neighbours. rows =
 * 0: no table. */
double kz_fastest_motion(const kz_pendulum *pendulum, const kz_window *window, int64_t rows);

/* Sets scene->numerics. False if the processed splitting is not accurate enough for the scene's motions, or if nothing is labelled. */
bool kz_processed_choose(kz_scene *scene);

/* The cheapest processed splitting whose error of a drive period is at most `tolerance` (rad), up to speeds of `fastest` (rad per drive
 * radian); split6 with its default steps if there is none. Method exact takes a tenth of the tolerance if rounding allows it. */
kz_numerics kz_processed_or_split(const kz_pendulum *pendulum, int32_t method, double tolerance, double fastest);

#endif
