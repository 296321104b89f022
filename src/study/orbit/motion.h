/* One motion of one pendulum as the study `orbit` needs it: model and numerics chosen, started, skipped ahead, recorded. */
#ifndef KAPITZA_STUDY_MOTION_H
#define KAPITZA_STUDY_MOTION_H

#include "kapitza/analysis.h"
#include "kapitza/study.h"

/* What moves the state: a model with its parameters. */
typedef struct {
  int32_t kind;
  kz_pendulum pendulum; /* of the model: signs turned about the inverted position */
  double origin;        /* rad: the angle that the model counts from, 0 or pi */
  kz_flow *flow;        /* of the pendulum itself; NULL for the other models */
  kz_numerics numerics; /* of the flow; a closed orbit is computed in double at least */
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
} kz_motion;

/* KZ_FAILED where memory ran out. Freed by kz_model_free. */
void kz_model_make(const kz_scene *scene, kz_model *model);
void kz_model_free(kz_model *model);

/* Moves a state ahead by whole periods; theta comes back within a turn for the pendulum. */
void kz_model_skip(const kz_model *model, int64_t periods, kz_state *state);

/* Records `periods` from a state. KZ_FAILED where memory ran out or the motion left the range of numbers. */
kz_status kz_model_record(const kz_model *model, int64_t periods, kz_state start, kz_motion *motion);
void kz_motion_free(kz_motion *motion);

/* A closed orbit. */
typedef struct {
  kz_state state;      /* at a strobe time */
  int64_t period;      /* the smallest that closes it */
  double re[2], im[2]; /* Floquet multipliers over the period; NaN where the model has none */
} kz_cycle;

/* The cycle at or near `start`: of the given period, or (period = 0) of the shortest that the orbit comes back to. Newton's
 * method on the strobe map for the pendulum; for the linear model the orbit itself must close. KZ_FAILED says what was
 * found instead. */
kz_status kz_cycle_close(const kz_model *model, int64_t period, kz_state start, kz_cycle *cycle);

#endif
