/* The group escape of the file, and the lines for people. */
#include "report.h"

/* Paths that the file shows point by point, and their points. */
typedef struct {
  const kz_escape_report *of;
  int64_t count, n;
  int64_t *route;     /* [count] */
  double (*point)[5]; /* [n] time in drive periods, theta, velocity, torque, place in `route` */
} shown_paths;

#define COLUMN(type, name, n, expression) KZ_COLUMN(store, "escape", name, n, type, expression)

static kz_status write_routes(const kz_escape_report *r, kz_store *store) {
  const kz_escape_task *task = r->task;
  const kz_escape_route *route = r->route;
  const int64_t n = r->n, families = n * KZ_ESCAPE_FAMILIES;
  KZ_TRY(kz_store_dimension(store, "escape", "route", n, NULL));
  KZ_TRY(kz_store_dimension(store, "escape", "family", KZ_ESCAPE_FAMILIES, NULL));
  COLUMN(int32_t, "from", n, task[i].from);
  COLUMN(int32_t, "saddle", n, task[i].saddle);
  COLUMN(int8_t, "is_gate", n, task[i].is_gate);
  COLUMN(int32_t, "before", n, task[i].before);
  COLUMN(int32_t, "into", n, task[i].into);
  COLUMN(double, "barrier", n, isinf(route[i].least.action) ? NAN : route[i].least.action);
  COLUMN(double, "barrier_by_k", n, route[i].least.slope[0]);
  COLUMN(double, "barrier_by_m", n, route[i].least.slope[1]);
  COLUMN(double, "barrier_by_beta", n, route[i].least.slope[2]);
  COLUMN(double, "largest_torque", n, route[i].largest_torque);
  COLUMN(int32_t, "periods", n, route[i].least.n);
  COLUMN(int32_t, "starts", n, route[i].starts);
  COLUMN(int8_t, "agrees", n, task[i].agrees);
#define OF_FAMILY(member, none)                                       \
  (i % KZ_ESCAPE_FAMILIES < route[i / KZ_ESCAPE_FAMILIES].count       \
       ? route[i / KZ_ESCAPE_FAMILIES].member[i % KZ_ESCAPE_FAMILIES] \
       : none)
  COLUMN(double, "family_barrier", families, OF_FAMILY(action, NAN));
  COLUMN(int32_t, "family_hits", families, OF_FAMILY(hits, 0));
  return KZ_OK;
}

static kz_status write_lives(const kz_escape_report *r, const kz_escape_life *life, kz_store *store) {
  const int64_t n = r->attractors->count;
  KZ_TRY(kz_store_dimension(store, "escape", "attractor", n, NULL));
  COLUMN(int32_t, "way_out", n, life[i].way);
  COLUMN(double, "barrier_out", n, life[i].way < 0 ? NAN : r->route[life[i].way].least.action);
  COLUMN(double, "life_exponent", n, isinf(life[i].life) ? NAN : life[i].life);
  COLUMN(int32_t, "island", n, life[i].through);
  if (!r->scene->escape->everywhere) return KZ_OK;
  KZ_TRY(kz_store_dimension(store, "escape", "target", n, NULL));
  KZ_AUTOFREE int64_t *into = kz_malloc((size_t)(n * n + 1) * sizeof *into);
  for (int64_t i = 0; i < n * n; i++)
    into[i] = i / n == i % n ? life[i / n].way : kz_escape_into(r, (int32_t)(i / n), (int32_t)(i % n));
  COLUMN(int32_t, "way_into", n *n, into[i]);
  COLUMN(double, "barrier_into", n *n, into[i] < 0 ? NAN : r->route[into[i]].least.action);
  return KZ_OK;
}

static void report_show(shown_paths *shown, int64_t route) {
  if (route < 0) return;
  for (int64_t i = 0; i < shown->count; i++)
    if (shown->route[i] == route) return;
  shown->route[shown->count++] = route;
}

/* The points of a path, from where it leaves the cycle of its start to its end. */
static void sample_path(const kz_escape_flow *flow, int64_t place, shown_paths *shown) {
  static const double LEAVES = 1e-3; /* share of the largest torque */
  const kz_escape_route *route = shown->of->route + shown->route[place];
  const double unit = 2 * flow->pendulum->beta, least = LEAVES * route->largest_torque;
  KZ_AUTOFREE double (*sample)[4] = kz_malloc((size_t)flow->samples * sizeof *sample);
  int64_t first = 0, last = route->least.n;
  while (first + 2 < last && unit * fabs(route->node[4 * first + 3]) < least) first++;
  while (last > first + 1 && unit * fabs(route->node[4 * last - 1]) < least) last--;
  for (int64_t t = first > 0 ? first - 1 : 0; t < last; t++) {
    kz_hamilton_sample(flow->flow, flow->samples, 1, route->node + 4 * t, sample[0]);
    for (int32_t i = 0; i < flow->samples; i++) {
      const double *z = i == 0 ? route->node + 4 * t : sample[i - 1];
      double *out = shown->point[shown->n++];
      out[0] = (double)t + (double)i / flow->samples;
      out[1] = z[0], out[2] = z[1], out[3] = unit * z[3], out[4] = (double)place;
    }
  }
}

static kz_status write_paths(const kz_escape_report *r, const kz_escape_life *life, kz_store *store) {
  const int64_t n = r->attractors->count;
  KZ_AUTOFREE int64_t *route = kz_malloc((size_t)(r->n + 1) * sizeof *route);
  shown_paths shown = {.of = r, .route = route};
  for (int64_t a = 0; a < n; a++) report_show(&shown, life[a].way);
  for (int64_t i = 0; r->scene->escape->everywhere && i < n * n; i++)
    if (i / n != i % n) report_show(&shown, kz_escape_into(r, (int32_t)(i / n), (int32_t)(i % n)));
  kz_escape_flow flow = kz_escape_flow_of(&r->scene->parameters.pendulum);
  int64_t most = 0;
  for (int64_t i = 0; i < shown.count; i++) most += r->route[shown.route[i]].least.n * flow.samples;
  KZ_AUTOFREE double (*point)[5] = kz_malloc((size_t)(most + 1) * sizeof *point);
  shown.point = point;
  for (int64_t i = 0; i < shown.count; i++) sample_path(&flow, i, &shown);
  kz_escape_flow_free(&flow);
  KZ_TRY(kz_store_dimension(store, "escape", "point", shown.n, NULL));
  COLUMN(int32_t, "path", shown.n, shown.route[(int64_t)point[i][4]]);
  COLUMN(double, "time", shown.n, point[i][0]);
  COLUMN(double, "theta", shown.n, point[i][1]);
  COLUMN(double, "velocity", shown.n, point[i][2]);
  COLUMN(double, "torque", shown.n, point[i][3]);
  return KZ_OK;
}

static void report_print(const kz_escape_report *r, const kz_escape_life *life, FILE *summary) {
  int64_t differ = 0, over = 0;
  fprintf(summary,
          "Ways out: the least action that was found, int u^2 / (4 beta) dt of the torque u; a mean life grows as "
          "exp(action / "
          "T).\n");
  fprintf(summary, "  from  through saddle  into        action  largest torque   found  exponent of life\n");
  for (int64_t a = 0; a < r->attractors->count; a++) {
    if (life[a].way < 0) continue;
    const kz_escape_task *task = r->task + life[a].way;
    const kz_escape_route *route = r->route + life[a].way;
    fprintf(summary, "%6lld  %14d  %4d  %12.10g  %14.6g  %3lld/%-3lld  %12.10g", (long long)a, task->saddle, task->into,
            route->least.action, route->largest_torque, (long long)(route->count > 0 ? route->hits[0] : 0),
            (long long)route->starts, life[a].life);
    if (life[a].through >= 0) fprintf(summary, ", by the island %d", life[a].through);
    fprintf(summary, "%s\n", task->before == task->from ? "" : "; the path goes over another basin");
  }
  for (int64_t i = 0; i < r->n; i++) {
    differ += !r->task[i].agrees;
    over += r->task[i].is_gate && isinf(r->route[i].least.action);
  }
  if (differ > 0)
    fprintf(
        summary,
        "%lld of %lld searches found less than their mirror images did, which then have the lesser action: give more "
        "escape.starts\n",
        (long long)differ, (long long)r->n);
  if (over > 0) fprintf(summary, "no path was found to %lld saddles on edges of basins\n", (long long)over);
  for (int64_t a = 0; a < r->attractors->count; a++)
    if (!(r->attractors->period[a] > 0))
      fprintf(summary, "attractor %lld is no cycle: ways out of it are not sought\n", (long long)a);
}

kz_status kz_escape_write(const kz_escape_report *r, kz_store *store, FILE *summary) {
  KZ_AUTOFREE kz_escape_life *life = kz_calloc((size_t)r->attractors->count + 1, sizeof *life);
  kz_escape_pair(r);
  kz_escape_lives(r, life);
  report_print(r, life, summary);
  KZ_TRY(write_routes(r, store));
  KZ_TRY(write_lives(r, life, store));
  return write_paths(r, life, store);
}
