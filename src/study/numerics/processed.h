/* The processed splitting for a scene: steps and terms that the speeds of its windows and its tolerance need. Not collective. */
#ifndef KAPITZA_STUDY_PROCESSED_H
#define KAPITZA_STUDY_PROCESSED_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* Whether that row of the kernel's table is the processed splitting. */
bool kz_is_processed(int32_t scheme);

/* rad per drive radian: what one drive period makes of the starts of a window at most, with a margin; of a map table with `rows`
 * nodes of the velocity also what a period makes of the nodes: those that were faster than the splitting serves would have images in
 * other coordinates than their neighbours. rows = 0: no table. */
double kz_fastest_motion(const kz_pendulum *pendulum, const kz_window *window, int64_t rows);

/* Fills scene->numerics; false where the processed splitting does not carry the scene's motions, or where nothing is labelled. */
bool kz_processed_choose(kz_scene *scene);

/* The cheapest processed splitting of one pendulum for a method, to a tolerance (rad, of one drive period), or split6 with its own number
 * of steps where there is none. Method exact takes a tenth of the tolerance where rounding allows. */
kz_numerics kz_processed_or_split(const kz_pendulum *pendulum, int32_t method, double tolerance, double fastest);

#endif
