/* The table of everything that a result file may hold. */
#ifndef KAPITZA_STORE_TABLE_H
#define KAPITZA_STORE_TABLE_H

#include <stddef.h>

enum { KZ_MAX_DIMENSIONS = 3, KZ_MAX_FLAGS = 12 };

typedef enum { KZ_REAL, KZ_INT8, KZ_UINT8, KZ_INT16, KZ_INT32, KZ_UINT32, KZ_TEXT } kz_kind;

typedef struct {
  const char *group, *name;
  kz_kind kind;
  const char *dimensions[KZ_MAX_DIMENSIONS + 1]; /* NULL-ended; a scale is its own dimension */
  const char *units, *long_name; /* units "@NAME": the value of the group's attribute NAME, written before; "1|WORDS": unit 1
                                  * of UDUNITS, and ", in WORDS" is added to the long name */
  const char *flags[KZ_MAX_FLAGS + 1]; /* meanings of 0, 1, 2, ...; NULL-ended */
} kz_variable;

/* Units that many rows have. */
#define ANGLE "rad"
#define VELOCITY "1|rad per drive radian"
#define PERIODS "1|drive periods"
#define RATE "1|1 per drive period"
#define NONE "1"
/* Meanings that several have. */
#define CENTRES "down", "inverted", "rotating", "none"

/* The part of the table for the groups attractors and basin. */
extern const kz_variable kz_basin_variables[];
extern const size_t kz_basin_variable_count;
/* That for the groups saddles and manifolds. */
extern const kz_variable kz_saddle_variables[];
extern const size_t kz_saddle_variable_count;

/* The row of a variable; NULL where the table has none. */
const kz_variable *kz_variable_find(const char *group, const char *name);

#endif
