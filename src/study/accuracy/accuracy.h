/* Settings: ways to label the cells of a window, from fast to accurate; what each costs by count, and how wrong its
 * labels are. The choice of basin.accuracy among them; the study `tradeoff`. */
#pragma once

#include "reference.h"
#include "plan.h"

typedef struct {
  const char *label;
  int32_t method;        /* KZ_METHOD_ICM, ... */
  const char *scheme;    /* Name of the scheme in the kernel's table */
  int32_t steps;         /* per period; KZ_AUTO = as many as `tolerance` needs, for the processed splitting */
  double tolerance;      /* rad: error of one drive period */
  int32_t interpolation; /* KZ_LINEAR, ...; not used by KZ_METHOD_DIRECT */
  int64_t nodes;         /* Nodes of the map table along an axis; not used by KZ_METHOD_DIRECT */
  bool candidate;        /* true: basin.accuracy may choose it; no other setting is both as fast and as accurate */
} kz_setting;

/* The table. Labels that end in -1992 name the methods of the first published maps of these basins. */
extern const kz_setting kz_settings[];
extern const int kz_setting_count;
/* The row of method exact. */
extern const kz_setting *const kz_setting_exact;

/* The numerics of a setting, for the cells of a basin of this pendulum. */
kz_numerics kz_setting_numerics(const kz_setting *setting, const kz_pendulum *pendulum, kz_kept_series *series,
                                const kz_basin_plan *plan);
/* The scene with the setting in place of its method, icm and numerics. */
void kz_setting_apply(const kz_setting *setting, kz_scene *scene);

/* The cost of a setting for `cells` cells of `mean_periods` periods each, counted in kicks of one trajectory, so that
 * it does not depend on a clock. */
double kz_setting_cost(const kz_setting *setting, double cells, double mean_periods);

/* One setting on the sampled cells. */
typedef struct {
  int64_t wrong;       /* decided cells of the sample whose label differs from the reference */
  int64_t undecided;   /* cells that method exact does not decide */
  int64_t inside;      /* wrong cells without another label next to them */
  int64_t distance;    /* median distance of the wrong cells from another label, in cells; 0 if none is wrong */
  int64_t count_error; /* the largest surplus or lack of cells of one attractor */
  double set_up;       /* processor seconds for map table and trapping regions */
  double cell;         /* processor seconds a cell */
} kz_setting_measured;

/* Labels the sample on this rank, and further cells up to `timed` to measure the time. */
kz_status kz_setting_measure(const kz_setting *setting, const kz_reference_labels *reference, int64_t timed,
                             kz_setting_measured *measured);

/* The choice and its reason. */
typedef struct {
  const kz_setting *setting;
  int64_t samples, wrong, flipped, tried;
} kz_choice;

/* Chooses the cheapest setting (kz_setting_cost) whose share of wrong labels in the sample, at the upper end of its 95
 * % interval, is at most 1 - accuracy; method exact if there is none. Collective. */
kz_status kz_accuracy_choose(const kz_scene *scene, const kz_run *run, kz_store *store, FILE *summary,
                             kz_choice *choice);

/* The choice as attributes of /basin. Rank 0. */
kz_status kz_accuracy_write(const kz_choice *choice, double accuracy, kz_store *store);

/* A setting measured on a sample of reference labels. */
typedef struct {
  const kz_setting *setting;
  kz_numerics numerics; /* resolved */
  kz_setting_measured measured;
  double seconds; /* for the whole grid of the basin, without the search for attractors */
  double wrong;   /* share of the sample */
  bool pareto;    /* no other setting is at least as fast and as accurate, and better in one of them */
} kz_trade_row;
typedef struct {
  int64_t count;
  kz_trade_row *row; /* [count] */
  double best_wrong; /* the lowest share of a setting in double precision; NaN without one */
} kz_trade;

/* The name FILE.truth of the cache of reference labels beside the result; the caller frees it; NULL without a store. */
char *kz_reference_path(const kz_store *store);
