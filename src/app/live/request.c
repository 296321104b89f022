#include "request.h"

#include "json_read.h"
#include "kapitza/study_orbit.h"
#include "kapitza/study_release.h"

enum { MOST_CELLS = 1 << 24 /* of a frame, or samples of an orbit */ };
static const char SOURCE[] = "request";

#define AT(field) offsetof(kz_request, field)
#define WORDS_OF_KIND "frame|where|orbit|catalogue|chart|motions|line|cancel|quit"
/* Keys of the request itself, with their defaults; the others change the scene. The sequence comes first: every later
 * error is answered with it. */
static const kz_key rows[] = {
    {.path = "sequence",
     .type = KZ_KEY_INTEGER,
     .unit = "",
     .fallback = "0",
     .high = 1LL << 53,
     .offset = AT(sequence)},
    {.path = "request", .type = KZ_KEY_WORD, .unit = "", .words = WORDS_OF_KIND, .offset = AT(kind)},
    {.path = "view", .type = KZ_KEY_TEXT, .unit = "", .fallback = "\"\"", .offset = AT(view)},
    {.path = "quality",
     .type = KZ_KEY_WORD,
     .unit = "",
     .words = "exact|moving",
     .fallback = "exact",
     .offset = AT(quality)},
    {.path = "rows", .type = KZ_KEY_INTEGER, .unit = "", .fallback = "", .low = 1, .high = 8192, .offset = AT(rows)},
    {.path = "columns",
     .type = KZ_KEY_INTEGER,
     .unit = "",
     .fallback = "",
     .low = 1,
     .high = 8192,
     .offset = AT(columns)},
    {.path = "levels",
     .type = KZ_KEY_INTEGERS,
     .unit = "",
     .fallback = "[1]",
     .low = 1,
     .high = 8,
     .offset = AT(coarseness)},
    {.path = "planes",
     .type = KZ_KEY_WORDS,
     .unit = "",
     .words = KZ_PLANE_WORDS,
     .fallback = "[labels]",
     .offset = AT(planes)},
    {.path = NULL},
};

/* Where the keys of a kind of request go in the scene. */
static const struct {
  int32_t kind;
  const char *key, *path;
} moved[] = {
    {KZ_REQUEST_FRAME, "window.theta", "basin.theta"},
    {KZ_REQUEST_FRAME, "window.velocity", "basin.velocity"},
    {KZ_REQUEST_ORBIT, "theta", "orbit.start.theta"},
    {KZ_REQUEST_ORBIT, "velocity", "orbit.start.velocity"},
    {KZ_REQUEST_ORBIT, "periods", "orbit.periods"},
    {KZ_REQUEST_ORBIT, "transient", "orbit.transient"},
    {KZ_REQUEST_ORBIT, "samples_per_period", "orbit.samples_per_period"},
    {KZ_REQUEST_CHART, "x", "sweep.x"},
    {KZ_REQUEST_CHART, "y", "sweep.y"},
};
enum { N_MOVED = sizeof moved / sizeof moved[0] };

/* What another value replaces as a whole. */
static const struct {
  int32_t kind;
  const char *path;
} dropped[] = {{KZ_REQUEST_ORBIT, "orbit"},           {KZ_REQUEST_FRAME, "basin.accuracy"},
               {KZ_REQUEST_WHERE, "basin.accuracy"},  {KZ_REQUEST_CHART, "sweep.measure"},
               {KZ_REQUEST_CHART, "sweep.parameter"}, {KZ_REQUEST_CHART, "sweep.min"},
               {KZ_REQUEST_CHART, "sweep.max"},       {KZ_REQUEST_CHART, "sweep.count"}};
enum { N_DROPPED = sizeof dropped / sizeof dropped[0] };

/* What a request adds where neither it nor the scene says anything: key, YAML. */
static const struct {
  int32_t kind;
  const char *path, *value;
} added[] = {
    {KZ_REQUEST_ORBIT, "orbit.periods", "100"},
    {KZ_REQUEST_ORBIT, "orbit.samples_per_period", "64"},
    {KZ_REQUEST_CHART, "sweep.measure", "[ends]"},
    {KZ_REQUEST_CHART, "sweep.ends.theta", "[3.0]"},
};
enum { N_ADDED = sizeof added / sizeof added[0] };

/* `value`: in quotes, or "". */
static kz_status request_refuse(const kz_key *key, const char *value, const char *wrong) {
  char accepted[700];
  kz_key_accepts(rows, key, accepted, sizeof accepted);
  return kz_fail(KZ_REFUSED, "%s: %s: %s%s; it must be %s", SOURCE, key->path, value, wrong, accepted);
}

static kz_status read_row(const kz_key *key, kz_node *root, kz_request *request) {
  char value[70];
  KZ_TRY(kz_value_default(key, request));
  kz_node *node = kz_tree_take(root, key->path);
  if (!node) return key->fallback ? KZ_OK : request_refuse(key, "", "is missing");
  const kz_node *culprit;
  const char *wrong = kz_value_read(key, node, request, &culprit);
  snprintf(value, sizeof value, "\"%.60s\" ", wrong && culprit->text ? culprit->text : "...");
  const kz_status status = wrong ? request_refuse(key, value, wrong) : KZ_OK;
  kz_tree_free(node);
  return status;
}

static kz_status read_rows(const kz_key *key, kz_node *root, kz_request *request) {
  for (; key->path; key++) KZ_TRY(read_row(key, root, request));
  return KZ_OK;
}

static kz_status check_coarseness(const kz_integers *coarseness) {
  for (int64_t i = 0; i < coarseness->count; i++) {
    const int64_t step = coarseness->values[i];
    if ((step & (step - 1)) != 0 || (i > 0 && step >= coarseness->values[i - 1]))
      return kz_fail(KZ_REFUSED, "%s: levels: %lld is out of place; it must be a list from 8, 4, 2, 1 in falling order",
                     SOURCE, (long long)step);
  }
  return KZ_OK;
}

static kz_status check_frame(const kz_request *request) {
  for (int i = 0; i < 2; i++)
    if ((i == 0 ? request->rows : request->columns) == KZ_UNSET_INTEGER)
      return kz_fail(KZ_REFUSED, "%s: %s: is missing; it must be an integer from 1 to 8192", SOURCE,
                     i == 0 ? "rows" : "columns");
  if (request->rows * request->columns > MOST_CELLS)
    return kz_fail(KZ_REFUSED, "%s: rows: %lld times %lld columns are more than %d cells", SOURCE,
                   (long long)request->rows, (long long)request->columns, MOST_CELLS);
  return check_coarseness(&request->coarseness);
}

static kz_status check_orbit(const kz_request *request) {
  const kz_orbit_plan *plan = request->scene.orbit;
  const kz_release release = kz_release_of(&request->scene, &request->scene.parameters.pendulum);
  if (kz_release_strobes(&release) > 0)
    return kz_fail(
        KZ_REFUSED,
        "%s: orbit: a motion begins at phase 0 and without a ramp; leave out basin.start_phase and pendulum.ramp",
        SOURCE);
  if (plan->periods * plan->samples_per_period <= MOST_CELLS) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: periods: %lld times %lld samples_per_period are more than %d samples", SOURCE,
                 (long long)plan->periods, (long long)plan->samples_per_period, MOST_CELLS);
}

/* Keys of one kind of request: the start of where, numbers of any digits; the point of motions. */
static const kz_key start_rows[] = {
    {.path = "theta", .type = KZ_KEY_DECIMAL, .unit = "rad", .low = -1e6, .high = 1e6, .offset = AT(theta)},
    {.path = "velocity",
     .type = KZ_KEY_DECIMAL,
     .unit = "rad per drive radian, without a unit behind it",
     .low = -1e9,
     .high = 1e9,
     .offset = AT(velocity)},
    {.path = NULL},
};
#define POINT_ROWS(no_atlas)                                                                       \
  {                                                                                                \
    {.path = "atlas", .type = KZ_KEY_TEXT, .unit = "", .fallback = no_atlas, .offset = AT(atlas)}, \
        {.path = "x",                                                                              \
         .type = KZ_KEY_REAL,                                                                      \
         .unit = "",                                                                               \
         .fallback = "",                                                                           \
         .low = -DBL_MAX,                                                                          \
         .high = DBL_MAX,                                                                          \
         .offset = AT(x)},                                                                         \
        {.path = "y",                                                                              \
         .type = KZ_KEY_REAL,                                                                      \
         .unit = "",                                                                               \
         .fallback = "",                                                                           \
         .low = -DBL_MAX,                                                                          \
         .high = DBL_MAX,                                                                          \
         .offset = AT(y)},                                                                         \
    {                                                                                              \
      .path = NULL                                                                                 \
    }                                                                                              \
  }
static const kz_key point_rows[] = POINT_ROWS(NULL), frame_rows[] = POINT_ROWS("\"\"");
static const kz_key state_rows[] = {
    {.path = "states", .type = KZ_KEY_BOOLEAN, .unit = "", .fallback = "true", .offset = AT(states)},
    {.path = NULL},
};

/* What is left of the request is not known. */
static kz_status check_rest(kz_node *root) {
  kz_tree_free(kz_tree_find(root, "window") && !kz_tree_find(root, "window")->first ? kz_tree_take(root, "window")
                                                                                    : NULL);
  if (!root->first) return KZ_OK;
  return kz_fail(KZ_REFUSED, "%s: %.60s: unknown key of such a request; docs/reference/serve.md lists them", SOURCE,
                 root->first->name);
}

/* A point of an atlas, or a line: one of its coordinates. A frame without an atlas has none. */
static kz_status check_point(const kz_request *request) {
  const bool is_line = request->kind == KZ_REQUEST_LINE;
  const int given = !isnan(request->x) + !isnan(request->y);
  if (!*request->atlas && given > 0)
    return kz_fail(KZ_REFUSED, "%s: x: is a point of an atlas; give the name of its file as atlas", SOURCE);
  if (!*request->atlas && request->kind == KZ_REQUEST_FRAME) return KZ_OK;
  if (given == (is_line ? 1 : 2)) return KZ_OK;
  return kz_fail(KZ_REFUSED, is_line ? "%s: x: a line has x or y, not both" : "%s: %s: is missing; it must be a number",
                 SOURCE, isnan(request->x) ? "x" : "y");
}

static kz_status read_point(kz_node *root, kz_request *request) {
  KZ_TRY(read_rows(point_rows, root, request));
  if (request->kind == KZ_REQUEST_MOTIONS) KZ_TRY(read_rows(state_rows, root, request));
  KZ_TRY(check_rest(root));
  return check_point(request);
}

static kz_status read_frame(kz_node *root, kz_request *request) {
  KZ_TRY(read_rows(frame_rows, root, request));
  KZ_TRY(check_point(request));
  return check_frame(request);
}

static kz_status set_text(kz_node *tree, const char *path, const char *text) {
  kz_node *node;
  KZ_TRY(kz_tree_read(text, strlen(text), SOURCE, true, &node));
  return kz_tree_set(tree, path, node);
}

static kz_status set_count(kz_node *tree, const char *path, int64_t count) {
  char text[32];
  snprintf(text, sizeof text, "%lld", (long long)count);
  return set_text(tree, path, text);
}

/* Takes what the request changes over into the scene's tree. */
static kz_status change_scene(const kz_request *request, kz_node *root, kz_node *tree) {
  for (int i = 0; i < N_DROPPED; i++)
    if (dropped[i].kind == request->kind) kz_tree_free(kz_tree_take(tree, dropped[i].path));
  kz_node *pendulum = kz_tree_take(root, "pendulum");
  if (pendulum) KZ_TRY(kz_tree_set(tree, "pendulum", pendulum));
  for (int i = 0; i < N_MOVED; i++) {
    kz_node *node = moved[i].kind == request->kind ? kz_tree_take(root, moved[i].key) : NULL;
    if (!node) continue;
    if (node->kind == KZ_SCALAR) node->plain = true; /* numbers may stand in quotes */
    KZ_TRY(kz_tree_set(tree, moved[i].path, node));
  }
  for (int i = 0; i < N_ADDED; i++)
    if (added[i].kind == request->kind && !kz_tree_find(tree, added[i].path))
      KZ_TRY(set_text(tree, added[i].path, added[i].value));
  if (request->kind != KZ_REQUEST_FRAME) return KZ_OK;
  KZ_TRY(set_count(tree, "basin.theta.count", request->columns));
  KZ_TRY(set_count(tree, "basin.velocity.count", request->rows));
  return set_text(tree, "basin.method", "exact");
}

static kz_status read_scene(const kz_node *tree, kz_node *root, kz_request *request) {
  kz_node *copy = kz_tree_copy(tree);
  kz_status status = change_scene(request, root, copy);
  if (status == KZ_OK) status = check_rest(root);
  if (status == KZ_OK) status = kz_scene_of_tree(copy, &request->scene);
  request->has_scene = status == KZ_OK;
  kz_tree_free(copy);
  return status;
}

static kz_status read_root(const kz_node *tree, kz_node *root, kz_request *request) {
  if (root->kind != KZ_MAPPING) return kz_fail(KZ_REFUSED, "%s: is not a JSON object", SOURCE);
  KZ_TRY(read_rows(rows, root, request));
  if (request->kind == KZ_REQUEST_CANCEL || request->kind == KZ_REQUEST_QUIT) return check_rest(root);
  if (request->kind == KZ_REQUEST_FRAME) KZ_TRY(read_frame(root, request));
  if (request->kind == KZ_REQUEST_CHART) KZ_TRY(check_coarseness(&request->coarseness));
  if (request->kind == KZ_REQUEST_WHERE) KZ_TRY(read_rows(start_rows, root, request));
  if (request->kind == KZ_REQUEST_MOTIONS || request->kind == KZ_REQUEST_LINE) return read_point(root, request);
  KZ_TRY(read_scene(tree, root, request));
  return request->kind == KZ_REQUEST_ORBIT ? check_orbit(request) : KZ_OK;
}

kz_status kz_request_read(const kz_node *tree, const char *line, size_t length, kz_request **request) {
  kz_node *root;
  *request = kz_calloc(1, sizeof **request);
  (*request)->sequence = KZ_UNSET_INTEGER;
  KZ_TRY(kz_json_read(line, length, SOURCE, &root));
  const kz_status status = read_root(tree, root, *request);
  kz_tree_free(root);
  return status;
}

void kz_request_free(kz_request *request) {
  if (!request) return;
  if (request->has_scene) kz_scene_free(&request->scene);
  free(request->view);
  free(request->atlas);
  free(request);
}
