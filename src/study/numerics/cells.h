/* Cells of a window of starts: their places, which of them are labelled, how starts are followed. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study_basin.h"

/* Centre of cell i, exactly mirrored in a symmetric window; the nearest double for a window by centre and width. */
double kz_axis_centre(const kz_axis *axis, int64_t i);
/* Place of cell i, share of the width from the centre: a double if given by centre and width, else a quad. */
__float128 kz_axis_share(const kz_axis *axis, int64_t i);
/* Returns the centre as a coordinate of any precision, which refers to the texts of the axis. */
kz_coordinate kz_axis_coordinate(const kz_axis *axis, int64_t i);
/* True if the window is given by its centre and width; its cells are then centre + share * width, in all digits. */
bool kz_axis_is_centred(const kz_axis *axis);
bool kz_plan_is_centred(const kz_basin_plan *plan); /* along any axis */
__float128 kz_axis_width(const kz_axis *axis);
/* The point at `share` of the axis from its lower edge, plus `offset`, as a pair of doubles. */
void kz_axis_at(const kz_axis *axis, double share, double offset, double pair[2]);
/* Centre of cell i as a pair of doubles. Returns a bound of the pair's error; 0 if the centre is a double. */
double kz_axis_place(const kz_axis *axis, int64_t i, double pair[2]);
/* A random real point of the axis, from two numbers of 53 random bits, as a pair of doubles. Returns a bound of its
 * error, which includes all further digits of the real number. */
double kz_axis_random(const kz_axis *axis, const uint64_t bits[2], double pair[2]);
/* True if an axis of angles is the whole circle. */
bool kz_axis_is_circle(const kz_axis *theta);
/* Width of a cell. */
double kz_axis_step(const kz_axis *axis);
/* The largest speed on an axis of velocities. */
double kz_axis_fastest(const kz_axis *velocity);

/* The smaller side of a cell: rad, or rad per drive radian. An axis whose whole width is below the last place of 1 is a
 * point for all motions and does not count; INFINITY if both axes are points. */
double kz_cell_size(const kz_basin_plan *plan);

/* Window in which attractors are searched: that of the axes, or a neighbourhood if doubles see a point. */
kz_window kz_window_of(const kz_axis *theta, const kz_axis *velocity);
/* Returns the range with all velocities that motions from it reach: speeds for which numerics must be accurate. */
kz_window kz_motions_window(const kz_axis *theta, const kz_axis *velocity);

/* Cells of a tile of labels, at most `most`; fewer if cells are slow, so that a stop loses only seconds. */
int64_t kz_tile_cells(const kz_scene *scene, int64_t most);

/* Whether cell total - 1 - f has the mirror image of the start of cell f. */
bool kz_window_mirrors_itself(const kz_basin_plan *plan);
/* Number of labelled cells. In a symmetric window cell total - 1 - f is the mirror image of cell f. */
int64_t kz_unique_cells(const kz_basin_plan *plan);

/* The state of a start in rad and rad per drive radian: half-turns in [-1, 1] and velocity. */
void kz_start_state(double theta, double velocity, double state[2]);
/* Centre of cell f, velocity-major, in rad and rad per drive radian. */
void kz_cell_start(const kz_basin_plan *plan, int64_t f, double start[2]);

/* Number of nodes an axis that an interpolation uses. */
int32_t kz_stencil(kz_interpolation interpolation);

/* The words of the file for KZ_METHOD_ICM, ..., KZ_LINEAR, ... */
extern const char *const kz_method_names[], *const kz_interpolation_names[];
