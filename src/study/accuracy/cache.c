/* Reference labels in a text file beside the result: a line with what they depend on, one line per cell, a checksum. */
#include <fcntl.h>
#include <inttypes.h>
#include <unistd.h>

#include "reference.h"
#include "kapitza/study_basin.h"

enum { KEY_LENGTH = 512 + 4 * KZ_DECIMAL_LENGTH };

/* FNV-1a of 64 bits (Fowler, Noll & Vo). */
static uint64_t cache_checksum(const void *data, size_t bytes, uint64_t sum) {
  for (size_t i = 0; i < bytes; i++) sum = (sum ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
  return sum;
}

/* The key of the cache: everything that the labels depend on, in one line. */
static void print_key(const kz_reference_labels *reference, char *key, size_t bytes) {
  const kz_basin_plan *p = reference->plan;
  uint64_t attractors =
      cache_checksum(reference->packed, (size_t)reference->packed_size * sizeof(double), 0xcbf29ce484222325u);
  if (!kz_is_sine(&reference->pendulum)) {
    attractors = cache_checksum(reference->pendulum.vertical, sizeof reference->pendulum.vertical, attractors);
    attractors = cache_checksum(reference->pendulum.horizontal, sizeof reference->pendulum.horizontal, attractors);
    attractors = cache_checksum(&reference->pendulum.torque, sizeof reference->pendulum.torque, attractors);
    attractors =
        cache_checksum(&reference->pendulum.torque_amplitude, sizeof reference->pendulum.torque_amplitude, attractors);
  }
  snprintf(key, bytes, KZ_REFERENCE_WORDS " 1: %a %a %a; %a %a %lld%s%s; %a %a %lld%s%s; %lld %lld; %016llx\n",
           reference->pendulum.k, reference->pendulum.beta, reference->pendulum.m, p->theta.min, p->theta.max,
           (long long)p->theta.count, p->theta.centre.text, p->theta.width.text, p->velocity.min, p->velocity.max,
           (long long)p->velocity.count, p->velocity.centre.text, p->velocity.width.text, (long long)p->seed,
           (long long)p->max_periods, (unsigned long long)attractors);
}

/* The whole file as text, which the caller frees; NULL if it cannot be read. */
static char *read_all(const char *path) {
  FILE *in = fopen(path, "r");
  char *text = NULL;
  long length = -1;
  if (in && fseek(in, 0, SEEK_END) == 0) length = ftell(in);
  if (length >= 0 && fseek(in, 0, SEEK_SET) == 0) text = kz_calloc(1, (size_t)length + 1);
  if (text && fread(text, 1, (size_t)length, in) != (size_t)length) {
    free(text);
    text = NULL;
  }
  if (in) fclose(in);
  return text;
}

/* The lines between the key and the checksum's line, or NULL where either is not what it should be. */
static char *cache_verified(char *text, const char *key) {
  char *last = strstr(text, "checksum ");
  unsigned long long sum;
  if (strncmp(text, key, strlen(key)) != 0 || !last || sscanf(last, "checksum %16llx", &sum) != 1) return NULL;
  return cache_checksum(text, (size_t)(last - text), 0xcbf29ce484222325u) == sum ? text + strlen(key) : NULL;
}

int64_t kz_reference_labels_recall(const char *path, kz_reference_labels *reference) {
  char key[KEY_LENGTH];
  print_key(reference, key, sizeof key);
  char *text = read_all(path), *line = text ? cache_verified(text, key) : NULL;
  int64_t n = 0;
  for (; line && n < reference->samples; n++) {
    kz_reference_label *v = reference->labels + n;
    if (sscanf(line, "%hd %hd %hhu %hhu %" SCNd64, &v->end.label, &v->flipped, &v->distance, &v->agrees,
               &v->end.periods) != 5)
      break;
    line = strchr(line, '\n') + 1;
  }
  free(text);
  return n;
}

/* Whether the file holds as many labels for this key. */
static bool is_held(const kz_reference_labels *reference, const char *path) {
  kz_reference_labels held = *reference;
  held.labels = kz_malloc((size_t)held.samples * sizeof *held.labels + 1);
  const int64_t n = kz_reference_labels_recall(path, &held);
  free(held.labels);
  return n == held.samples;
}

static kz_status cannot_write(const char *path) {
  return kz_fail(KZ_FAILED, "%s: cannot be written", path);
}

/* Creates a file of this process alone. It does not write into a link or into a file that a killed run has left. */
static FILE *cache_create(const char *path) {
  unlink(path);
  const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  FILE *out = file < 0 ? NULL : fdopen(file, "w");
  if (file >= 0 && !out) close(file);
  return out;
}

/* Writes `text` beside `path` and renames it. */
static kz_status write_all(const char *path, const char *text) {
  char part[4200];
  if (snprintf(part, sizeof part, "%s.part", path) >= (int)sizeof part) return cannot_write(path);
  FILE *out = cache_create(part);
  if (!out) return cannot_write(path);
  bool written = fputs(text, out) >= 0 && fflush(out) == 0 && fsync(fileno(out)) == 0;
  written = fclose(out) == 0 && written && rename(part, path) == 0;
  if (written) return KZ_OK;
  unlink(part);
  return cannot_write(path);
}

kz_status kz_reference_labels_save(const kz_reference_labels *reference, const char *path) {
  char key[KEY_LENGTH], *text = NULL;
  size_t bytes = 0;
  print_key(reference, key, sizeof key);
  if (is_held(reference, path)) return KZ_OK;
  FILE *out = open_memstream(&text, &bytes);
  if (!out) return kz_fail(KZ_FAILED, "no memory for %s", path);
  fputs(key, out);
  for (int64_t i = 0; i < reference->samples; i++) {
    const kz_reference_label *v = reference->labels + i;
    fprintf(out, "%d %d %d %d %" PRId64 "\n", v->end.label, v->flipped, v->distance, v->agrees, v->end.periods);
  }
  fflush(out);
  const uint64_t sum = cache_checksum(text, bytes, 0xcbf29ce484222325u);
  fprintf(out, "checksum %016llx\n", (unsigned long long)sum);
  kz_status status = fclose(out) == 0 ? write_all(path, text) : kz_fail(KZ_FAILED, "no memory for %s", path);
  free(text);
  return status;
}
