/* (B0) of docs/explanation/bounds.md: bounds of a motion and of its neighbours at complex times. */
#pragma once

#include "kapitza/kernel.h"

typedef long double real;

/* Bounds for |z| <= r around any time of a motion that is as fast as its class allows there: |Im theta| <= y, |theta'| <= w. slope [2]:
 * bounds of the velocities of the tangent map's columns that begin with (1, 0) and (0, 1). */
typedef struct {
  real r, y, w, a[2], slope[2];
} majorant;

enum { MAJORANTS = 2400 };

/* Writes the majorants of a motion that is at most `fastest` (rad per drive radian) at a real time to list [MAJORANTS], by ascending r;
 * returns their number. */
int kz_majorants_find(const kz_pendulum *pendulum, double fastest, majorant *list);
