/* Memory of the Fortran layers. Code that gfortran makes for automatic arrays, temporaries and assignments does not look
 * whether there was memory: the build renames malloc, calloc and realloc in those layers to the functions here, which do. */
#ifndef KAPITZA_MEMORY_H
#define KAPITZA_MEMORY_H

#include <stddef.h>

/* As in C, but they return only where there was memory. */
void *kz_malloc(size_t bytes);
void *kz_calloc(size_t n, size_t bytes);
void *kz_realloc(void *old, size_t bytes);

/* What is done where there is none: `leave` must end the process. Without it: abort. */
void kz_memory_on_failure(void (*leave)(void));

#endif
