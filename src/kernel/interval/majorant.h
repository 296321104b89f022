/* Bounds of a motion in complex time. They bound the remainder of a Taylor polynomial and the sizes of its coefficients. */
#ifndef KAPITZA_KERNEL_INTERVAL_MAJORANT_H
#define KAPITZA_KERNEL_INTERVAL_MAJORANT_H

#include "kapitza/kernel.h"

enum { KZ_MAJORANTS = 2400 };

/* Bounds for |z| <= r around any time of a motion that is as fast as its class allows there: |Im theta| <= y, |theta'| <= w. slope [2]:
 * bounds of the velocities of the tangent map's columns that begin with (1, 0) and (0, 1). */
typedef struct {
  long double r, y, w, a[2], slope[2];
} kz_majorant;

/* Fills `list` with majorants at growing radii; returns their number, at most KZ_MAJORANTS. */
int kz_majorants_find(const kz_pendulum *pendulum, double fastest, kz_majorant *list);

#endif
