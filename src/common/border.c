/* The border of the library. What is left in the middle keeps nothing: the memory of its object is freed as a whole,
 * and locks that it holds are left. */
#include "kapitza/common_border.h"

#include <fenv.h>
#include <setjmp.h>

enum { MOST_LOCKS = 8, CALLS_BETWEEN_CLOCKS = 32 };
static const double PAUSE = 0.05; /* s between two questions to the caller */
static const size_t FIRST_SLOTS = 4096;

/* Addresses of memory: a hash table with linear probing, at most half full. */
typedef struct {
  void **slot;
  size_t slots, used;
} addresses;

struct kz_border {
  pthread_mutex_t mutex; /* Lock of the fields below, which threads of one call share */
  addresses memory;
  _Atomic int left; /* why the call is left, a kz_status; 0 = it goes on */
  bool lacked_memory;
};

/* State of a thread within a border. */
typedef struct {
  kz_border *border;
  jmp_buf *way_out; /* Target of the innermost guard; NULL: none */
  kz_pause_fn pause;
  void *pause_context;
  double due; /* s, when the caller is asked next */
  int calls;
  int n_locks;
  pthread_mutex_t *lock[MOST_LOCKS]; /* held by this thread, the last one taken at the end */
} visit;
static _Thread_local visit here;

void *__real_malloc(size_t bytes);
void *__real_calloc(size_t n, size_t bytes);
void __real_free(void *memory);

/* ---- addresses ---- */

static size_t place_of(const addresses *a, const void *memory) {
  return (((uintptr_t)memory >> 4) * 0x9e3779b97f4a7c15U >> 20) & (a->slots - 1);
}

static void border_put(addresses *a, void *memory) {
  size_t i = place_of(a, memory);
  while (a->slot[i]) i = (i + 1) & (a->slots - 1);
  a->slot[i] = memory;
  a->used++;
}

/* False if there is no memory for more. */
static bool border_grow(addresses *a) {
  addresses larger = {.slots = 2 * a->slots, .slot = __real_calloc(2 * a->slots, sizeof *larger.slot)};
  if (!larger.slot) return false;
  for (size_t i = 0; i < a->slots; i++)
    if (a->slot[i]) border_put(&larger, a->slot[i]);
  __real_free(a->slot);
  *a = larger;
  return true;
}

/* Removes an address, and moves those behind it that its place kept from their own. */
static void border_take(addresses *a, const void *memory) {
  size_t i = place_of(a, memory);
  while (a->slot[i] && a->slot[i] != memory) i = (i + 1) & (a->slots - 1);
  if (!a->slot[i]) return;
  a->used--;
  for (size_t j = (i + 1) & (a->slots - 1); a->slot[j]; j = (j + 1) & (a->slots - 1)) {
    const size_t own = place_of(a, a->slot[j]);
    if (((j - own) & (a->slots - 1)) < ((j - i) & (a->slots - 1))) continue;
    a->slot[i] = a->slot[j];
    i = j;
  }
  a->slot[i] = NULL;
}

/* ---- borders ---- */

kz_border *kz_border_create(void) {
  kz_border *border = __real_calloc(1, sizeof *border);
  if (!border) return NULL;
  border->memory = (addresses){.slots = FIRST_SLOTS, .slot = __real_calloc(FIRST_SLOTS, sizeof(void *))};
  if (border->memory.slot && pthread_mutex_init(&border->mutex, NULL) == 0) return border;
  __real_free(border->memory.slot);
  __real_free(border);
  return NULL;
}

void kz_border_empty(kz_border *border) {
  for (size_t i = 0; i < border->memory.slots; i++) {
    __real_free(border->memory.slot[i]);
    border->memory.slot[i] = NULL;
  }
  border->memory.used = 0;
}

void kz_border_free(kz_border *border) {
  if (!border) return;
  kz_border_empty(border);
  pthread_mutex_destroy(&border->mutex);
  __real_free(border->memory.slot);
  __real_free(border);
}

bool kz_border_lacked_memory(const kz_border *border) {
  return border->lacked_memory;
}

kz_border *kz_border_here(void) {
  return here.border;
}

void kz_border_enter(kz_border *border) {
  here = (visit){.border = border};
}

/* ---- leaving ---- */

/* Leaves the work of this thread up to its innermost guard, with the control word of the processor as it was there. */
static void border_leave(kz_status why) {
  here.border->left = why;
  while (here.n_locks > 0) pthread_mutex_unlock(here.lock[--here.n_locks]);
  if (!here.way_out) abort(); /* a thread without a guard */
  longjmp(*here.way_out, 1);
}

kz_status kz_border_guard(kz_status (*work)(void *context), void *context) {
  if (!here.border) return work(context);
  jmp_buf way_out, *const outer = here.way_out;
  fenv_t environment;
  volatile kz_status status = KZ_OK;
  fegetenv(&environment);
  here.way_out = &way_out;
  if (setjmp(way_out) == 0) {
    status = work(context);
  } else {
    fesetenv(&environment);
    status = (kz_status)here.border->left;
    if (here.border->lacked_memory) kz_fail(KZ_FAILED, "memory ran out");
  }
  here.way_out = outer;
  return status;
}

void kz_border_leave(void) {
  if (here.border && here.border->left) border_leave((kz_status)here.border->left);
}

kz_status kz_border_call(kz_border *border, kz_pause_fn pause, void *pause_context, kz_status (*work)(void *context),
                         void *context, bool *left) {
  const visit outer = here;
  if (outer.border != border) { /* not a call within a call */
    border->left = 0;
    border->lacked_memory = false;
  }
  here =
      (visit){.border = border, .pause = pause, .pause_context = pause_context, .due = pause ? kz_clock() + PAUSE : 0};
  const kz_status status = kz_border_guard(work, context);
  *left = border->left != 0;
  here = outer;
  return status;
}

void kz_border_lacks(void) {
  if (here.border) here.border->lacked_memory = true;
}

void kz_border_without_memory(void) {
  if (!here.border) return;
  kz_border_lacks();
  border_leave(KZ_FAILED);
}

kz_status kz_border_pause(void) {
  if (!here.pause || kz_clock() < here.due) return KZ_OK;
  const kz_status status = here.pause(here.pause_context);
  here.due = kz_clock() + PAUSE;
  return status;
}

void *kz_border_give(size_t bytes) {
  void *memory = __real_calloc(1, bytes);
  if (!memory) kz_border_without_memory();
  return memory;
}

void kz_look(void) {
  if (!here.border) return;
  kz_border_leave();
  if (!here.pause || ++here.calls < CALLS_BETWEEN_CLOCKS) return;
  here.calls = 0;
  const kz_status status = kz_border_pause();
  if (status != KZ_OK) border_leave(status);
}

/* ---- what memory and locks tell ---- */

void kz_border_keep(void *memory) {
  kz_border *border = here.border;
  if (!border || !memory) return;
  pthread_mutex_lock(&border->mutex);
  const bool fits = 2 * (border->memory.used + 1) <= border->memory.slots || border_grow(&border->memory);
  if (fits) border_put(&border->memory, memory);
  pthread_mutex_unlock(&border->mutex);
  if (fits) return;
  __real_free(memory);
  kz_border_without_memory();
}

void kz_border_forget(void *memory) {
  kz_border *border = here.border;
  if (!border || !memory) return;
  pthread_mutex_lock(&border->mutex);
  border_take(&border->memory, memory);
  pthread_mutex_unlock(&border->mutex);
}

void kz_border_lock(pthread_mutex_t *lock) {
  if (!here.border) return;
  if (here.border->left || here.n_locks == MOST_LOCKS) { /* data under the lock may be half changed */
    pthread_mutex_unlock(lock);
    border_leave(here.border->left ? (kz_status)here.border->left : KZ_FAILED);
  }
  here.lock[here.n_locks++] = lock;
}

void kz_border_unlock(pthread_mutex_t *lock) {
  if (here.n_locks > 0 && here.lock[here.n_locks - 1] == lock) here.n_locks--;
}
