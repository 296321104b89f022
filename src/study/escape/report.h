/* Results of the paths of each attractor, and the group escape of the file. */
#pragma once

#include "gates.h"

/* A search of paths from an attractor to a saddle, and where the least one leads. */
typedef struct {
  int32_t from, saddle; /* ids */
  bool is_gate;         /* the saddle lies on the edge of its basin (kz_gate_is_of) */
  bool reflected;       /* it is the mirror image of another one, and not searched */
  bool agrees;          /* with its mirror image, where both were searched */
  int32_t before, into; /* ids of the attractors on this side and on the other side of the saddle; -1 = none */
} kz_escape_task;

typedef struct {
  const kz_scene *scene;
  const kz_listed *attractors, *saddles;
  const kz_gate *gate; /* [saddles->count] */
  int64_t n;
  kz_escape_task *task;   /* [n] */
  kz_escape_route *route; /* [n] */
} kz_escape_report;

/* Results on leaving one attractor. */
typedef struct {
  int64_t way;     /* the least path through a gate; -1 = none */
  double life;     /* the exponent of the mean life: the least over gates, islands behind them included; INFINITY */
  int32_t through; /* the island on that way; -1 = none */
} kz_escape_life;

/* A state on this side of the saddle at which the path ends, and one on the other side. */
void kz_escape_beyond(const kz_escape_route *route, const kz_gate *gate, double before[2], double beyond[2]);
/* Paths and their mirror images become equal: the lesser counts for both, and a difference is noted. */
void kz_escape_pair(const kz_escape_report *report);
/* life [attractors->count]. */
void kz_escape_lives(const kz_escape_report *report, kz_escape_life *life);
/* Returns the least path from an attractor to a saddle from which a motion without torque can end in the basin of
 * `into`; -1 = none. */
int64_t kz_escape_into(const kz_escape_report *report, int32_t from, int32_t into);
kz_status kz_escape_write(const kz_escape_report *report, kz_store *store, FILE *summary);
