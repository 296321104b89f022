/* The axes of plans: cells, values, windows. */
#pragma once

#include "kapitza/kernel.h"
#include "kapitza/study_pendulum.h"

/* A number of any digits: its text (rad, or degrees if " deg" follows; "" = not given), nearest sum of two doubles. */
enum { KZ_DECIMAL_LENGTH = 1024 };
typedef struct {
  char text[KZ_DECIMAL_LENGTH];
  double high, low;
} kz_decimal;

/* A unit that a scene writes behind a value: name ("" = the key's, or none), and its size in units of the key. */
typedef struct {
  char name[32];
  double factor;
} kz_written_unit;

/* An axis: `count` cells between min and max (basin), or `count` values with both ends included (sweeps, planes). For a
 * window by its centre and width, which may be finer than doubles, min and max are the nearest doubles. */
typedef struct {
  double min, max;
  int64_t count;
  kz_decimal centre, width;
  kz_written_unit written; /* Unit of the values of a parameter as written behind min, else behind max */
} kz_axis;

/* True if doubles cannot distinguish neighbouring cells of the axis, so that only method exact can label them. */
bool kz_axis_is_deep(const kz_axis *axis);
/* The number of a decimal text, which may end in " deg"; 0 if the text is not a number. */
__float128 kz_decimal_quad(const char *text);

/* The edges of a window as the scene gives them; NaN = not given. */
typedef struct {
  double min, max;
} kz_edges;

/* An axis of a plane of two keys of the pendulum mapping. */
typedef struct {
  int32_t parameter; /* number of kz_sweep_parameter_at */
  kz_axis values;    /* both ends included */
} kz_plane_axis;
