/* The command run, from the text of the scene to the complete file. All ranks call these functions together. */
#include <limits.h>
#include <sys/stat.h>
#include <time.h>

#include "kapitza/app.h"
#include "app.h"
#include "kapitza/version.h"

typedef struct {
  const kz_options *options;
  kz_run run;
  bool first; /* rank 0: reads, writes and prints */
  char *text; /* Text of the scene, `length` bytes and a NUL */
  uint64_t length;
  kz_scene scene;
  char *resolved, *fingerprint;
  char path[PATH_MAX];
  kz_store *store; /* NULL but on rank 0 */
  FILE *summary;   /* NULL but on rank 0 */
  char *words;     /* Text of the summary, n_words bytes */
  size_t n_words;
  FILE *log; /* NULL: none */
} job;

/* Every rank has the bytes that rank 0 read, so that all come to the same result. */
static kz_status share_text(job *j) {
  size_t length = 0;
  KZ_TRY(kz_ranks_agree(j->run.ranks, j->first ? kz_scene_load(j->options->scene, &j->text, &length) : KZ_OK));
  j->length = length;
  KZ_TRY(kz_ranks_broadcast(j->run.ranks, &j->length, sizeof j->length));
  if (!j->first) j->text = kz_calloc(1, j->length + 1);
  return kz_ranks_broadcast(j->run.ranks, j->text, j->length);
}

static kz_status read_scene(job *j) {
  const kz_options *o = j->options;
  KZ_TRY(kz_scene_read(j->text, j->length, o->scene, o->n_sets, o->sets, &j->scene));
  j->resolved = kz_scene_text(&j->scene, false);
  j->fingerprint = kz_scene_text(&j->scene, true);
  return j->resolved && j->fingerprint ? KZ_OK : kz_fail(KZ_FAILED, "out of memory while reading %s", o->scene);
}

/* Refuses to run unless all ranks have the same command line, scene, program and name of the result. */
static kz_status agree_on_scene(job *j) {
  KZ_TRY(kz_ranks_compare(j->run.ranks, j->options->words, "command line"));
  KZ_TRY(share_text(j));
  KZ_TRY(kz_ranks_agree(j->run.ranks, read_scene(j)));
  KZ_TRY(kz_ranks_compare(j->run.ranks, j->fingerprint, "scene or program"));
  KZ_TRY(kz_ranks_agree(j->run.ranks, kz_output_name(j->options, j->path, sizeof j->path)));
  return kz_ranks_compare(j->run.ranks, j->path, "name of the result");
}

/* *complete = true if the result of this scene is complete already. */
static kz_status check_output(job *j, bool *complete) {
  KZ_TRY(
      kz_ranks_agree(j->run.ranks, j->first ? kz_output_check(j->options, j->path, j->fingerprint, complete) : KZ_OK));
  return kz_ranks_broadcast(j->run.ranks, complete, sizeof *complete);
}

/* Makes every check that is possible before modelling, and prints the warnings. */
static kz_status run_prepare(job *j, bool *complete) {
  KZ_TRY(agree_on_scene(j));
  KZ_TRY(check_output(j, complete));
  const kz_cost cost = kz_cost_of(&j->scene);
  KZ_TRY(kz_ranks_agree(j->run.ranks, kz_cost_check(&cost, j->run.ranks)));
  KZ_TRY(kz_ranks_agree(j->run.ranks, j->first && !*complete ? kz_studies_check(&j->scene) : KZ_OK));
  if (j->first && !*complete) kz_warnings_print(&j->scene, stderr);
  return KZ_OK;
}

/* Neither the result nor what stands beside it may be the log. */
static kz_status open_log(job *j) {
  static const char *const suffixes[] = {"", ".part", ".checkpoint", ".truth", ".truth.part"};
  const char *name = j->options->log;
  const size_t stem = strlen(j->path);
  for (size_t i = 0; i < sizeof suffixes / sizeof suffixes[0]; i++)
    if (strncmp(name, j->path, stem) == 0 && strcmp(name + stem, suffixes[i]) == 0)
      return kz_fail(KZ_REFUSED, "--log: %s: is a name of the result; use another name", name);
  KZ_TRY(kz_log_open(name, &j->log));
  char ranks[16], cells[32];
  snprintf(ranks, sizeof ranks, "%d", kz_ranks_count(j->run.ranks));
  snprintf(cells, sizeof cells, "%lld", (long long)kz_cost_of(&j->scene).cells);
  const char *const fields[] = {"program",       "kapitza", "version",        KZ_VERSION, "git_revision",
                                KZ_GIT_REVISION, "command", j->options->line, "file",     j->path,
                                "#ranks",        ranks,     "#cells",         cells,      NULL};
  kz_log_event(j->log, kz_ranks_seconds(j->run.ranks), "begin", fields);
  kz_ranks_set_log(j->run.ranks, j->log);
  return KZ_OK;
}

/* Writes the end of the run, its status and its times, to the log. */
static kz_status close_log(job *j, kz_status status) {
  const double seconds = kz_ranks_seconds(j->run.ranks);
  char code[16], outside[32];
  snprintf(code, sizeof code, "%d", (int)status);
  snprintf(outside, sizeof outside, "%.6f", kz_ranks_outside(j->run.ranks));
  if (j->summary) fflush(j->summary);
  kz_log_warnings(j->log, seconds, j->words ? j->words : "");
  kz_log_event(j->log, seconds, "end",
               (const char *const[]){"#status", code, "#outside", outside, "message", kz_message(), NULL});
  kz_ranks_set_log(j->run.ranks, NULL);
  const kz_status closed = kz_log_close(j->log, j->options->log);
  j->log = NULL;
  return status == KZ_OK ? closed : status;
}

static kz_status close_checkpoint(job *j, kz_status status, bool complete) {
  kz_checkpoint *checkpoint = j->run.checkpoint;
  j->run.checkpoint = NULL;
  kz_abandon_run(&j->run, NULL);
  kz_ranks_set_overdue(j->run.ranks, NULL); /* the remaining work is short */
  const kz_status closed = kz_checkpoint_close(j->run.ranks, checkpoint, complete);
  return status == KZ_OK ? closed : status;
}

/* Opens the checkpoint. The run that held it until now may have written the result: it is looked for once more. */
static kz_status open_checkpoint(job *j, bool *complete) {
  char name[PATH_MAX + 16];
  const kz_options *o = j->options;
  snprintf(name, sizeof name, "%s.checkpoint", j->path);
  const kz_checkpoint_plan plan = {.path = name, .fingerprint = j->fingerprint, .resume = o->resume, .force = o->force};
  KZ_TRY(kz_checkpoint_open(j->run.ranks, &plan, &j->run.checkpoint));
  kz_abandon_run(&j->run, NULL);
  const kz_status status = check_output(j, complete);
  return status == KZ_OK && !*complete ? KZ_OK : close_checkpoint(j, status, false);
}

static kz_status write_root(job *j) {
  char created[32];
  const time_t now = time(NULL);
  struct tm utc;
  strftime(created, sizeof created, "%Y-%m-%dT%H:%M:%SZ", gmtime_r(&now, &utc));
  const struct {
    const char *name, *value;
  } texts[] = {{"title", j->scene.title},
               {"program", "kapitza"},
               {"version", KZ_VERSION},
               {"git_revision", KZ_GIT_REVISION},
               {"created", created},
               {"command", j->options->line},
               {"scene", j->text},
               {"scene_resolved", j->resolved},
               {"instruction_set", kz_instruction_names()},
               {"compiler", KZ_COMPILER},
               {"mpi", kz_parallel_library()},
               {"hdf5", kz_store_library()},
               {"fingerprint", j->fingerprint},
               {"Conventions", "CF-1.8"}};
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
    KZ_TRY(kz_store_text(j->store, "/", texts[i].name, texts[i].value));
  return kz_store_integer(j->store, "/", "ranks", kz_ranks_count(j->run.ranks));
}

/* Prints the pendulum before the studies, because a complete file is followed by nothing that can fail. */
static void print_pendulum(const kz_scene *scene, FILE *out) {
  const kz_pendulum *p = &scene->parameters.pendulum;
  kz_rest_print(&scene->parameters, out);
  if (scene->title[0]) fprintf(out, "%s\n", scene->title);
  if (!isnan(p->k)) fprintf(out, "k = %.10g, beta = %.10g, m = %.10g\n", p->k, p->beta, p->m);
  kz_drive_print(&scene->parameters, out);
  if (!kz_is_mirrored(p)) kz_symmetries_print(p, out);
}

static kz_status open_outputs(job *j) {
  j->summary = open_memstream(&j->words, &j->n_words);
  if (!j->summary) return kz_fail(KZ_FAILED, "out of memory for the summary");
  print_pendulum(&j->scene, j->summary);
  KZ_TRY(kz_store_create(j->path, kz_groups, &j->store));
  KZ_TRY(write_root(j));
  KZ_TRY(kz_pendulum_write(&j->scene.parameters, j->store));
  return kz_studies_describe(&j->scene, j->store);
}

static kz_status run_studies(job *j) {
  KZ_TRY(kz_ranks_agree(j->run.ranks, j->first ? open_outputs(j) : KZ_OK));
  kz_abandon_run(&j->run, j->path);
  for (int i = 0; i < kz_study_count; i++)
    if (kz_studies[i]->run && kz_study_is_wanted(kz_studies[i], &j->scene))
      KZ_TRY(kz_ranks_agree(j->run.ranks, kz_studies[i]->run(&j->scene, &j->run, j->store, j->summary)));
  return KZ_OK;
}

static void print_summary(job *j) {
  fclose(j->summary);
  j->summary = NULL;
  printf("%swritten to %s\n", j->words, j->path);
}

/* The file appears under its name, or not at all; one that somebody else has put there meanwhile stays. */
static kz_status complete_store(job *j) {
  struct stat there;
  if (j->options->force || lstat(j->path, &there) != 0) return kz_store_complete(j->store);
  kz_store_discard(j->store);
  return kz_fail(KZ_FAILED, "%s: another file of that name appeared during the run; move it away and --resume",
                 j->path);
}

static kz_status run_finish(job *j, kz_status status) {
  if (j->store && status == KZ_OK)
    status = kz_store_real(j->store, "/", "wall_seconds", kz_ranks_seconds(j->run.ranks));
  if (j->store && status == KZ_OK) {
    status = complete_store(j);
  } else if (j->store) {
    kz_store_discard(j->store);
  }
  j->store = NULL;
  status = kz_ranks_agree(j->run.ranks, status);
  if (status == KZ_STOPPED) status = kz_checkpoint_stopped(j->run.checkpoint);
  status = close_checkpoint(j, status, status == KZ_OK || status == KZ_REFUSED);
  if (status == KZ_OK && j->first) print_summary(j);
  return status;
}

/* Removes the checkpoint of this run, which is not needed any more; the checkpoint of another run stays. */
static kz_status leave_complete(job *j) {
  char name[PATH_MAX + 16];
  if (!j->first) return KZ_OK;
  snprintf(name, sizeof name, "%s.checkpoint", j->path);
  kz_checkpoint_clear(name, j->fingerprint);
  printf("%s is already complete for this scene\n", j->path);
  return KZ_OK;
}

static kz_status carry_out(job *j) {
  bool complete = false;
  kz_ranks_set_progress(j->run.ranks, j->options->progress);
  kz_ranks_name_stages(j->run.ranks, kz_stage_words);
  kz_ranks_set_time_limit(j->run.ranks, j->options->time_limit);
  kz_abandon_run(&j->run, NULL); /* the limit holds for what comes before modelling, too */
  KZ_TRY(run_prepare(j, &complete));
  KZ_TRY(kz_ranks_agree(j->run.ranks, j->first && j->options->log ? open_log(j) : KZ_OK));
  if (!complete) KZ_TRY(open_checkpoint(j, &complete));
  return complete ? leave_complete(j) : run_finish(j, run_studies(j));
}

static void free_job(job *j) {
  if (j->summary) fclose(j->summary);
  free(j->words);
  free(j->text);
  free(j->resolved);
  free(j->fingerprint);
  kz_scene_free(&j->scene);
}

kz_status kz_app_run(const kz_options *options) {
  job j = {.options = options};
  kz_status status = kz_ranks_start(NULL, NULL, &j.run.ranks);
  if (status == KZ_OK) {
    kz_abandon_run(&j.run, NULL);
    j.first = kz_rank(j.run.ranks) == 0;
    status = carry_out(&j);
    if (j.first && options->timings && (status == KZ_OK || status == KZ_STOPPED)) kz_timings_print(j.run.ranks, stdout);
    status = kz_scene_locate(status, j.text, j.length, options->scene, options->n_sets, options->sets);
    if (j.log) status = close_log(&j, status);
    if (!j.first) kz_message_clear();  /* rank 0 prints what all agreed on */
    status = kz_message_print(status); /* printed before any rank ends: mpirun ends the others at a failure */
  }
  kz_ranks_set_overdue(j.run.ranks, NULL);
  kz_abandon_run(&(kz_run){0}, NULL);
  kz_ranks_end(j.run.ranks);
  free_job(&j);
  return status;
}

/* A run without ranks: no signals, no checkpoint, no progress. */
static kz_status run_alone(job *j, kz_store **store) {
  const double begin = kz_clock();
  bool complete = false;
  KZ_TRY(read_scene(j));
  KZ_TRY(kz_output_name(j->options, j->path, sizeof j->path));
  KZ_TRY(kz_output_check(j->options, j->path, j->fingerprint, &complete));
  const kz_cost cost = kz_cost_of(&j->scene);
  KZ_TRY(kz_cost_check(&cost, NULL));
  KZ_TRY(kz_studies_check(&j->scene));
  kz_status status = open_outputs(j);
  *store = j->store;
  for (int i = 0; i < kz_study_count && status == KZ_OK; i++)
    if (kz_studies[i]->run && kz_study_is_wanted(kz_studies[i], &j->scene))
      status = kz_studies[i]->run(&j->scene, &j->run, j->store, j->summary);
  if (status == KZ_OK) status = kz_store_real(j->store, "/", "wall_seconds", kz_clock() - begin);
  *store = NULL;
  if (status == KZ_OK) return complete_store(j);
  if (j->store) kz_store_discard(j->store);
  return status;
}

kz_status kz_run_text(const char *text, const char *output, bool force, char **words, kz_store **store) {
  const kz_options options = {.scene = "scene", .output = output, .force = force, .line = "libkapitza", .words = ""};
  job j = {.options = &options, .first = true, .text = kz_strdup(text), .length = strlen(text)};
  *store = NULL;
  const kz_status status = kz_scene_locate(run_alone(&j, store), j.text, j.length, options.scene, 0, NULL);
  if (j.summary) fclose(j.summary);
  j.summary = NULL;
  *words = j.words;
  j.words = NULL;
  free_job(&j);
  return status;
}
