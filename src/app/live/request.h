/* Requests of the command serve, read from a line of JSON (docs/reference/serve.md). */
#pragma once

#include "../scene/scene.h"
#include "kapitza/study_live.h"

enum {
  KZ_REQUEST_FRAME,
  KZ_REQUEST_WHERE,
  KZ_REQUEST_ORBIT,
  KZ_REQUEST_CATALOGUE,
  KZ_REQUEST_CHART,
  KZ_REQUEST_MOTIONS,
  KZ_REQUEST_LINE,
  KZ_REQUEST_CANCEL,
  KZ_REQUEST_QUIT
};
/* Planes in the order of KZ_PLANE_LABELS ... */
#define KZ_PLANE_WORDS "labels|settling_time|smooth_time|doubt|other|turns|evidence"
enum { KZ_QUALITY_EXACT, KZ_QUALITY_MOVING };

typedef struct kz_request {
  int32_t kind;
  int64_t sequence; /* KZ_UNSET_INTEGER: the line is not JSON, or has a sequence that is no number */
  char *view;
  int32_t quality;
  int64_t rows, columns;
  kz_integers coarseness, planes;
  kz_decimal theta, velocity; /* start, for the request where */
  char *atlas;                /* for motions and frames: name of a result file, "" = none, */
  double x, y;                /* values of its keys, */
  bool states;                /* and whether the strobe points are asked for */
  bool has_scene;
  kz_scene scene; /* the scene with what the request changes: pendulum, window, orbit, chart; numerics not resolved */
  bool ended;     /* a newer request or cancel has ended it */
  struct kz_request *next;
} kz_request;

/* Reads a line [length]; `tree` is the tree of the scene. The caller frees *request in every case. KZ_REFUSED: the
 * message says why. */
kz_status kz_request_read(const kz_node *tree, const char *line, size_t length, kz_request **request);
void kz_request_free(kz_request *request);
