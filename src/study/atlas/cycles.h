/* Cycles of the atlas as seeds of curves, and classes of attractors. */
#pragma once

#include "types.h"

/* Writes a cycle that is of a shorter period, or of more symmetry, than its kind as what it is; false if it is of its
 * kind. near: how far points lie apart that are one, rad. */
bool kz_atlas_reduce(const kz_atlas *atlas, double near, kz_cycle *cycle);
/* Adds a seed of a curve (multiplier 1 or -1) or a cycle (0) in its canonical form; false if it is of no interest: a
 * longer period than wanted, outside of the plane. */
bool kz_atlas_add(const kz_atlas *atlas, const kz_cycle *cycle, kz_atlas_seeds *seeds);
void kz_atlas_put(kz_atlas_seeds *seeds, const kz_cycle *seed); /* as it is */
void kz_atlas_seeds_free(kz_atlas_seeds *seeds);
/* The class of its attractors, its description in files and catalogues, equality with a given class, its name. */
kz_atlas_class kz_atlas_class_of(const kz_cycle_kind *kind);
kz_atlas_class kz_atlas_class_with(bool symmetric, int32_t period, int32_t turns, int32_t centre);
bool kz_atlas_is_of(const kz_cycle_kind *kind, const kz_atlas_class *class);
int32_t kz_atlas_class_centre(const kz_atlas_class *class);
void kz_atlas_class_name(const kz_atlas *atlas, const kz_atlas_class *class, char *text);
kz_motion_kind kz_atlas_described(const kz_atlas *atlas, const kz_atlas_class *class);
/* How many motions a class has for each of its members: a mirror image too, unless the motion is its own. */
int32_t kz_atlas_images(const kz_atlas *atlas, const kz_atlas_class *class);
/* The number of a class, new if need be. */
int32_t kz_atlas_class_number(kz_atlas *atlas, const kz_atlas_class *class);

/* The distance of a state from another one, or with side -1 from its mirror image. */
static inline double kz_atlas_apart(const double *a, const double *b, double side) {
  return hypot(remainder(a[0] - side * b[0], 2 * M_PI), a[1] - side * b[1]);
}
/* The image of a state at a place: (-theta, -v), or that of the state half a period later. False where no image of a
 * motion is a motion. */
bool kz_atlas_image_state(const kz_atlas *atlas, const double place[2], const double state[2], double image[2]);
/* The points of a cycle in the order of time, also those that its kind leaves out as images of others: point
 * [2 KZ_CURVE_POINTS]; returns how many, 0 where an orbit cannot be followed. */
int kz_atlas_points(const kz_atlas *atlas, const kz_cycle *cycle, double (*point)[2]);
/* Whether a cycle of this one's period, of a list of n at its place, has its first point or that of its image within
 * `near` rad. */
bool kz_atlas_has(const kz_atlas *atlas, int64_t n, const kz_cycle *list, const kz_cycle *cycle, double near);
/* Whether each motion has an image: then a cycle is its own image or one of two. */
static inline bool kz_atlas_paired(const kz_atlas *atlas) {
  return atlas->plane.mirrored || atlas->plane.half_period;
}
