/* What a scene costs, against what this node has. */
#include <stdlib.h>
#include <unistd.h>

#include "kapitza/app.h"

/* What a rank of any scene takes: the program, MPI, HDF5. */
static const double PROCESS_BYTES = 5e7;

kz_cost kz_cost_of(const kz_scene *scene) {
  kz_cost total = {0};
  for (int i = 0; i < kz_study_count; i++) {
    if (!kz_studies[i].wanted(scene)) continue;
    const kz_cost cost = kz_studies[i].cost(scene);
    total.cells += cost.cells;
    total.disk_bytes += cost.disk_bytes;
    total.core_seconds += cost.core_seconds;
    if (cost.memory_bytes > total.memory_bytes) total.memory_bytes = cost.memory_bytes;
  }
  total.memory_bytes += PROCESS_BYTES;
  return total;
}

/* The limit of the control group that a container or a batch system sets; 0 = none. */
static double group_limit(void) {
  static const char *const names[] = {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"};
  for (int i = 0; i < 2; i++) {
    double bytes = 0.0;
    FILE *file = fopen(names[i], "r");
    if (!file) continue;
    const bool found = fscanf(file, "%lf", &bytes) == 1;
    fclose(file);
    if (found) return bytes;
  }
  return 0.0;
}

static double node_memory(void) {
  const double physical = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
  const double limit = group_limit();
  return limit > 0.0 && limit < physical ? limit : physical;
}

/* Ranks that share this node. */
static int local_ranks(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_NTASKS_PER_NODE"};
  for (int i = 0; i < 3; i++) {
    const char *value = getenv(names[i]);
    if (value && atoi(value) > 0) return atoi(value);
  }
  return 1;
}

void kz_cost_print_bytes(double bytes, char *text) {
  static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  int i = 0;
  for (; bytes >= 1000.0 && i < 5; i++) bytes /= 1000.0;
  snprintf(text, 32, i == 0 ? "%.0f %s" : "%.1f %s", bytes, units[i]);
}

/* Asks for the memory at once and gives it back: limits of this process (ulimit, batch systems) answer before modelling. */
static bool may_have(double bytes) {
  void *volatile memory = malloc((size_t)bytes);
  free(memory);
  return memory != NULL;
}

kz_status kz_cost_check(const kz_cost *cost) {
  const int ranks = local_ranks();
  const double memory = node_memory();
  char needed[32], there[32];
  kz_cost_print_bytes(cost->memory_bytes, needed);
  if (cost->memory_bytes * ranks <= memory) {
    if (may_have(cost->memory_bytes)) return KZ_OK;
    return kz_fail(KZ_REFUSED, "scene: needs %s of memory, more than a limit (ulimit -v) leaves a process; smaller counts",
                   needed);
  }
  kz_cost_print_bytes(memory, there);
  return kz_fail(KZ_REFUSED,
                 "scene: needs %s of memory in each of %d ranks on this node, which has %s; smaller counts or fewer ranks",
                 needed, ranks, there);
}
