/* The smallest shocks that leave the basins: the file's group /shocks, and its part of the summary. */
#include "basin/basin.h"
#include "resilience.h"

enum { KINDS = 3 };

/* The id in the file of where a shock leads; -1 = nowhere known. */
static int32_t id_of(const kz_catalogue *catalogue, const kz_shock *shock) {
  return isnan(shock->size) || shock->end <= 0 ? -1 : catalogue->id_of[shock->end];
}

static kz_status write_points(const kz_catalogue *catalogue, int64_t n, const kz_resilience *p, kz_store *store) {
#define COLUMN(type, name, expression) KZ_COLUMN(store, "shocks", name, n, type, expression)
  COLUMN(int32_t, "attractor", catalogue->id_of[p[i].number]);
  COLUMN(int32_t, "phase", p[i].phase);
  COLUMN(double, "strobe_theta", p[i].theta);
  COLUMN(double, "strobe_velocity", p[i].velocity);
  COLUMN(double, "angle", p[i].shock[0].theta);
  COLUMN(int32_t, "angle_end", id_of(catalogue, p[i].shock));
  COLUMN(double, "kick", p[i].shock[1].velocity);
  COLUMN(int32_t, "kick_end", id_of(catalogue, p[i].shock + 1));
  COLUMN(double, "shock_theta", p[i].shock[2].theta);
  COLUMN(double, "shock_velocity", p[i].shock[2].velocity);
  COLUMN(double, "shock_size", p[i].shock[2].size);
  COLUMN(int32_t, "shock_end", id_of(catalogue, p[i].shock + 2));
  return KZ_OK;
}

static kz_status write_harmless(const kz_resilience_plan *plan, int64_t n, const kz_resilience *p, kz_store *store) {
  const int64_t sizes = plan->sizes.count, all = n * sizes;
#define HARMLESS(name, expression) KZ_COLUMN(store, "shocks", name, all, double, expression)
  HARMLESS("harmless",
           (double)p[i / sizes].harmless[i % sizes].harmless / (double)p[i / sizes].harmless[i % sizes].shocks);
  HARMLESS("return_time", p[i / sizes].harmless[i % sizes].return_time);
  return KZ_OK;
}

/* Prints the smallest of each kind over an attractor's strobe points; `speed`: unit of velocity in the summary. */
static void print_attractor(const kz_catalogue *catalogue, int64_t number, int64_t n, const kz_resilience *p,
                            double speed, FILE *summary) {
  const kz_shock *least[KINDS] = {0};
  for (int64_t i = 0; i < n; i++)
    for (int kind = 0; p[i].number == number && kind < KINDS; kind++)
      if (!isnan(p[i].shock[kind].size) && (!least[kind] || p[i].shock[kind].size < least[kind]->size))
        least[kind] = p[i].shock + kind;
  fprintf(summary, "%4d ", (int)catalogue->id_of[number]);
  for (int kind = 0; kind < KINDS; kind++) {
    if (least[kind])
      fprintf(summary, " %12.8f -> %-3d", least[kind]->size * (kind == 1 ? speed : 1),
              (int)id_of(catalogue, least[kind]));
    else
      fprintf(summary, "            none   ");
  }
  fprintf(summary, "\n");
}

/* `omega`: of the pivot, rad/s, in which the summary is then; NaN where the scene is not in SI units. */
static kz_status write_shocks(const kz_resilience_plan *plan, const kz_catalogue *catalogue, int64_t n,
                              const kz_resilience *point, double omega, kz_store *store, FILE *summary) {
  const char *unit = "rad per drive radian";
  const double speed = kz_si_factor(omega, &unit);
  KZ_TRY(kz_store_dimension(store, "shocks", "point", n, NULL));
  KZ_TRY(kz_store_dimension(store, "shocks", "size", plan->sizes.count, plan->sizes.values));
  KZ_TRY(kz_store_real(store, "shocks", "scale", plan->scale));
  KZ_TRY(write_points(catalogue, n, point, store));
  KZ_TRY(write_harmless(plan, n, point, store));
  fprintf(summary,
          "smallest shocks that leave the basin, and the id where they lead:\n"
          "  id      angle, rad       velocity, %-14s  both (scale %g%s)\n",
          isnan(omega) ? "rad/drive rad" : unit, plan->scale * speed, isnan(omega) ? "" : " rad/s");
  for (int64_t i = 0; i < n; i++)
    if (point[i].phase == 0) print_attractor(catalogue, point[i].number, n, point, speed, summary);
  return KZ_OK;
}

static kz_status shocks_find(void *own, const kz_chunks *chunks, kz_store *store, FILE *summary) {
  const kz_scene *scene = own;
  const kz_window_labels *labelling = chunks->labelling;
  const kz_resilience_plan asked = {.scale = scene->shocks->scale,
                                    .farthest = 2 * kz_axis_fastest(&scene->basin->velocity),
                                    .sizes = scene->shocks->sizes,
                                    .max_periods = scene->basin->max_periods};
  int64_t n;
  KZ_AUTOFREE kz_resilience *point = kz_resilience_list(labelling->dynamics, chunks->catalogue, &n);
  kz_status status = kz_resilience_run(labelling->run, labelling->dynamics, &asked, n, point);
  if (status == KZ_OK && store)
    status = write_shocks(&asked, chunks->catalogue, n, point, scene->parameters.pivot_frequency, store, summary);
  return kz_ranks_agree(labelling->run->ranks, status);
}

const kz_basin_part kz_shocks_part = {.find = shocks_find};
