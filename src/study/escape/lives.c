/* From paths to lives: mirror images, ways out of each attractor, islands. */
#include "report.h"

/* rad: distance from a saddle at which the side of a path is seen, and that of the states that are released. */
static const double SEEN = 1e-8, RELEASED = 1e-5;
/* Relative difference of the actions of mirror images that agree. */
static const double AGREES = 1e-9;

void kz_escape_beyond(const kz_escape_route *route, const kz_gate *gate, double before[2], double beyond[2]) {
  const kz_path *path = &route->least;
  double away = 0;
  for (int64_t t = path->n, turn = 0; t >= 0 && isfinite(path->action); t -= gate->period, turn += gate->winding) {
    const double x = route->node[4 * t] - gate->state[0] - 2 * M_PI * (path->turns[1] - (double)turn);
    const double v = route->node[4 * t + 1] - gate->state[1];
    away = x * gate->stable[1] - v * gate->stable[0];
    if (hypot(x, v) > SEEN) break;
  }
  const double own = gate->away[0] * gate->stable[1] - gate->away[1] * gate->stable[0];
  const double side = away * own < 0 ? -RELEASED : RELEASED;
  for (int c = 0; c < 2; c++) {
    before[c] = gate->state[c] + side * gate->away[c];
    beyond[c] = gate->state[c] - side * gate->away[c];
  }
}

static int64_t find_task(const kz_escape_report *r, int32_t from, int32_t saddle) {
  for (int64_t i = 0; i < r->n; i++)
    if (r->task[i].from == from && r->task[i].saddle == saddle) return i;
  return -1;
}

/* The route becomes the mirror image of another one. */
static void lives_reflect(const kz_escape_report *r, int64_t of, int64_t to) {
  const kz_escape_route *route = r->route + of;
  kz_escape_route *image = r->route + to;
  *image = *route;
  for (int64_t i = 0; i < 4 * (route->least.n + 1); i++) image->node[i] = -route->node[i];
  const int32_t into = r->task[of].into, before = r->task[of].before;
  r->task[to].into = into < 0 ? -1 : (int32_t)r->attractors->mirror[into];
  r->task[to].before = before < 0 ? -1 : (int32_t)r->attractors->mirror[before];
}

void kz_escape_pair(const kz_escape_report *r) {
  const bool mirrored = kz_is_mirrored(&r->scene->parameters.pendulum);
  for (int64_t i = 0; i < r->n; i++) {
    kz_escape_task *task = r->task + i;
    const int64_t j =
        mirrored ? find_task(r, (int32_t)r->attractors->mirror[task->from], (int32_t)r->saddles->mirror[task->saddle])
                 : -1;
    if (j == i || j < 0) task->agrees = true;
    if (j <= i) continue;
    const double a = r->route[i].least.action, b = r->route[j].least.action;
    task->agrees = r->task[j].agrees =
        task->reflected || r->task[j].reflected || (isinf(a) && isinf(b)) || fabs(a - b) <= AGREES * fabs(a);
    if (b < a) lives_reflect(r, j, i);
    if (a < b) lives_reflect(r, i, j);
  }
}

int64_t kz_escape_into(const kz_escape_report *r, int32_t from, int32_t into) {
  const uint64_t alone = kz_gates_alone(r->saddles->count, r->gate);
  int64_t best = -1;
  for (int64_t i = 0; i < r->n; i++) {
    const double action = r->route[i].least.action;
    const kz_gate *gate = r->gate + r->task[i].saddle;
    if (r->task[i].from != from || isinf(action)) continue;
    if (!kz_gate_is_of(gate, into, alone) && !(gate->meets >> into & 1)) continue;
    if (best < 0 || action < r->route[best].least.action) best = i;
  }
  return best;
}

/* The least way out of `from` through a gate that leads to `into`, or to anything else than that. */
static double least_out(const kz_escape_report *r, int32_t from, int32_t into, bool elsewhere) {
  double least = INFINITY;
  for (int64_t i = 0; i < r->n; i++) {
    const kz_escape_task *task = r->task + i;
    if (task->from == from && task->is_gate && (task->into == into) != elsewhere)
      least = fmin(least, r->route[i].least.action);
  }
  return least;
}

/* Exponent of the mean life on a way through a gate: an island C is an attractor from which the way back costs less
 * than the way there. It adds max(0, R(C, out) - R(C, back)). */
static double life_through(const kz_escape_report *r, int64_t i, bool *island) {
  const kz_escape_task *task = r->task + i;
  const double there = r->route[i].least.action, back = least_out(r, task->into, task->from, false);
  *island = task->into >= 0 && back < there;
  if (!*island) return there;
  return there + fmax(0, least_out(r, task->into, task->from, true) - back);
}

void kz_escape_lives(const kz_escape_report *r, kz_escape_life *life) {
  for (int64_t a = 0; a < r->attractors->count; a++) {
    life[a] = (kz_escape_life){-1, INFINITY, -1};
    for (int64_t i = 0; i < r->n; i++) {
      const kz_escape_task *task = r->task + i;
      if (task->from != (int32_t)a || !task->is_gate || isinf(r->route[i].least.action)) continue;
      if (life[a].way < 0 || r->route[i].least.action < r->route[life[a].way].least.action) life[a].way = i;
      bool island;
      const double exponent = life_through(r, i, &island);
      if (exponent >= life[a].life) continue;
      life[a].life = exponent;
      life[a].through = island ? task->into : -1;
    }
  }
}
