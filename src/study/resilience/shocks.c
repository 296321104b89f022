#include "resilience.h"

enum {
  FAN = 24,     /* most rays on each side of the best one */
  PASSES = 12,  /* most grids of a search */
  FINDS = 48,   /* most boundaries along a line, each nearer than the one before */
  RIMS = 4,     /* Closer looks at the last RIM of the way */
  SPREAD = 4096 /* shocks of a size */
};
/* Tongues of other basins lie the closer to a boundary the thinner they are: the last RIM of the way is looked at more
 * closely, the last RIM of that again, RIMS times. */
static const double RIM = 1.0 / 16;

/* How closely a search looks. */
typedef struct {
  int line, rims;        /* points on each side of a line; rims of it that are looked at more closely, RIMS or none */
  int rings, rays;       /* Rings and rays of a disc */
  int fan;               /* rays on each side of the best one */
  int pieces;            /* Pieces of a bracket, each round */
  double narrow, closed; /* a bracket is narrow enough, and a fan, where it is so small a part of the distance */
} closeness;

static int shocks_between(double low, double value, double high) {
  return (int)fmin(fmax(low, value), high);
}

/* A disc is a grid of rings, then its outermost ring is: the tolerance is the width of a ring of that. */
static closeness look_for(double tolerance) {
  const double rings = tolerance > 0 ? 1 / sqrt(tolerance) : 1e9;
  return (closeness){.line = shocks_between(64, rings * rings, 2048),
                     .rims = tolerance < 1e-6 ? RIMS : 0,
                     .rings = shocks_between(8, ceil(rings), 96),
                     .rays = shocks_between(32, ceil(4 * rings), 256),
                     .fan = shocks_between(8, rings / 2, FAN),
                     .pieces = shocks_between(4, rings / 3, 32),
                     .narrow = fmax(tolerance, 1e-13),
                     .closed = fmin(fmax(sqrt(tolerance), 1e-6), 0.1)};
}

/* Workspace of one batch of starts. */
typedef struct {
  const kz_shock_problem *problem;
  closeness look;
  double *start; /* [most][2] */
  kz_label *end; /* [most] */
} workspace;

/* Rays from the motion: unit vectors of the norm, and where along each another end lies between near and far. */
typedef struct {
  double direction[2], near, far;
  int32_t end;
} ray;

static void shocks_put(workspace *r, int64_t i, const double direction[2], double distance) {
  for (int c = 0; c < 2; c++) r->start[2 * i + c] = r->problem->from[c] + distance * direction[c];
}

static void shocks_follow(workspace *r, int64_t n) {
  r->problem->ends(r->problem->context, n, r->start, r->end);
}

/* Narrows the bracket of each of n rays to its first change on `points` inner points; false for a ray whose bracket
 * shows none. The far end of a bracket counts as another end only where `sure`. */
static void shocks_narrow(workspace *r, int n, ray *rays, int points, bool sure, bool *crossed) {
  for (int i = 0; i < n; i++)
    for (int j = 1; j <= points; j++)
      shocks_put(r, (int64_t)i * points + j - 1, rays[i].direction,
                 rays[i].near + (rays[i].far - rays[i].near) * j / (points + sure));
  shocks_follow(r, (int64_t)n * points);
  for (int i = 0; i < n; i++) {
    const double near = rays[i].near, width = rays[i].far - near;
    const kz_label *end = r->end + (int64_t)i * points;
    int j = 1;
    while (j <= points && end[j - 1].label == r->problem->own) j++;
    crossed[i] = j <= points || sure;
    if (!crossed[i]) continue;
    rays[i].near = near + width * (j - 1) / (points + sure);
    if (j > points) continue;
    rays[i].far = near + width * j / (points + sure);
    rays[i].end = end[j - 1].label;
  }
}

/* Bisects the brackets of rays that cross. */
static void shocks_bisect(workspace *r, int n, ray *rays) {
  bool crossed[2 * FAN + 1];
  bool open = true;
  for (int round = 0; open && round < PASSES; round++) {
    shocks_narrow(r, n, rays, r->look.pieces - 1, true, crossed);
    open = false;
    for (int i = 0; i < n; i++) open = open || rays[i].far - rays[i].near > r->look.narrow * rays[i].far;
  }
}

/* The nearest change along a direction and its opposite between `near` and *far on `points` points of each: it becomes
 * *far. False where none shows. */
static bool nearest_of_line(workspace *r, const double direction[2], double near, int points, double *far,
                            kz_shock *shock) {
  ray rays[2] = {{{direction[0], direction[1]}, near, *far, -1}, {{-direction[0], -direction[1]}, near, *far, -1}};
  bool crossed[2];
  shocks_narrow(r, 2, rays, points, false, crossed);
  const int best = !crossed[0] || (crossed[1] && rays[1].far < rays[0].far);
  if (!crossed[best]) return false;
  shocks_bisect(r, 1, rays + best);
  const ray *found = rays + best;
  if (found->far > *far * (1 - r->look.closed) && shock->end >= 0) return false; /* the one that is known */
  *far = found->far;
  *shock = (kz_shock){found->direction[0] * *far, found->direction[1] * *far, *far, found->end};
  return true;
}

/* A change nearer than *far: by six times as many points a side in the last RIM of the way, in ever shorter ends. */
static bool nearest_of_rims(workspace *r, const double direction[2], double *far, kz_shock *shock) {
  double rim = RIM;
  for (int i = 0; i < r->look.rims; i++, rim *= RIM)
    if (nearest_of_line(r, direction, *far * (1 - rim), (i == 0 ? 6 : 1) * r->look.line, far, shock)) return true;
  return false;
}

/* The smallest shock along a direction and its opposite, up to `farthest`. Each one that is found bounds the next
 * search, of look.line points on each side; where it finds none, of the rims. */
static kz_shock along_line(workspace *r, double theta, double velocity, double farthest) {
  const double direction[2] = {theta, velocity};
  kz_shock shock = {NAN, NAN, NAN, -1};
  double far = farthest;
  for (int find = 0; find < FINDS; find++)
    if (!nearest_of_line(r, direction, 0, r->look.line, &far, &shock) &&
        (isnan(shock.size) || !nearest_of_rims(r, direction, &far, &shock)))
      break;
  return shock;
}

static ray ray_at(const kz_shock_problem *problem, double angle, double near, double far) {
  return (ray){{cos(angle), problem->scale * sin(angle)}, near, far, -1};
}

/* The nearest point of the rings between two radii with another end: its distance, and its angle. None: infinite. */
static double nearest_of_rings(workspace *r, double inner, double outer, double *angle) {
  const int rings = r->look.rings, rays = r->look.rays;
  const double width = (outer - inner) / rings;
  double nearest = INFINITY;
  for (int i = 0; i < rays; i++) {
    const ray one = ray_at(r->problem, 2 * M_PI * i / rays, 0, 0);
    for (int ring = 0; ring < rings; ring++)
      shocks_put(r, (int64_t)i * rings + ring, one.direction, outer - width * (rings - 1 - ring));
  }
  shocks_follow(r, (int64_t)rings * rays);
  for (int i = 0; i < rays; i++) {
    const kz_label *end = r->end + (int64_t)i * rings;
    int ring = 0;
    while (ring < rings && end[ring].label == r->problem->own) ring++;
    if (ring == rings) continue;
    const double distance = outer - width * (rings - 1 - ring);
    if (distance < nearest) *angle = 2 * M_PI * i / rays;
    nearest = fmin(nearest, distance);
  }
  return nearest;
}

/* The distance of the boundary near a ray that crosses it, minimised by ever narrower fans of rays. */
static kz_shock shocks_slide(workspace *r, double angle, double far) {
  const int fan = r->look.fan;
  double width = 2 * M_PI / r->look.rays;
  kz_shock best = {.size = INFINITY, .end = -1};
  for (double reach = 0.1; width > r->look.closed; width /= fan / 4.0, reach = fmax(reach / 8, 1e-9)) {
    ray rays[2 * FAN + 1];
    bool crossed[2 * FAN + 1];
    double at[2 * FAN + 1];
    int n = 0;
    for (int i = 0; i <= 2 * fan; i++) {
      at[i] = angle + width * (i - fan) / fan;
      rays[i] = ray_at(r->problem, at[i], far * (1 - reach), far * (1 + reach / 16));
    }
    shocks_narrow(r, 2 * fan + 1, rays, 4 * r->look.pieces, false, crossed);
    for (int i = 0; i <= 2 * fan; i++) {
      if (!crossed[i]) continue;
      at[n] = at[i];
      rays[n++] = rays[i];
    }
    if (n == 0) break;
    shocks_bisect(r, n, rays);
    for (int i = 0; i < n; i++) {
      if (!(rays[i].far < best.size)) continue;
      best =
          (kz_shock){rays[i].direction[0] * rays[i].far, rays[i].direction[1] * rays[i].far, rays[i].far, rays[i].end};
      angle = at[i];
    }
    far = best.size;
  }
  return best;
}

/* Discs about the motion, each as large as the nearest boundary that the one before has shown; where a disc shows none,
 * its outermost ring is looked at more closely, because the tongues of other basins that lie along a boundary are thin.
 */
static kz_shock in_disc(workspace *r, const kz_shock *first) {
  kz_shock best = *first;
  for (int pass = 0; pass < PASSES; pass++) {
    double angle = 0;
    const double radius = best.size * (1 - 1e-9);
    double distance = nearest_of_rings(r, 0, radius, &angle);
    if (!isfinite(distance)) distance = nearest_of_rings(r, radius * (1 - 1.0 / r->look.rings), radius, &angle);
    if (!isfinite(distance)) break;
    const kz_shock found = shocks_slide(r, angle, distance);
    if (found.size < best.size) best = found;
  }
  return best;
}

/* A shock of one coordinate in the norm of both. */
static kz_shock in_norm(const kz_shock *shock, double scale) {
  kz_shock same = *shock;
  same.size = hypot(shock->theta, shock->velocity / scale);
  return same;
}

/* Memory for the grids of a search: the largest of a disc, the rims of a line, a fan, the spread shocks. */
static void shocks_make(const kz_shock_problem *problem, workspace *r) {
  r->problem = problem;
  r->look = look_for(problem->tolerance);
  int most = r->look.rings * r->look.rays;
  if (most < 12 * r->look.line) most = 12 * r->look.line;
  if (most < (2 * r->look.fan + 1) * 4 * r->look.pieces) most = (2 * r->look.fan + 1) * 4 * r->look.pieces;
  if (most < SPREAD) most = SPREAD;
  r->start = kz_malloc(2 * (size_t)most * sizeof *r->start);
  r->end = kz_malloc((size_t)most * sizeof *r->end);
}

static void shocks_release(workspace *r) {
  kz_free_local(&r->start);
  kz_free_local(&r->end);
}

void kz_shocks_find(const kz_shock_problem *problem, kz_shock shock[3]) {
  KZ_AUTOFREE_BY(shocks_release) workspace r;
  shocks_make(problem, &r);
  shock[0] = along_line(&r, 1, 0, M_PI);
  if (shock[0].end == 0 && !(shock[0].size < M_PI))
    shock[0] = (kz_shock){NAN, NAN, NAN, -1}; /* the other rest, which only this very start stays on */
  shock[1] = along_line(&r, 0, 1, problem->farthest);
  const kz_shock angle = in_norm(shock, problem->scale), velocity = in_norm(shock + 1, problem->scale);
  shock[2] = isless(velocity.size, angle.size) || isnan(angle.size) ? velocity : angle;
  if (!isnan(shock[2].size)) {
    const double at = atan2(shock[2].velocity / problem->scale, shock[2].theta);
    const kz_shock near = shocks_slide(&r, at, shock[2].size);
    if (near.size < shock[2].size) shock[2] = near;
    shock[2] = in_disc(&r, shock + 2);
  }
}

void kz_shocks_nearer(const kz_shock_problem *problem, kz_shock *shock) {
  KZ_AUTOFREE_BY(shocks_release) workspace r;
  shocks_make(problem, &r);
  *shock = in_disc(&r, shock);
}

void kz_shocks_harmless(const kz_shock_problem *problem, double size, kz_harmless *harmless) {
  static const double GOLDEN = 0.61803398874989484820;
  KZ_AUTOFREE_BY(shocks_release) workspace r;
  double time = 0;
  shocks_make(problem, &r);
  *harmless = (kz_harmless){.shocks = SPREAD};
  for (int i = 0; i < SPREAD; i++)
    shocks_put(&r, i, ray_at(problem, 2 * M_PI * GOLDEN * i, 0, 0).direction, size * sqrt((i + 0.5) / SPREAD));
  shocks_follow(&r, SPREAD);
  for (int i = 0; i < SPREAD; i++) {
    if (r.end[i].label != problem->own) continue;
    harmless->harmless++;
    time += (double)r.end[i].periods;
  }
  harmless->return_time = harmless->harmless > 0 ? time / (double)harmless->harmless : NAN;
}
