/* The orbit of a window's centre, and its images. */
#include "window.h"

#include "numerics/cells.h"

/* Bits that the orbit keeps below the size of the window's image: its error is then some 1e-27 of that size. Of a line,
 * bits beyond the digits of x that the orbit and its tangent keep. */
enum { GUARD = 90, MARK_GUARD = 50, TANGENT_GUARD = 40 };
/* rad: the image's size, above which a cubic serves no level. */
static const long double widest = 1e-3L;

/* Its text is the axis's. */
static kz_coordinate centre_of(const kz_axis *axis) {
  if (kz_axis_is_centred(axis)) return (kz_coordinate){.centre = axis->centre.text};
  return (kz_coordinate){.high = (axis->min + axis->max) / 2};
}

static void take_axis(const kz_axis *axis, kz_coordinate *centre, __float128 *width) {
  *width = kz_axis_width(axis);
  *centre = centre_of(axis);
  if (centre->centre) centre->centre = kz_strdup(centre->centre);
}

/* The size of an image: the sum of its first coefficients, for shares up to 1/2. */
static long double size_of(const kz_jet *jet) {
  long double sum = 0;
  for (int i = 0; i < 4; i++) sum += fabsl((long double)jet->linear[i / 2][i % 2]);
  return sum / 2;
}

/* Bits behind the point for an image of this size. */
static int64_t bits_for(long double size, int64_t guard) {
  const int64_t bits = (int64_t)ceill(-log2l(size)) + guard;
  return kz_larger(bits, KZ_FEWEST_BITS);
}

static kz_images *allocate_images(const kz_pendulum *pendulum) {
  enum { FIRST_CAPACITY = 64 };
  kz_images *images = kz_calloc(1, sizeof *images);
  images->holders = 1;
  images->pendulum = *pendulum;
  images->capacity = FIRST_CAPACITY;
  images->image = kz_calloc(FIRST_CAPACITY, sizeof *images->image);
  return images;
}

static int64_t at_most(int64_t bits) {
  return kz_smaller(bits, KZ_MOST_BITS);
}

kz_images *kz_images_create(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_axis *theta,
                            const kz_axis *velocity) {
  kz_images *images = allocate_images(pendulum);
  kz_image *first = images->image;
  take_axis(theta, &images->centre[0], &images->width[0]);
  take_axis(velocity, &images->centre[1], &images->width[1]);
  for (int i = 0; i < 2; i++) first->jet.linear[i][i] = images->width[i];
  images->bits = at_most(bits_for(size_of(&first->jet), GUARD));
  images->orbit = kz_arbitrary_create(&images->pendulum, images->centre, images->bits);
  kz_dynamics_get_release(dynamics, &images->release);
  kz_arbitrary_release(images->orbit, &images->release);
  kz_arbitrary_read(images->orbit, first->theta, first->velocity);
  return images;
}

/* Bits of so many digits, and some more. */
static int64_t bits_of(int64_t digits, int64_t more) {
  return (int64_t)ceil((double)digits / log10(2)) + more;
}

/* Bits that the orbit keeps below the size of an image: of a line that is marked still, the digits of x too. */
static int64_t guard_of(const kz_images *images) {
  const int64_t guard = bits_of(images->digits, MARK_GUARD);
  return kz_larger(guard, GUARD);
}

kz_images *kz_images_on_line(kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_coordinate point[2],
                             int64_t digits) {
  kz_images *images = allocate_images(pendulum);
  kz_image *first = images->image;
  const long double size = fabsl(strtold(point[0].width, NULL)) + fabsl(strtold(point[1].width, NULL));
  images->digits = digits;
  images->bits = at_most(bits_for(size / 2, guard_of(images)));
  images->orbit =
      kz_arbitrary_on_line(&images->pendulum, point, images->bits, bits_of(digits, TANGENT_GUARD), &first->jet);
  kz_dynamics_get_release(dynamics, &images->release);
  kz_arbitrary_release(images->orbit, &images->release);
  kz_arbitrary_read(images->orbit, first->theta, first->velocity);
  return images;
}

kz_images *kz_images_beside(const kz_images *parent, __float128 share, int exponent, int64_t digits) {
  kz_images *images = allocate_images(&parent->pendulum);
  images->release = parent->release;
  kz_image *first = images->image;
  const kz_jet *jet = &parent->image[parent->marked].jet;
  images->digits = digits;
  images->before = parent->before + parent->marked;
  images->bits = at_most(bits_for(ldexpl(size_of(jet), exponent), guard_of(images)));
  images->orbit = kz_arbitrary_beside(parent->orbit, jet, share, exponent, images->bits, bits_of(digits, TANGENT_GUARD),
                                      &first->jet);
  kz_arbitrary_read(images->orbit, first->theta, first->velocity);
  return images;
}

kz_images *kz_images_hold(kz_images *images) {
  if (images) images->holders++;
  return images;
}

void kz_images_free(kz_images *images) {
  if (!images || --images->holders > 0) return;
  for (int i = 0; i < 2; i++) free((char *)images->centre[i].centre);
  kz_arbitrary_free(images->orbit);
  free(images->image);
  free(images);
}

/* Whether a trapping region holds the whole last image: its size counts as an error of the centre. */
static bool is_trapped(const kz_images *images, kz_dynamics *dynamics) {
  const kz_image *image = images->image + images->n;
  if (!kz_image_is_final(images, images->n)) return false;
  const double size = (double)size_of(&image->jet);
  const kz_start start = {.theta = {image->theta[0], image->theta[1]},
                          .velocity = {image->velocity[0], image->velocity[1]},
                          .error = {size * size, 0, size * size}};
  return kz_start_is_trapped(dynamics, &start);
}

static void images_reserve(kz_images *images, int64_t n) {
  if (n < images->capacity) return;
  images->capacity = 2 * images->capacity > n + 1 ? 2 * images->capacity : n + 1;
  images->image = kz_realloc(images->image, (size_t)images->capacity * sizeof *images->image);
}

/* Marks the last image, from the final drive on; the first one that is too bent for it ends the marking. */
static void images_mark(kz_images *images) {
  if (!kz_image_is_straight(images, images->n, images->digits)) {
    images->digits = 0;
    return;
  }
  if (!kz_image_is_final(images, images->n)) return;
  kz_arbitrary_mark(images->orbit);
  images->marked = images->n;
}

static kz_status add_image(kz_images *images) {
  images_reserve(images, images->n + 1);
  const kz_image *last = images->image + images->n;
  kz_image *next = images->image + images->n + 1;
  const int64_t needed = bits_for(size_of(&last->jet), guard_of(images)), bits = kz_smaller(needed, images->bits);
  memset(next, 0, sizeof *next);
  next->jet = last->jet;
  KZ_TRY(kz_arbitrary_advance(images->orbit, bits, 3, &next->jet));
  kz_arbitrary_read(images->orbit, next->theta, next->velocity);
  next->turns = kz_arbitrary_turns(images->orbit);
  next->lost = last->lost + (double)(exp2l((long double)(4 - bits)) / size_of(&next->jet));
  images->n++;
  if (images->digits > 0) images_mark(images);
  return KZ_OK;
}

kz_status kz_images_follow(kz_images *images, kz_dynamics *dynamics, int64_t most, int64_t max_periods) {
  for (int64_t i = 0; i < most && !images->finished; i++) {
    const kz_image *last = images->image + images->n;
    images->finished =
        images->before + images->n >= max_periods || !(size_of(&last->jet) < widest) || is_trapped(images, dynamics);
    if (!images->finished) KZ_TRY(add_image(images));
  }
  return KZ_OK;
}

/* Estimates the work that is left, in units of the last period. It assumes that the image goes on to grow as it did,
 * and that the time of a period falls as the square of the bits. */
static double work_left(const kz_images *images) {
  const long double first = size_of(&images->image->jet), now = size_of(&images->image[images->n].jet);
  const double growth = (double)log2l(now / first) / (double)images->n,
               share = (double)KZ_FEWEST_BITS / (double)bits_for(now, GUARD);
  if (images->finished || !(growth > 0) || !(now < widest)) return 0;
  return (double)log2l(widest / now) / growth * (1 + share + share * share) / 3;
}

bool kz_images_serve(const kz_images *images, kz_dynamics *dynamics, const kz_pendulum *pendulum, const kz_axis *theta,
                     const kz_axis *velocity, kz_view *view) {
  static const double narrowest = 0.1, farthest = 16; /* shares of the images' width, and of the window's */
  const kz_axis *axes[2] = {theta, velocity};
  kz_release release;
  kz_dynamics_get_release(dynamics, &release);
  bool is_wide = false, is_near = memcmp(pendulum, &images->pendulum, sizeof images->pendulum) == 0 &&
                                  kz_release_is_same(&release, &images->release);
  *view = (kz_view){.reach = 0};
  for (int i = 0; i < 2; i++) {
    const kz_coordinate centre = centre_of(axes[i]);
    if (images->width[i] == 0) return false;
    view->scale[i] = kz_axis_width(axes[i]) / images->width[i];
    view->offset[i] = kz_coordinate_difference(&centre, &images->centre[i], images->bits) / images->width[i];
    const double scale = (double)view->scale[i], offset = fabs((double)view->offset[i]);
    is_near = is_near && offset <= farthest * scale;
    is_wide = is_wide || scale >= narrowest;
    view->reach = fmax(view->reach, offset + scale / 2);
  }
  return is_near && is_wide;
}

/* ---- images in pieces of a few periods: a stage of one tile each, which needs the one before; shown as one ---- */

/* Replaces all images after image `before` by n images that another rank has made. */
static void images_extend(kz_images *images, int64_t before, int64_t n, const kz_image *image, bool finished) {
  images_reserve(images, before + n);
  memcpy(images->image + before + 1, image, (size_t)n * sizeof *image);
  images->n = before + n;
  images->finished = finished;
}

enum { PIECE = 8 }; /* periods */

/* A record. After it: the state of the orbit. */
typedef struct {
  kz_image image[PIECE];
  int64_t n;
  bool finished;
} piece;

typedef struct {
  kz_images *images;
  kz_dynamics *dynamics;
  int64_t max_periods;
} work;

static kz_status follow_piece(void *context, int64_t tile, void *record) {
  const work *w = context;
  piece *p = record;
  const int64_t before = w->images->n;
  (void)tile;
  KZ_TRY(kz_images_follow(w->images, w->dynamics, PIECE, w->max_periods));
  p->n = w->images->n - before;
  p->finished = w->images->finished;
  memcpy(p->image, w->images->image + before + 1, (size_t)p->n * sizeof *p->image);
  kz_arbitrary_write(w->images->orbit, (char *)(p + 1));
  return KZ_OK;
}

static kz_status run_piece(const kz_run *run, const work *w, piece *record, size_t bytes) {
  const int64_t before = w->images->n;
  const kz_stage stage = kz_stage_for_all("reference", 1, bytes, follow_piece, (void *)w);
  KZ_TRY(kz_stage_run(run, &stage, record));
  images_extend(w->images, before, record->n, record->image, record->finished);
  return kz_ranks_agree(run->ranks, kz_arbitrary_restore(w->images->orbit, (const char *)(record + 1)));
}

kz_status kz_images_run(const kz_run *run, kz_dynamics *dynamics, kz_images *images, int64_t max_periods) {
  const work w = {.images = images, .dynamics = dynamics, .max_periods = max_periods};
  kz_serial_progress *chain = kz_serial_progress_begin(run, "reference");
  const size_t bytes = sizeof(piece) + kz_arbitrary_size(images->orbit);
  KZ_AUTOFREE piece *record = kz_malloc(bytes);
  kz_status status = KZ_OK;
  while (status == KZ_OK && !images->finished) {
    const double begun = kz_clock();
    status = run_piece(run, &w, record, bytes);
    kz_serial_progress_show(chain, record->n > 0 ? (kz_clock() - begun) / (double)record->n * work_left(images) : 0);
  }
  kz_serial_progress_end(chain, status == KZ_OK);
  return status;
}
