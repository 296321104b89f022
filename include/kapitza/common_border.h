/* common: calls of the library, which come back to their caller where memory runs out or the caller asks for a stop. */
#pragma once

#include <pthread.h>

#include "kapitza/common.h"

/* The border of an object of the library: the memory allocated for it. Calls on one object must follow one another. */
typedef struct kz_border kz_border;
/* NULL: there is no memory. */
kz_border *kz_border_create(void);
/* Frees the border and all memory that was allocated within it. */
void kz_border_free(kz_border *border);

/* Asks the caller of the library whether to go on; any status but KZ_OK stops the call. */
typedef kz_status (*kz_pause_fn)(void *context);

/* Runs `work` on this thread within the border and returns its status. Where memory runs out (KZ_FAILED), or `pause`,
 * asked every PAUSE seconds (NULL: never), returns another status than KZ_OK, the work is left at once; then *left is
 * true, and all that it had made or changed within the border is lost: kz_border_empty must come next. */
kz_status kz_border_call(kz_border *border, kz_pause_fn pause, void *pause_context, kz_status (*work)(void *context),
                         void *context, bool *left);
/* Frees all memory that was allocated within the border. */
void kz_border_empty(kz_border *border);
/* Memory for the caller of the library, who frees it by free; the last thing that a call makes. */
void *kz_border_give(size_t bytes);
/* Notes that a call of this thread fails because memory that it asked for beforehand is not there. */
void kz_border_lacks(void);
/* True if memory ran out in the last call, or was not there. */
bool kz_border_lacked_memory(const kz_border *border);

/* Asks the caller of the library of this thread, if there is one and it is time, and returns its status. */
kz_status kz_border_pause(void);
/* Calls kz_border_pause, and leaves the call if it is to stop. Memory, integrators and other long loops call it. */
void kz_look(void);

/* Parts of a call that have to be ended in order, such as threads: kz_border_guard runs `work`, or the part of it up to
 * where it is left, which it tells by its status; kz_border_leave, after the end of the others, goes on leaving. */
kz_status kz_border_guard(kz_status (*work)(void *context), void *context);
void kz_border_leave(void);
/* The border of this thread, for another one that works for the same call; NULL: none. */
kz_border *kz_border_here(void);
void kz_border_enter(kz_border *border);

/* Memory and locks register with the border of this thread (memory.c, threads.c). kz_border_lock returns once
 * locked. */
void kz_border_keep(void *memory);
void kz_border_forget(void *memory);
void kz_border_without_memory(void);
void kz_border_lock(pthread_mutex_t *lock);
void kz_border_unlock(pthread_mutex_t *lock);
