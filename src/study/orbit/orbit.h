/* Study `orbit`: its parts. One motion of one pendulum, by one of three models. */
#pragma once

#include "kapitza/dynamics.h"
#include "kapitza/study_orbit.h"

/* ---- the motion ---- */

/* A model with its parameters, which moves the state. */
typedef struct {
  int32_t kind;
  kz_pendulum pendulum; /* Pendulum of the model: signs turned about the inverted position */
  double origin;        /* rad: the angle that the model counts from, 0 or pi */
  kz_flow *flow;        /* Map of the pendulum itself; NULL for the other models */
  kz_numerics numerics; /* Numerics of the flow; a closed orbit is computed in double at least */
  int64_t samples;      /* per period, of every record; a multiple of the scene's */
} kz_model;

/* A state at a strobe time: rad from down, rad per drive radian. */
typedef struct {
  double theta, velocity;
} kz_state;

/* A record from t = 0, both ends: [periods * samples + 1], theta unwrapped. */
typedef struct {
  int64_t periods, samples;
  double *theta, *velocity;
} kz_orbit_motion;

/* Freed by kz_model_free. */
void kz_model_make(const kz_scene *scene, kz_model *model);
void kz_model_free(kz_model *model);

/* Moves a state ahead by whole periods; theta comes back within a turn for the pendulum. */
void kz_model_skip(const kz_model *model, int64_t periods, kz_state *state);

/* Records `periods` from a state; KZ_FAILED if numbers overflow. The caller frees both arrays in any case. */
kz_status kz_model_record(const kz_model *model, int64_t periods, kz_state orbit_start, kz_orbit_motion *motion);

/* A closed orbit. */
typedef struct {
  kz_state state;   /* at a strobe time */
  int64_t period;   /* the smallest that closes it */
  kz_attractor row; /* Floquet multipliers NaN where the model has none */
} kz_cycle;

/* ---- its features ---- */

typedef struct {
  bool closed;
  int64_t period;  /* n; of an open record that of its lines, 0 = they have none */
  int64_t winding; /* net turns in n periods; of an open record without n in the whole record */
  int centre;      /* KZ_ABOUT_DOWN ... */
  double origin;   /* rad: the angle that deflections are counted from, a multiple of pi; 0 where there is no centre */
  bool symmetric;  /* its own mirror image; false for an open record */
  bool chaotic;    /* an open record without period whose neighbours part; its lines are of the velocity */
  char name[KZ_NAME_LENGTH];
  int64_t n_lines;        /* lines j = 0 .. n_lines - 1 */
  int64_t record_periods; /* line j lies at j / record_periods drive frequencies */
  int64_t dominant;
  double *amplitude, *phase;
  int64_t n_turning;
  kz_turning_point *turning;
} kz_orbit_features;

typedef struct {
  const kz_scene *scene;
  kz_model model;
  kz_cycle cycle; /* Cycle of a closed orbit; period 0 = open */
  kz_orbit_motion motion;
  kz_orbit_features features;
  double lyapunov,
      lyapunov_error; /* largest exponent along the record, per drive period; NaN without the pendulum's own model */
  bool parting;       /* neighbours of an open record separate for good */
  char settles_on[KZ_NAME_LENGTH]; /* attractor that an open record leads to; "" = none is known */
} kz_orbit;

/* lyapunov, lyapunov_error: mean of the logarithm of the growth of a small deviation per drive period, along the record
 * of the pendulum, by the tangent map, and its standard error from blocks of the record; NaN if the record is too short
 * for blocks. */
void kz_orbit_exponent(kz_orbit *orbit);

/* parting, settles_on: how an open record of the pendulum goes on, in chaos or to which attractor. Motions so fast that
 * this takes long are left without an answer. */
kz_status kz_orbit_look_ahead(kz_orbit *orbit);

/* Features of a record whose first cycle.period periods are a cycle (0 = open). KZ_FAILED if lines contradict. */
kz_status kz_orbit_features_make(kz_orbit *orbit);

/* Group /orbit of the file, and a line for people. */
kz_status kz_orbit_write(const kz_orbit *orbit, kz_store *store);
void kz_orbit_print(const kz_orbit *orbit, FILE *summary);
