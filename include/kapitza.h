/* kapitza: basins of attraction of the shaken pendulum, in the process of the caller. Plain C, as cffi reads it.
 *
 *   theta'' + beta theta' + (k - m cos t) sin theta = 0, and every other drive that a scene can describe
 *
 * theta is in rad from the down position, velocity in rad per drive radian, t in drive radians; a drive period is 2 pi,
 * and a strobe is the state at t = 0 mod 2 pi. Arrays are the caller's and have the length that stands beside them.
 *
 * Threads: calls on different pendulums run at the same time, calls on one pendulum one after the other. A process that
 * was forked may use a pendulum unless another thread was using it at that moment (KAPITZA_REFUSED). Nothing is kept
 * outside of a pendulum.
 *
 * Names may change until 1.0; CHANGELOG.md lists each change. */
#ifndef KAPITZA_H
#define KAPITZA_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Status of a call. After any but KAPITZA_OK the results are not set; the next call works as if this one was not
 * made. */
typedef enum {
  KAPITZA_OK = 0,
  KAPITZA_FAILED = 1,    /* failed while computing */
  KAPITZA_REFUSED = 2,   /* the scene or an argument is wrong */
  KAPITZA_NO_MEMORY = 3, /* memory ran out */
  KAPITZA_STOPPED = 75   /* the pause of this thread asked for it */
} kapitza_status;

/* Returns one line: what was wrong in the last call of this thread that did not return KAPITZA_OK. */
const char *kapitza_message(void);
/* "0.5.0". */
const char *kapitza_version(void);

/* Sets what calls of this thread ask about 20 times a second whether to go on: any result but 0 stops the call
 * (KAPITZA_STOPPED). NULL: nothing is asked. It must not use the pendulum of the call. */
typedef int (*kapitza_pause)(void *context);
void kapitza_set_pause(kapitza_pause pause, void *context);

/* ---- the pendulum ---- */

typedef struct kapitza_pendulum kapitza_pendulum;

/* Makes a pendulum from the text of a scene (YAML or JSON; docs/reference/scene.md), for example
 *   "pendulum: {quality_factor: 5, drive_frequency: 11, drive_amplitude: 0.3}"
 * Of the scene it takes the mappings `pendulum`, `numerics` and `basin`: the window, the search for attractors, the
 * phase of release. Without `basin` the window is the whole circle and velocities from -2 to 2. Free it by
 * kapitza_pendulum_free. */
kapitza_status kapitza_pendulum_create(const char *scene, kapitza_pendulum **pendulum);

/* The text of a scene with changes "KEY=VALUE". `name` is that of its file, which messages repeat: "NAME:LINE:COLUMN:
 * KEY: ...". */
typedef struct {
  const char *text, *name;
  const char *const *sets; /* [n_sets] */
  int32_t n_sets;
} kapitza_scene;
/* Makes the pendulum of such a scene. */
kapitza_status kapitza_pendulum_open(const kapitza_scene *scene, kapitza_pendulum **pendulum);
/* Frees a pendulum that no thread uses; NULL: nothing. */
void kapitza_pendulum_free(kapitza_pendulum *pendulum);

/* The numbers of a pendulum; NaN = not defined. */
typedef struct {
  double k, beta, m;                                       /* k = 1/Omega^2, beta = 1/(Q Omega), m = epsilon */
  double quality_factor, drive_frequency, drive_amplitude; /* Q, Omega, epsilon */
  double pivot_frequency;                                  /* rad/s, of a scene in SI units */
  int32_t mirrored; /* 1: the mirror image (-theta, -velocity) of every motion is a motion, else 0 */
} kapitza_parameters;
kapitza_status kapitza_parameters_of(kapitza_pendulum *pendulum, kapitza_parameters *parameters);

/* Tells between which amplitudes of a sine drive, as m of the pendulum, it stands upside down [0, 1] and flutters [2,
 * 3]; NaN = at none, or no end is known. */
kapitza_status kapitza_needs(kapitza_pendulum *pendulum, double amplitude[4]);

/* Moves n states through drive periods, backwards if periods < 0, with the numerics of all published numbers (error
 * some 1e-12 rad a period). In and out: theta [n], out in [-pi, pi); velocity [n]. turns [n] = net turns,
 * counterclockwise +; NULL = not wanted. tangent [n][2][2] = d(theta, velocity)/d(theta0, velocity0); NULL = not
 * wanted. */
kapitza_status kapitza_map(kapitza_pendulum *pendulum, int64_t n, int64_t periods, double *theta, double *velocity,
                           int64_t *turns, double *tangent);

/* One motion in continuous time, after `transient` periods: theta_out (not wrapped) and velocity_out [periods * samples
 * + 1], `samples` a period, both ends included. */
kapitza_status kapitza_orbit(kapitza_pendulum *pendulum, double theta, double velocity, int64_t transient,
                             int64_t periods, int64_t samples, double *theta_out, double *velocity_out);

/* ---- cycles: attractors, saddles ---- */

/* A periodic motion, or an attractor without a period. */
typedef struct {
  char name[64];                             /* "inverted", "rotation +1/1", ... as in files */
  int32_t period;                            /* drive periods; 0: chaotic, or a running state (winding 1 or -1) */
  int32_t winding;                           /* net turns in a period */
  int32_t centre;                            /* 0 down, 1 inverted, 2 rotating, 3 none of these */
  int32_t symmetric;                         /* 1: it is its own image under the symmetry of the pendulum, else 0 */
  int32_t mirror;                            /* index of the mirror image in the list; its own if symmetric or alone */
  double mean_theta, mean_velocity;          /* over time; not of cycles that do not attract */
  double amplitude;                          /* rad from the centre; 0 for rotations */
  double multiplier_re[2], multiplier_im[2]; /* Floquet multipliers over the period, larger modulus first */
  double lyapunov, lyapunov_error;           /* largest exponent per drive period; its standard error */
  const double *theta, *velocity;            /* [period] strobe points in the order of time */
} kapitza_cycle;

/* A list in one piece of memory: free it by kapitza_free. */
typedef struct {
  int64_t count;
  const kapitza_cycle *cycle; /* [count] */
} kapitza_cycles;
void kapitza_free(void *memory);

/* Lists the known attractors in the order of files; indices are ids. The first call searches; labels may find more. */
kapitza_status kapitza_attractors(kapitza_pendulum *pendulum, kapitza_cycles **list);
/* All cycles of up to max_period periods, attracting or not, with a point in window [4]: least and largest angle, least
 * and largest velocity. *open = number of pairs of period and winding whose indices do not add up to 0: if it is 0 none
 * is missing (docs/explanation/theory.md). */
kapitza_status kapitza_all_cycles(kapitza_pendulum *pendulum, int64_t max_period, const double window[4],
                                  kapitza_cycles **list, int64_t *open);
/* The cycle that Newton's method finds near a state and that closes after `period` <= 64 periods, attracting or not;
 * the first strobe point is that near the state. The list is empty if none lies within `distance` (rad). */
kapitza_status kapitza_cycle_near(kapitza_pendulum *pendulum, int64_t period, double theta, double velocity,
                                  double distance, kapitza_cycles **list);

/* One branch of the stable (stable 1) or unstable (0) manifold of the saddle with this point, along its eigenvector
 * (side 1) or against it (-1). Neighbours are at most `spacing` apart, the branch is `length` long (rad and rad per
 * drive radian together), and parts faster than `fastest` are left out. point [most][4]: theta in [-pi, pi), velocity,
 * arc length, number of the unbroken part. *count = number of points. */
kapitza_status kapitza_manifold(kapitza_pendulum *pendulum, double theta, double velocity, int32_t period,
                                int32_t stable, int32_t side, double spacing, double length, double fastest,
                                int64_t most, double *point, int64_t *count);

/* ---- basins ---- */

/* Evidence of a label, values of `evidence` (docs/reference/file.md); 3 = undecided, `other` is the second
 * candidate. */
enum { KAPITZA_NO_TURNS = -2147483647 - 1 };

/* Labels n starts as basin.method exact does. start_error = bound of the distance of each motion from its start (hypot
 * of rad and rad per drive radian); 0 = the numbers are exact. Arrays [n], each may be NULL: attractor = id, -1 = not
 * settled; other = the second candidate of an undecided start, else -1; settling_time in drive periods; turns = net
 * turns until the end, KAPITZA_NO_TURNS = not known; error = bound of the orbit's error when it was trapped, rad, NaN =
 * not known. *list = the attractors to which the ids refer; NULL = not wanted. */
kapitza_status kapitza_labels(kapitza_pendulum *pendulum, int64_t n, const double *theta, const double *velocity,
                              double start_error, int16_t *attractor, int16_t *other, uint8_t *evidence,
                              int64_t *settling_time, int32_t *turns, double *error, kapitza_cycles **list);

/* Labels of the cells of a window; one piece of memory, freed by kapitza_free. */
typedef struct {
  int64_t columns, rows;
  const double *theta, *velocity;     /* [columns], [rows] centres of the cells */
  const int16_t *attractor, *other;   /* [rows][columns] as of kapitza_labels */
  const uint8_t *evidence;            /* [rows][columns] */
  const float *settling_time, *turns; /* [rows][columns]; NaN = not known */
  const kapitza_cycles *attractors;
} kapitza_basin;
/* Labels the cells of a window by all cores. window: keys of the mapping `basin` of a scene, such as
 *   "theta: {count: 500}, velocity: {min: -2, max: 2, count: 500}" or, at any depth, "theta: {centre: 2.0512, width:
 * 1e-20, count: 500}, ..." Keys that it leaves out are those of the pendulum's scene; NULL: all of them. */
kapitza_status kapitza_basin_of(kapitza_pendulum *pendulum, const char *window, kapitza_basin **basin);

/* ---- frames: windows that somebody looks at ---- */

/* The functions of this section and of the next keep what they have found of the last pendulums, so that the next frame
 * is quick. `change` is the flow text of mappings of a scene, such as "pendulum: {...}, basin: {theta: {min: -3, max:
 * 3, count: 400}, velocity: {centre: 0.2, width: 1e-20, count: 250}}" `pendulum` and `sweep` replace those of the
 * scene, keys of `basin` its keys; an axis with `count` alone keeps its window. NULL: nothing is changed. */

/* The known attractors of a pendulum, in the order of ids. */
typedef struct {
  int64_t version; /* from 1; every other list has another number */
  kapitza_parameters parameters;
  kapitza_cycles attractors;
  const int64_t *track; /* [attractors.count] a number that stays with an attractor while the pendulum changes */
} kapitza_catalogue;
/* A copy of the list; free it by kapitza_free. */
kapitza_status kapitza_catalogue_of(kapitza_pendulum *pendulum, const char *change, kapitza_catalogue **catalogue);

/* Planes of a frame: values of each cell. NaN, and 255 of labels, = not settled, or not known. */
enum {
  KAPITZA_PLANE_LABELS,        /* uint8_t: id of an attractor */
  KAPITZA_PLANE_SETTLING_TIME, /* float: drive periods after which the end is certain */
  KAPITZA_PLANE_SMOOTH_TIME,   /* float: that until the trapping region, between whole periods too; for pictures */
  KAPITZA_PLANE_DOUBT,         /* uint8_t: 0 decided, 1 undecided, 2 not known (of a moving frame) */
  KAPITZA_PLANE_OTHER,         /* uint8_t: second candidate of an undecided cell, else 255 */
  KAPITZA_PLANE_TURNS,         /* float: net turns until the end; NaN in moving frames */
  KAPITZA_PLANE_EVIDENCE,      /* uint8_t: as in files */
  KAPITZA_PLANES
};

/* A request for a frame. */
typedef struct {
  const char *change;
  int32_t moving;        /* 1: fast, with errors much smaller than a cell; 0: labels as by basin.method exact */
  int32_t planes;        /* sum of 1 << KAPITZA_PLANE_... */
  int32_t n_parts;       /* 1 to 4 */
  int32_t coarseness[4]; /* [n_parts] of each part, from 8, 4, 2, 1, falling: every eighth cell ..., all cells */
  const char *atlas; /* result file of the study atlas, whose motions at x, y attract in a moving frame; NULL: none */
  double x, y;
} kapitza_frame_request;

/* A part of a frame: every cell of a multiple of the coarseness. Cell (i, j) of the part is cell (min(coarseness i + o,
 * rows - 1), ...) of the window, with o = 0, 1, 1, 5 for coarseness 1, 2, 4, 8. All pointers are valid while it is
 * shown. */
typedef struct {
  const kapitza_catalogue *catalogue; /* to which the labels refer */
  const void *plane[KAPITZA_PLANES];  /* [rows][columns], lowest velocity first; NULL = not asked for */
  int32_t coarseness, rows, columns;
  int32_t last;   /* 1: the frame is complete */
  double seconds; /* processor time of the process since the frame began */
} kapitza_frame_part;
typedef int (*kapitza_show)(void *context, const kapitza_frame_part *part);

/* Makes a frame and shows its parts by `show`, the coarse ones first. `between` (NULL: none) is asked every few
 * milliseconds whether to go on; it may call kapitza_where, kapitza_catalogue_of, kapitza_motions_at and
 * kapitza_line_through for the same pendulum. Any result but 0 of these two ends the frame (KAPITZA_STOPPED): the parts
 * that were shown are right, and what has been found is kept. */
kapitza_status kapitza_frame(kapitza_pendulum *pendulum, const kapitza_frame_request *request, kapitza_show show,
                             kapitza_pause between, void *context);

/* Where one start ends over a plane of two keys: change = "sweep: {measure: [ends], ends: {theta: [3]}, x: {parameter:
 * ..., min, max, count}, y: ...}". Parts and callbacks as of kapitza_frame. */
typedef struct {
  const uint8_t *period,
      *centre; /* [rows][columns], x fastest: period 0 = it never closes, 255 = not settled; centre as of a cycle */
  int32_t coarseness, rows, columns, last;
} kapitza_chart_part;
typedef int (*kapitza_show_chart)(void *context, const kapitza_chart_part *part);
kapitza_status kapitza_chart(kapitza_pendulum *pendulum, const char *change, int32_t n_parts, const int32_t *coarseness,
                             kapitza_show_chart show, kapitza_pause between, void *context);

/* Tells where the pivot is at n times (drive radians): place [n][2] = aside, height, in units of I/(M r) of the
 * pendulum. */
kapitza_status kapitza_pivot(kapitza_pendulum *pendulum, int64_t n, const double *time, double *place);

/* ---- ends of single starts, with any number of digits ---- */

/* Where a start ends. */
typedef struct {
  char name[64], other_name[64]; /* "": not settled, no second candidate */
  char precision[16];            /* double, pairs, quad, arbitrary; "": undecided, or not settled */
  int32_t attractor, other;      /* as of kapitza_labels */
  int32_t turns;                 /* KAPITZA_NO_TURNS = not known */
  int32_t period, winding;       /* drive periods and net turns of the attractor */
  int64_t settling_time;         /* drive periods after which the end is certain */
  int64_t near_time; /* drive periods after which the angle stays within 1 degree of the final motion; -1 = not known */
  double error;      /* rad, when it was trapped; NaN = not known */
  double mean_velocity;                         /* mean velocity of the attractor, rad per drive radian */
  double theta, velocity;                       /* the start, to the nearest double */
  const double *strobe_theta, *strobe_velocity; /* [period] */
} kapitza_ending;

/* One piece of memory: free it by kapitza_free. */
typedef struct {
  int64_t count;
  const kapitza_ending *ending; /* [count] */
  kapitza_parameters parameters;
} kapitza_endings;

/* Tells where n starts end, whose theta (rad, or "170 deg") and velocity [n] are decimal numbers of any digits, all of
 * which count. */
kapitza_status kapitza_where(kapitza_pendulum *pendulum, const char *change, int64_t n, const char *const *theta,
                             const char *const *velocity, kapitza_endings **endings);

/* Tells where n starts end among the attractors that a run of the scene finds, with the ids of its file. A number with
 * more digits than a double has counts with all of them, another one as the nearest double; velocities may have a unit
 * ("3 rad/s"). A message about start N begins with "start N: ". */
kapitza_status kapitza_where_of(const kapitza_scene *scene, int64_t n, const char *const *theta,
                                const char *const *velocity, kapitza_endings **endings);

/* The point at which two basins meet on the straight line between two starts: numbers with `digits` right digits (1 to
 * 900) behind the point. */
typedef struct {
  char theta[1024], velocity[1024];
  char name[2][64];     /* names of the attractors towards the first start, and towards the second */
  int32_t attractor[2]; /* their ids */
} kapitza_boundary;
kapitza_status kapitza_boundary_of(const kapitza_scene *scene, const char *const *theta, const char *const *velocity,
                                   int64_t digits, kapitza_boundary *boundary);

/* ---- atlases in result files ---- */

/* A motion that attracts at a point of the plane of an atlas. */
typedef struct {
  char name[64];
  int32_t period, winding, centre, symmetric; /* as of a cycle */
  int32_t images;                             /* 2: its mirror image attracts too, else 1 */
  int32_t strobes;                            /* period; 0: its states are not known, or not asked for */
  int64_t curve;                              /* from which its state was carried; -1 = from none */
  double multiplier_re[2], multiplier_im[2];
  const double *theta, *velocity; /* [strobes] */
} kapitza_motion;
typedef struct {
  int64_t count;
  const kapitza_motion *motion; /* [count] */
  double x, y, k, beta, m;      /* the point, and its pendulum */
} kapitza_motions;
/* Lists what attracts at the point x, y of the atlas in a result file; states 0: without strobe points and multipliers.
 * Free it by kapitza_free. */
kapitza_status kapitza_motions_at(kapitza_pendulum *pendulum, const char *file, double x, double y, int32_t states,
                                  kapitza_motions **motions);

/* Branches of cycles along a line through an atlas: points first .. first + points - 1 each. */
typedef struct {
  char name[64];
  int32_t period, winding, centre, symmetric, images;
  int64_t first, points;
} kapitza_branch;
typedef struct {
  int64_t count, points;
  const kapitza_branch *branch; /* [count] */
  const double *point; /* [points][5]: value of the key, mean height of the bob, theta, velocity, largest modulus of a
                          multiplier */
} kapitza_line;
/* Lists all branches of cycles along the line x = value (along_x 0), or y = value (along_x 1), of the atlas in a result
 * file. Free it by kapitza_free. */
kapitza_status kapitza_line_through(kapitza_pendulum *pendulum, const char *file, int32_t along_x, double value,
                                    kapitza_line **line);

/* ---- scenes ---- */

/* Runs a scene (text) on one rank and writes the result file `output`, which must not exist unless overwrite is 1.
 * *summary = what the program prints, freed by kapitza_free; NULL = not wanted. */
kapitza_status kapitza_run(const char *scene, const char *output, int32_t overwrite, char **summary);

#ifdef __cplusplus
}
#endif
#endif
