#include "live.h"

#include "numerics/cells.h"

/* Periods after which a cell is late: most cells of a whole circle take fewer. */
enum { SOON = 24 };

/* The smooth settling times of n cells that were left at these states after these times. */
static void cells_smooth(const kz_prepared *r, int64_t n, const int32_t *label, const double *state, double *time,
                         const int64_t *number, kz_frame_cell *cells) {
  kz_dynamics_smooth_times(r->dynamics, n, label, state, time);
  for (int64_t i = 0; i < n; i++) cells[number[i]].smooth = (float)time[i];
}

static void add_late(kz_travellers *late, int64_t number, int64_t spent, const double *state) {
  late->number[late->n] = number;
  late->spent[late->n] = spent;
  memcpy(late->state + 2 * late->n++, state, 2 * sizeof *state);
}

/* As method direct labels them, for so many periods. What then goes on joins `late`, or has not settled if that is
 * NULL. Late cells of a weakly damped pendulum, which take hundreds of periods, are followed in a cheaper way. */
static void cells_follow(kz_prepared *r, int64_t most, kz_travellers *from, kz_travellers *late, kz_frame_cell *cells) {
  int32_t label[2 * KZ_FRAME_TILE];
  int64_t periods[2 * KZ_FRAME_TILE];
  double time[2 * KZ_FRAME_TILE], *state = from->state;
  const kz_stepper stepper = late ? KZ_FOLLOW_DIRECT : kz_prepared_late_stepper(r);
  kz_dynamics_follow(r->dynamics, stepper, from->n, most, state, label, periods, NULL);
  for (int64_t i = 0; i < from->n; i++) {
    const int64_t number = from->number[i], spent = from->spent[i] + periods[i];
    time[i] = (double)spent;
    if (label[i] == 0 && late) {
      add_late(late, number, spent, state + 2 * i);
      continue;
    }
    cells[number].end =
        (kz_label){.label = (int16_t)label[i], .periods = spent, .evidence = KZ_LEFT, .turns = KZ_NO_TURNS};
    r->ended++;
    r->left += label[i] == 0;
    if (label[i] == 0 && r->n_unsettled < KZ_MOST_UNSETTLED)
      memcpy(r->unsettled + 2 * r->n_unsettled++, state + 2 * i, 2 * sizeof *state);
  }
  if (r->smooth) cells_smooth(r, from->n, label, state, time, from->number, cells);
}

void kz_cells_finish(kz_prepared *prepared, kz_travellers *late, kz_frame_cell *cells) {
  if (late->n > 0) cells_follow(prepared, prepared->periods - SOON, late, NULL, cells);
  late->n = 0;
}

static void follow_moving(kz_prepared *r, kz_travellers *from, kz_travellers *late, kz_frame_cell *cells) {
  if (r->periods <= SOON) {
    cells_follow(r, r->periods, from, NULL, cells);
    return;
  }
  cells_follow(r, SOON, from, late, cells);
  if (late->n > KZ_FRAME_TILE) kz_cells_finish(r, late, cells);
}

/* Cells that are decided, with what smooth settling times need of them. */
typedef struct {
  kz_labeller labeller; /* labeller of the frame's cells */
  const int64_t *number;
  int32_t label[KZ_FRAME_TILE]; /* 0: where the cell was left is not known */
  double state[2 * KZ_FRAME_TILE], time[KZ_FRAME_TILE];
} deciding;

/* A kz_start_fn. */
static kz_status start_cell(void *context, int64_t i, kz_precision level, kz_start *start) {
  const deciding *d = context;
  return d->labeller.start(d->labeller.context, d->number[i], level, start);
}

/* A kz_note_fn. */
static void cells_note(void *context, int64_t i, const kz_decision *decision) {
  deciding *d = context;
  d->label[i] = decision->decided ? decision->end.label : 0;
  d->time[i] = (double)(decision->decided ? decision->age : decision->end.periods);
  memcpy(d->state + 2 * i, decision->state, sizeof decision->state);
}

/* As method exact labels them. */
static kz_status cells_decide(const kz_prepared *r, const kz_window_starts *starts, int64_t n, const int64_t *number,
                              kz_frame_cell *cells) {
  KZ_AUTOFREE deciding *d = kz_malloc(sizeof *d);
  kz_label label[KZ_FRAME_TILE];
  d->labeller = kz_window_labeller(starts, false);
  d->number = number;
  kz_labeller labeller = d->labeller;
  labeller.start = start_cell;
  labeller.note = cells_note;
  labeller.turns = r->turns;
  labeller.context = d;
  KZ_TRY(kz_label_items(&labeller, 1, n, NULL, label));
  for (int64_t i = 0; i < n; i++) cells[number[i]].end = label[i];
  if (r->smooth) cells_smooth(r, n, d->label, d->state, d->time, number, cells);
  return KZ_OK;
}

kz_status kz_cells_follow(kz_prepared *prepared, const kz_window_starts *starts, int64_t n, const int64_t *number,
                          kz_travellers *late, kz_frame_cell *cells) {
  if (!kz_prepared_moves(prepared)) return cells_decide(prepared, starts, n, number, cells);
  KZ_AUTOFREE kz_travellers *from = kz_malloc(sizeof *from);
  from->n = n;
  memcpy(from->number, number, (size_t)n * sizeof *number);
  const kz_labeller labeller = kz_window_labeller(starts, false);
  KZ_TRY(kz_item_states(&labeller, n, number, from->state, from->spent));
  follow_moving(prepared, from, late, cells);
  return KZ_OK;
}

void kz_samples_make(const kz_window_starts *starts, kz_samples *samples) {
  kz_window_curve_make(starts, &samples->curve);
  samples->cell = kz_calloc((size_t)samples->curve.count, sizeof *samples->cell);
  samples->wanted = kz_malloc((size_t)samples->curve.count * sizeof *samples->wanted);
}

void kz_samples_free(kz_samples *samples) {
  kz_window_curve_free(&samples->curve);
  free(samples->cell);
  free(samples->wanted);
}

/* The samples that n cells need and that have not been followed. */
static int64_t list_wanted(kz_samples *samples, int64_t n, const int64_t *number) {
  int64_t wanted = 0;
  for (int64_t i = 0; i < n; i++) {
    const int64_t sample = kz_window_curve_sample(&samples->curve, number[i]);
    if (samples->cell[sample].end.evidence != 0) continue;
    samples->cell[sample].end.evidence = KZ_LEFT;
    samples->wanted[wanted++] = sample;
  }
  return wanted;
}

kz_status kz_samples_follow(kz_prepared *prepared, const kz_frame *frame, kz_samples *samples, int64_t n,
                            const int64_t *number, kz_frame_cell *cells) {
  KZ_AUTOFREE kz_travellers *from = kz_malloc(2 * sizeof *from);
  kz_travellers *late = from + 1;
  const int64_t wanted = list_wanted(samples, n, number);
  late->n = 0;
  for (int64_t done = 0; done < wanted; done += KZ_FRAME_TILE) {
    const int64_t *sample = samples->wanted + done;
    KZ_TRY(frame->pause(frame->context));
    from->n = wanted - done < KZ_FRAME_TILE ? wanted - done : KZ_FRAME_TILE;
    memcpy(from->number, sample, (size_t)from->n * sizeof *sample);
    for (int64_t i = 0; i < from->n; i++)
      kz_window_curve_state(&samples->curve, sample[i], from->state + 2 * i, from->spent + i);
    follow_moving(prepared, from, late, samples->cell);
  }
  kz_cells_finish(prepared, late, samples->cell);
  for (int64_t i = 0; i < n; i++) cells[number[i]] = samples->cell[kz_window_curve_sample(&samples->curve, number[i])];
  return KZ_OK;
}

/* The images that serve the window: those of the last frame, or new ones. */
static kz_images *find_images(kz_prepared *r, const kz_basin_plan *plan) {
  const kz_pendulum *pendulum = &r->scene.parameters.pendulum;
  kz_view view;
  if (!r->images || !kz_images_serve(r->images, r->dynamics, pendulum, &plan->theta, &plan->velocity, &view)) {
    kz_images_free(r->images);
    r->images = kz_images_create(r->dynamics, pendulum, &plan->theta, &plan->velocity);
  }
  return kz_images_hold(r->images);
}

/* Another frame may be made in a pause. */
static kz_status follow_images(kz_prepared *r, const kz_basin_plan *plan, const kz_frame *frame, kz_images *images) {
  enum { AT_A_TIME = 4 };
  while (!images->finished) {
    KZ_TRY(frame->pause(frame->context));
    KZ_TRY(kz_images_follow(images, r->dynamics, AT_A_TIME, plan->max_periods));
  }
  return KZ_OK;
}

kz_status kz_cells_begin(kz_prepared *prepared, const kz_basin_plan *plan, const kz_frame *frame,
                         kz_window_starts *starts) {
  kz_images *images = kz_plan_is_centred(plan) ? find_images(prepared, plan) : NULL;
  const kz_status status = images ? follow_images(prepared, plan, frame, images) : KZ_OK;
  if (status == KZ_OK)
    kz_window_starts_make(plan, &prepared->scene.parameters.pendulum, prepared->dynamics, images, starts);
  kz_images_free(images);
  return status;
}
