/* study: the motions of the points of an atlas that a result file has (C; layer 3). No MPI. */
#pragma once

#include "kapitza/study.h"

typedef struct kz_atlas kz_atlas;

/* The longest period of cycles that an atlas can have, in drive periods. */
enum { KZ_ATLAS_MOST_PERIOD = 16 };

/* A kind of motion: its name, period, turns and centre. */
typedef struct {
  char name[KZ_NAME_LENGTH];
  int32_t period, winding, centre, symmetric;
  int32_t images; /* 2: their mirror images are there too */
} kz_motion_kind;

/* A motion that attracts at a point of the plane. */
typedef struct {
  kz_motion_kind of;
  int64_t curve;   /* curve that its state was carried from; -1 = none */
  int32_t strobes; /* period, or 0: its state is not known */
  double theta[KZ_ATLAS_MOST_PERIOD], velocity[KZ_ATLAS_MOST_PERIOD]; /* [strobes] */
  double multiplier_re[2], multiplier_im[2];                          /* over the period */
} kz_motion;
typedef struct {
  double x, y; /* the point: values of the two keys */
  kz_pendulum pendulum;
  bool known; /* false: the curves contradict each other there, so that one is missing */
  int64_t count;
  kz_motion *motion; /* [count] */
} kz_motions;

/* Reads the atlas of a file, whose `scene` must outlive it; KZ_REFUSED without one. kz_atlas_close frees it, also
 * NULL. */
kz_status kz_atlas_open(const kz_scene *scene, kz_store *store, kz_atlas **atlas);
void kz_atlas_close(kz_atlas *atlas);

/* The motions of up to max_period periods that attract at a point, by counting crossings of curves; `states`: with
 * their strobe points and multipliers, each cycle carried from the curve where it begins. Some milliseconds; without
 * states less than one. KZ_REFUSED outside of the plane. The caller frees *motions. */
kz_status kz_atlas_motions(kz_atlas *atlas, double x, double y, bool states, kz_motions *motions);
void kz_motions_free(kz_motions *motions);

/* Branches of cycles along a line through the plane, attracting or not. */
enum { KZ_LINE_VALUE, KZ_LINE_HEIGHT, KZ_LINE_THETA, KZ_LINE_VELOCITY, KZ_LINE_MULTIPLIER, KZ_LINE_COLUMNS };
typedef struct {
  kz_motion_kind of;
  int64_t first, points; /* in the list of points */
} kz_atlas_branch;
typedef struct {
  int64_t count, n_points, capacity;
  kz_atlas_branch *branch; /* [count] */
  /* [n_points]: value of the key; mean height of the bob at the strobe points, -1 to 1; a strobe point; largest modulus
   * of a multiplier over the period. */
  double (*point)[KZ_LINE_COLUMNS];
} kz_atlas_branches;
/* All branches of cycles of up to max_period periods along the line where the other key than that of `axis` (0: x, 1:
 * y) is `value`, from its crossings with the curves. KZ_REFUSED outside of the plane. The caller frees *line. */
kz_status kz_atlas_line(kz_atlas *atlas, int axis, double value, kz_atlas_branches *line);
void kz_atlas_branches_free(kz_atlas_branches *line);
