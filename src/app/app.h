/* app: the command line, what its commands do, and messages for people (C; layer 4). */
#ifndef KAPITZA_APP_APP_H
#define KAPITZA_APP_APP_H

#include <stdbool.h>
#include <stdio.h>

#include "kapitza/study_where.h"
#include "scene.h"

/* Instruction sets that this build uses, as bits; the program's entry refuses a CPU that lacks one of them. */
#define KZ_INSTRUCTION_LIST(X) \
  X(SSE3, 0, "sse3")           \
  X(SSSE3, 1, "ssse3")         \
  X(SSE4_1, 2, "sse4.1")       \
  X(SSE4_2, 3, "sse4.2")       \
  X(POPCNT, 4, "popcnt")       \
  X(AVX, 5, "avx")             \
  X(AVX2, 6, "avx2")           \
  X(FMA, 7, "fma")             \
  X(BMI, 8, "bmi")             \
  X(BMI2, 9, "bmi2")           \
  X(AVX512F, 10, "avx512f")    \
  X(AVX512BW, 11, "avx512bw")  \
  X(AVX512CD, 12, "avx512cd")  \
  X(AVX512DQ, 13, "avx512dq")  \
  X(AVX512VL, 14, "avx512vl")
extern const unsigned kz_instructions;
/* "avx2 fma ...": the same for people and for the file; always the same text in one build. */
const char *kz_instruction_names(void);

typedef struct {
  const char *operands[5]; /* SCENE and what stands behind it */
  int n_operands;
  const char *scene;  /* path of the scene file; "-" = standard input */
  const char *output; /* FILE; NULL = base name of the scene + ".h5" in the current folder */
  char **sets;        /* KEY=VALUE of every --set, in order */
  int n_sets;
  char **origins; /* of every --origin, in order */
  int n_origins;
  bool resume, force, json, json_schema, no_browser;
  int64_t boundary;  /* digits of --boundary; 0 = not given */
  bool answered;     /* help and the like: nothing is left to do */
  const char *port;  /* of view, as written; NULL = not given */
  double time_limit; /* seconds; 0 = none */
  kz_progress progress;
  const char *log; /* FILE of JSON lines; NULL = none */
  bool timings;    /* print where the time went */
  bool speaks;     /* this process prints: the first of those that mpirun started */
  char *line;      /* the command line as typed */
} kz_options;

/* Reads the command line and carries it out: the whole program but for its entry. The message is left for one process alone. */
kz_status kz_app(int argc, char **argv);

/* Writes out standard output and, where the status is not KZ_OK, the message, which is then forgotten; KZ_FAILED where that output
 * cannot be written. */
kz_status kz_say(kz_status status);

/* The commands. */
kz_status kz_app_run(const kz_options *options);
kz_status kz_app_check(const kz_options *options);
kz_status kz_app_where(const kz_options *options);
kz_status kz_app_serve(const kz_options *options);
kz_status kz_app_view(const kz_options *options); /* becomes the explorer: returns only where that fails */
kz_status kz_app_keys(const kz_options *options);
void kz_app_version(FILE *out);

/* Starts of the command where: from the operands, or lines "theta,velocity" of standard input. start [n]: theta and velocity, as doubles
 * or, where a number of either is longer, both in all digits. KZ_REFUSED names the operand or the line. To be freed in every case. */
typedef struct {
  int64_t n;
  kz_coordinate (*start)[2];
  double pivot_frequency; /* rad/s, NaN where the scene is not in SI units: of velocities per second */
} kz_starts;
kz_status kz_starts_read(const kz_options *options, double pivot_frequency, kz_starts *starts);
void kz_starts_free(kz_starts *starts);

/* "theta": .., "velocity": .., and where that start ends, as members of a JSON object, to standard output; in SI too, unless `omega`, rad/s of the
 * pivot, is NaN. */
void kz_ending_print(const kz_coordinate start[2], const kz_ending *ending, double omega);

/* KZ_REFUSED where ranks were given other words behind the program's name than rank 0. Collective. */
kz_status kz_options_agree(const kz_options *options, kz_ranks *ranks);

/* FILE of a run, written to path [bytes]. KZ_REFUSED where the name is too long. */
kz_status kz_output_name(const kz_options *options, char *path, size_t bytes);
/* Everything about FILE that can be known before modelling. *complete: it holds this very scene already (with --resume). */
kz_status kz_output_check(const kz_options *options, const char *path, const char *fingerprint, bool *complete);

/* A rank that cannot go on ends all ranks with one line and status 1 (75 where a stop was asked), from here to disarming. */
void kz_abandon_arm(void);
void kz_abandon_disarm(void);
/* The ranks that it ends and the checkpoint that it names (NULL: none), and the result whose half file it removes (NULL: there is
 * none). */
void kz_abandon_run(const kz_run *run, const char *path);

/* The sum of what the wanted studies cost; the memory is that of the most demanding one. */
kz_cost kz_cost_of(const kz_scene *scene);
/* KZ_REFUSED where the ranks of this node need more memory than it has, or this process may not have its share. `ranks` NULL: one
 * rank alone. Collective. */
kz_status kz_cost_check(const kz_cost *cost, kz_ranks *ranks);
/* The lowest limit, in bytes, of the memory control group of this process and of all that it is in; infinity where there is none.
 * `groups` is /proc/self/cgroup (version 1 or 2), `mount` the folder /sys/fs/cgroup. Source: cgroups(7). */
double kz_memory_limit(const char *groups, const char *mount);
/* "12.3 MB" in text [32]. */
void kz_cost_print_bytes(double bytes, char *text);

/* s of processor time on one core that a run of the scene would take, by samples of its work, which may take 15 s themselves; where they
 * take longer, a lower bound. */
typedef struct {
  double seconds;
  bool is_whole; /* false: a lower bound */
} kz_estimate;
kz_status kz_estimate_time(const kz_scene *scene, kz_estimate *estimate);

/* A scene as text in memory (kz_scene_write), and what a resumed run must share. NULL without memory; the caller frees. */
char *kz_scene_resolved(const kz_scene *scene);
char *kz_scene_fingerprint(const kz_scene *scene);

/* Warnings, a line each, before a scene is modelled. */
void kz_warnings_print(const kz_scene *scene, FILE *out);

#endif
