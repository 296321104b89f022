/* A path between two cycles, continued along a line through the values of the plan's axes. */
#pragma once

#include "routes.h"

/* Pendulums along the axes: values [2] of x and y in steps of the grid. */
typedef struct {
  const kz_scene *scene;
  int n_axes;
} kz_escape_places;
/* False where there is no damped pendulum. */
bool kz_escape_place(const kz_escape_places *places, const double at[2], kz_pendulum *pendulum);

/* A pendulum with its flow. */
typedef struct {
  kz_pendulum pendulum;
  kz_escape_flow of; /* flow NULL: no damped pendulum here */
} kz_escape_site;
void kz_escape_site_open(const kz_escape_places *places, const double at[2], kz_escape_site *site);
void kz_escape_site_close(kz_escape_site *site);

/* A path and its cycles at a place. The path's node is the member's own memory. */
typedef struct {
  double at[2];
  kz_pendulum pendulum;
  kz_path_end from, to;
  kz_path path;
} kz_escape_member;
void kz_escape_member_copy(const kz_escape_member *of, kz_escape_member *copy);
void kz_escape_member_free(kz_escape_member *member);

/* Continues a path to a neighbouring place of which `site` is known; `turns`: through folds too. False where it does
 * not exist there; the member is then where it was. */
bool kz_escape_continue(const kz_escape_places *places, const kz_escape_site *site, const double at[2], bool turns,
                        kz_escape_member *member);
