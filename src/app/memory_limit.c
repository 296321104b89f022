/* The memory that control groups leave to this process: a container, a batch system. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "app.h"

/* The one number in a file; infinity where there is none ("max"). */
static double read_number(const char *path) {
  double bytes = INFINITY;
  FILE *file = fopen(path, "r");
  if (!file) return INFINITY;
  if (fscanf(file, "%lf", &bytes) != 1) bytes = INFINITY;
  fclose(file);
  return bytes;
}

/* The lowest limit of a group and of those that it is in. A container may see its own group as the root: levels that are not
 * there have no limit of their own. */
static double lowest(const char *mount, char *group, const char *name) {
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
      bytes = fmin(bytes, lowest(mount, group, "memory.max"));
    else if (strcmp(kind + 1, "memory") == 0)
      bytes = fmin(bytes, lowest(root, group, "memory.limit_in_bytes"));
  }
  if (file) fclose(file);
  return bytes;
}
