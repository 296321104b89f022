/* Cells of a window of starts: where they lie, which of them are labelled, how starts are followed. */
#ifndef KAPITZA_STUDY_CELLS_H
#define KAPITZA_STUDY_CELLS_H

#include "kapitza/dynamics.h"
#include "kapitza/study.h"

/* Centre of cell i, as the nearest double where the window is given by its centre and width; exactly mirrored in a symmetric window. */
double kz_axis_centre(const kz_axis *axis, int64_t i);
/* Where cell i lies in its window, as a share of the width from the centre: a double where the window is given by its centre and width,
 * else as near as a quad is. */
__float128 kz_axis_share(const kz_axis *axis, int64_t i);
/* The same as a coordinate of any precision; its texts are the axis's. */
kz_coordinate kz_axis_coordinate(const kz_axis *axis, int64_t i);
/* Whether the window is given by its centre and width: its cells are centre + share width, in all digits. */
bool kz_axis_is_centred(const kz_axis *axis);
bool kz_plan_is_centred(const kz_basin_plan *plan); /* along any axis */
__float128 kz_axis_width(const kz_axis *axis);
/* The point so large a share of the axis from its lower edge, and `offset` more, as a pair of doubles. */
void kz_axis_at(const kz_axis *axis, double share, double offset, double pair[2]);
/* Centre of cell i as a pair of doubles; returns what it may be off by: 0 where it is a double. */
double kz_axis_place(const kz_axis *axis, int64_t i, double pair[2]);
/* A random real point of the axis, from two numbers of 53 random bits, as a pair of doubles; returns what it may be off by, all further
 * digits included. */
double kz_axis_random(const kz_axis *axis, const uint64_t bits[2], double pair[2]);
/* Width of a cell. */
double kz_axis_step(const kz_axis *axis);
/* The largest speed on an axis of velocities. */
double kz_axis_fastest(const kz_axis *velocity);

/* The smaller side of a cell: rad, or rad per drive radian. An axis that is narrower than the last place of 1 as a whole is a
 * point to all motions and does not count; INFINITY where both are. */
double kz_cell_size(const kz_basin_plan *plan);

/* Where attractors are looked for: the window; of one that is a point to doubles a neighbourhood. */
kz_window kz_window_of(const kz_axis *theta, const kz_axis *velocity);
/* The same with all velocities at which motions from such a point go on, which tell nothing of it: how fast numerics must be right. */
kz_window kz_motions_window(const kz_axis *theta, const kz_axis *velocity);

/* Cells of a tile of labels, at most `most`: few where each may take long, so that a stop loses seconds of work. */
int64_t kz_tile_cells(const kz_scene *scene, int64_t most);

/* Cells that are labelled; the others of a window that is its own mirror image mirror them: cell f mirrors cell total - 1 - f. */
int64_t kz_unique_cells(const kz_basin_plan *plan);

/* The state of a start in rad and rad per drive radian: half-turns in [-1, 1] and velocity. */
void kz_start_state(double theta, double velocity, double state[2]);
/* Centre of cell f, velocity-major, in rad and rad per drive radian; its state. */
void kz_cell_start(const kz_basin_plan *plan, int64_t f, double start[2]);
void kz_cell_state(const kz_basin_plan *plan, int64_t f, double state[2]);

/* Nodes an axis that an interpolation (KZ_LINEAR, ...) takes. */
int32_t kz_stencil(int32_t interpolation);

/* The words of the file for KZ_METHOD_ICM, ..., KZ_LINEAR, ... */
extern const char *const kz_method_names[], *const kz_interpolation_names[];

/* The way of kz_dynamics_follow that a method (KZ_METHOD_ICM, ...) takes. */
int32_t kz_stepping(int32_t method, int32_t interpolation);

#endif
