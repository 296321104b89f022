/* app: the command line, what its commands do, and messages for people (C; layer 4). */
#pragma once

#include "kapitza/app_instructions.h"
#include "scene/scene.h"

/* The names of these sets, "avx2 fma ...", for the summary and the file; the text depends on the build only. */
const char *kz_instruction_names(void);

typedef struct {
  int n_words; /* Number of words behind `plot`, which the package reads */
  char *const *plot_words;
  const char *operands[5]; /* SCENE and the operands after it */
  int n_operands;
  const char *scene;  /* path of the scene file; "-" = standard input */
  const char *output; /* FILE; NULL = base name of the scene + ".h5" in the current folder */
  char **sets;        /* KEY=VALUE of every --set, in order */
  int n_sets;
  char **joined; /* words of the command line that were made of a number and its unit; n_joined of them */
  int n_joined;
  bool resume, force, all, json, json_schema, layout;
  void *own;         /* Fields that the command's own options set; NULL = it has none */
  bool compared;     /* the command lines of all ranks were compared, or are by the command */
  bool answered;     /* --help or the like was printed: nothing is left to do */
  double time_limit; /* seconds; 0 = none */
  kz_progress progress;
  const char *log;   /* FILE of JSON lines; NULL = none */
  bool timings;      /* print where the time went */
  bool prints;       /* this process prints: the first of those that mpirun started */
  char *line;        /* the command line as typed */
  const char *words; /* Words behind the name of the program */
} kz_options;

/* Reads the command line and runs its command: the whole program but its entry. One process keeps the message. */
kz_status kz_app(int argc, char **argv);

/* Flushes stdout, prints and clears the message unless the status is KZ_OK. KZ_FAILED if stdout fails. */
kz_status kz_message_print(kz_status status);

/* The commands. */
kz_status kz_app_run(const kz_options *options);
/* Description of a stage, for progress: "labels in quad precision (1)" for "quad 1". */
void kz_stage_words(const char *name, char *words, size_t bytes);
kz_status kz_app_check(const kz_options *options);
kz_status kz_app_keys(const kz_options *options);
void kz_app_version(FILE *out);

/* Calls `answer` with the scene on the process that prints; a message about a key gets its place in the scene. */
kz_status kz_scene_answer(const kz_options *options, kz_status (*serve_answer)(const kz_options *, const kz_scene *));

/* Writes the name of the result to path [bytes]. KZ_REFUSED if the name is too long. */
kz_status kz_output_name(const kz_options *options, char *path, size_t bytes);
/* Checks all about FILE that can be known before modelling. *complete: --resume finds this scene's full result. */
kz_status kz_output_check(const kz_options *options, const char *path, const char *fingerprint, bool *complete);

/* Between kz_abandon_arm and _disarm a rank that cannot go on ends all with one line, status 1, or 75 when stopped. */
void kz_abandon_arm(void);
void kz_abandon_disarm(void);
/* Sets ranks to end, the checkpoint to name (each may be NULL), the result whose unfinished file goes (or NULL). */
void kz_abandon_run(const kz_run *run, const char *path);

/* The cost of the scene: the sum over its studies; the memory is the largest of them. */
kz_cost kz_cost_of(const kz_scene *scene);
/* KZ_REFUSED if the ranks of this node need more memory than it has, or this process more than its limit. `ranks` NULL
 * = one rank. Collective. */
kz_status kz_cost_check(const kz_cost *cost, kz_ranks *ranks);
/* The lowest limit, in bytes, of the memory control group of this process and of all groups above it; infinity if there
 * is none. `groups` is /proc/self/cgroup (version 1 or 2), `mount` the folder /sys/fs/cgroup. Source: cgroups(7). */
double kz_memory_limit(const char *groups, const char *mount);
/* "12.3 MB". */
kz_short_text kz_cost_bytes(double bytes);

/* Returns the scene as text, or as the fingerprint of resumed runs; the caller frees it. NULL: no memory. */
char *kz_scene_text(const kz_scene *scene, bool fingerprint);

/* Prints the warnings about a scene that are known before it is modelled, a line each. */
void kz_warnings_print(const kz_scene *scene, FILE *out);

/* The log of a run: JSON lines for programs (--log), and the table of timings for people (--timings). Rank 0. */

/* Opens FILE to append to it. KZ_REFUSED if it cannot be written, or if it exists and is not such a log. */
kz_status kz_log_open(const char *path, FILE **log);
/* Writes one event, "begin", "warning" or "end". `fields` = pairs of name and text, NULL-ended; "#name" = the text is a
 * number. NULL as `log`: does nothing. */
void kz_log_event(FILE *log, double seconds, const char *event, const char *const *fields);
/* Writes an event "warning" for each line of `text` that is a warning. */
void kz_log_warnings(FILE *log, double seconds, const char *text);
/* Closes the log; KZ_FAILED if it could not be written completely. NULL: does nothing. */
kz_status kz_log_close(FILE *log, const char *path);

/* Prints the table of timings. */
void kz_timings_print(const kz_ranks *ranks, FILE *out);
