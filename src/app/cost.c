/* Compares a scene's memory with what this node has, and control groups (container, batch system) leave. */
#include <limits.h>
#include <unistd.h>

#include "app.h"

/* Bytes that each rank needs for the program, MPI and HDF5, whatever the scene. */
static const double PROCESS_BYTES = 3.7e7;

kz_cost kz_cost_of(const kz_scene *scene) {
  kz_cost total = {0};
  for (int i = 0; i < kz_study_count; i++) {
    if (!kz_studies[i]->cost || !kz_study_is_wanted(kz_studies[i], scene)) continue;
    const kz_cost cost = kz_studies[i]->cost(scene);
    total.cells += cost.cells;
    total.disk_bytes += cost.disk_bytes;
    total.memory_bytes = fmax(total.memory_bytes, cost.memory_bytes);
    total.rank0_bytes = fmax(total.rank0_bytes, cost.rank0_bytes);
    total.shared_bytes = fmax(total.shared_bytes, cost.shared_bytes);
  }
  total.memory_bytes += PROCESS_BYTES;
  return total;
}

/* The one number in a file; infinity where there is none ("max"). */
static double read_number(const char *path) {
  double bytes = INFINITY;
  FILE *file = fopen(path, "r");
  if (!file) return INFINITY;
  if (fscanf(file, "%lf", &bytes) != 1) bytes = INFINITY;
  fclose(file);
  return bytes;
}

/* The lowest limit of a group and of those that it is in. A container may see its own group as the root: levels that
 * are not there have no limit of their own. */
static double cost_lowest(const char *mount, char *group, const char *name) {
  double bytes = INFINITY;
  char path[2 * PATH_MAX];
  for (;;) {
    snprintf(path, sizeof path, "%s%s/%s", mount, group, name);
    bytes = fmin(bytes, read_number(path));
    char *slash = strrchr(group, '/');
    if (!slash) return bytes;
    *slash = '\0';
  }
}

double kz_memory_limit(const char *groups, const char *mount) {
  double bytes = INFINITY;
  char line[PATH_MAX], root[PATH_MAX];
  FILE *file = fopen(groups, "r");
  while (file && fgets(line, sizeof line, file)) {
    char *kind = strchr(line, ':'), *group = kind ? strchr(kind + 1, ':') : NULL;
    if (!group) continue;
    *group++ = '\0';
    group[strcspn(group, "\n")] = '\0';
    snprintf(root, sizeof root, "%s/memory", mount);
    if (strcmp(kind + 1, "") == 0)
      bytes = fmin(bytes, cost_lowest(mount, group, "memory.max"));
    else if (strcmp(kind + 1, "memory") == 0)
      bytes = fmin(bytes, cost_lowest(root, group, "memory.limit_in_bytes"));
  }
  if (file) fclose(file);
  return bytes;
}

static double node_memory(void) {
  const double physical = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
  return fmin(physical, kz_memory_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
}

kz_short_text kz_cost_bytes(double bytes) {
  static const char *const units[] = {"B", "kB", "MB", "GB", "TB", "PB"};
  kz_short_text size;
  int i = 0;
  for (; bytes >= 1000.0 && i < 5; i++) bytes /= 1000.0;
  snprintf(size.text, sizeof size.text, i == 0 ? "%.0f %s" : "%.1f %s", bytes, units[i]);
  return size;
}

kz_status kz_cost_check(const kz_cost *cost, kz_ranks *ranks) {
  const bool first = !ranks || kz_rank(ranks) == 0;
  const double share = cost->shared_bytes / (ranks ? kz_ranks_count(ranks) : 1);
  const double mine = cost->memory_bytes + share + (first ? cost->rank0_bytes : 0), memory = node_memory();
  double sum = mine;
  int node_ranks = 1;
  if (ranks) KZ_TRY(kz_ranks_node(ranks, mine, &sum, &node_ranks));
  if (sum > memory)
    return kz_fail(
        KZ_REFUSED,
        "scene: needs %s of memory for %d ranks on this node, which has %s; use smaller counts or fewer ranks",
        kz_cost_bytes(sum).text, node_ranks, kz_cost_bytes(memory).text);
  if (kz_memory_is_there((size_t)mine)) return KZ_OK; /* no limit of this process (ulimit, batch systems) bites */
  return kz_fail(KZ_REFUSED,
                 "scene: needs %s of memory, more than a limit (ulimit -v) leaves a process; use smaller counts",
                 kz_cost_bytes(mine).text);
}
