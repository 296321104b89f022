/* Bounds of a motion in complex time, by which the rest of a Taylor polynomial and the sizes of its coefficients are bounded. */
#ifndef KAPITZA_KERNEL_INTERVAL_MAJORANT_H
#define KAPITZA_KERNEL_INTERVAL_MAJORANT_H

#include "kapitza/kernel.h"

enum { KZ_MAJORANTS = 2400 };

/* Bounds on |z| <= r around any time, of motions that are there as fast as the class allows: |Im theta| <= y, |theta'| <= w;
 * slope: of the velocities of columns that begin with (1, 0), (0, 1). */
typedef struct {
  long double r, y, w, a[2], slope[2];
} kz_majorant;

/* Majorants at radii that grow; how many, at most KZ_MAJORANTS. */
int kz_majorants_find(const kz_pendulum *pendulum, double fastest, kz_majorant *list);

#endif
