/* Settings: ways to label the cells of a window, from quick to right; what each costs by count, and how wrong its labels are. */
#ifndef KAPITZA_STUDY_SETTING_H
#define KAPITZA_STUDY_SETTING_H

#include "reference_labels.h"

typedef struct {
  const char *label;
  int32_t method;        /* KZ_METHOD_ICM, ... */
  const char *scheme;    /* of the kernel's table */
  int32_t steps;         /* per period */
  int32_t precision;     /* KZ_SINGLE, KZ_DOUBLE */
  int32_t interpolation; /* KZ_LINEAR, ...; of no meaning to KZ_METHOD_DIRECT */
  int64_t nodes;         /* of the map table, an axis; the trapping regions have its cells */
  bool candidate;        /* of basin.accuracy: none of the others is as quick and as right as one of these */
} kz_setting;

/* The ladder. Labels that end in -1992 are what the first maps of these basins were made with. */
extern const kz_setting kz_settings[];
extern const int kz_setting_count;

kz_numerics kz_setting_numerics(const kz_setting *setting);
/* The scene with the setting in place of its method, icm and numerics. */
void kz_setting_apply(const kz_setting *setting, kz_scene *scene);

/* What a setting costs by count, not by clock: kicks of one trajectory that it is worth, for `cells` cells that take
 * `mean_periods` each on a table of 1000 nodes. */
double kz_setting_cost(const kz_setting *setting, double cells, double mean_periods);

/* One setting on the sampled cells. */
typedef struct {
  int64_t wrong;    /* sampled cells whose label differs from the reference */
  int64_t inside;   /* of these, those without another label next to them */
  int64_t distance; /* median distance of the wrong ones from another label, cells; 0 where none is wrong */
  int64_t astray;   /* the largest surplus or lack of cells of one attractor */
  double set_up;    /* processor seconds for map table and trapping regions */
  double cell;      /* processor seconds a cell */
} kz_measured;

/* Labels the sample and, for a clock that needs more cells, those that follow it up to `timed`; on this rank alone. */
kz_status kz_setting_measure(const kz_setting *setting, const kz_reference_labels *reference, int64_t timed,
                             kz_measured *measured);

#endif
