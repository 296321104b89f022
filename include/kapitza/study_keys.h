/* study: a row of the table of keys (C; layer 3). */
#pragma once

#include <float.h>

#include "kapitza/study.h"

/* The type of a key, and the C type of its field. */
typedef enum {
  KZ_KEY_MAPPING,  /* bool: the mapping is given (a study), or no field at all (KZ_NO_FIELD) */
  KZ_KEY_TEXT,     /* char *, owned by the scene; "" where absent */
  KZ_KEY_WORD,     /* int32_t: index in `words`; KZ_UNSET_WORD */
  KZ_KEY_BOOLEAN,  /* bool */
  KZ_KEY_INTEGER,  /* int64_t; KZ_UNSET_INTEGER */
  KZ_KEY_COUNT,    /* int32_t; KZ_UNSET_WORD */
  KZ_KEY_REAL,     /* double; NaN where absent */
  KZ_KEY_DECIMAL,  /* kz_decimal; its text is "" where absent */
  KZ_KEY_WORDS,    /* kz_integers: indices */
  KZ_KEY_INTEGERS, /* kz_integers */
  KZ_KEY_REALS,    /* kz_reals */
  KZ_KEY_HARMONICS /* kz_harmonics: a list of mappings */
} kz_key_type;

/* Meaning of a mapping with the keys min and max, beyond its keys. */
typedef enum {
  KZ_RANGE_NONE,
  KZ_RANGE_ANGLES,     /* kz_axis: both edges or neither, which means the whole circle */
  KZ_RANGE_VELOCITIES, /* kz_axis */
  KZ_RANGE_PARAMETER   /* kz_plane_axis: values of a parameter of the pendulum */
} kz_range;

#define KZ_NO_FIELD ((size_t)-1)
#define KZ_UNSET_WORD (-1)
#define KZ_UNSET_INTEGER INT64_MIN
#define KZ_ABOVE_ZERO DBL_TRUE_MIN /* lowest value of a range that excludes zero */

struct kz_key {
  const char *path; /* "basin.theta.count"; a mapping's row stands before the rows of its keys */
  kz_key_type type;
  const char *unit;                /* "" = none */
  double low, high;                /* accepted values, ends included */
  const char *fallback;            /* default as YAML text; "" = may be left out without one; NULL = required */
  const char *words;               /* "icm|direct"; a count has one word for 0: "auto"; a mapping: see `former` */
  const char *(*words_from)(void); /* returns the words if another layer has them */
  const char *former;              /* removed words, or keys of a mapping, and their replacements: "old=new|old=new" */
  const char *symbol;              /* symbol in formulas, accepted instead of the name; NULL = none */
  const char *form;      /* letters: keys of a mapping that share none exclude each other; NULL = of no form */
  size_t plan;           /* offset in kz_scene of the pointer to the plan that has the field; 0 = the scene has it */
  size_t offset;         /* Offset of the field in that plan, bytes */
  kz_range range;        /* Range that the keys of a mapping give together */
  size_t range_offset;   /* Offset of that axis in the plan, bytes */
  const char *chosen_by; /* path of a number that excludes this key, because the program then chooses it; NULL = none */
  const char *help;      /* one sentence of the scene reference */
};

/* Stands for the unit of the key that a sweep changes. */
#define KZ_OWN_UNIT "the unit of the parameter"
/* The unit of velocities, which a scene in SI units may also give per second. */
#define KZ_VELOCITY_UNIT "rad per drive radian"
