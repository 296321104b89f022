/* study: how a study, and the scene for the keys of the pendulum, writes the rows of its table of keys (C; layer 3). */
#pragma once

#include "kapitza/study_keys.h"

/* Offset of a field: of the scene, or of the plan of the study that a file names by KEYS_OF. */
#define KZ_ROW_OF_SCENE(field) .offset = offsetof(kz_scene, field)
#define KZ_ROW_NOWHERE .offset = KZ_NO_FIELD
#ifdef KEYS_OF
#define KZ_ROW_NAMED(before, name, after) before##name##after
#define KZ_ROW_PLAN_OF(name) KZ_ROW_NAMED(kz_, name, _plan)
#define KZ_ROW_STORED(name) KZ_ROW_NAMED(has_, name, )
#define KZ_ROW_AT(field) .plan = offsetof(kz_scene, KEYS_OF), .offset = offsetof(KZ_ROW_PLAN_OF(KEYS_OF), field)
#else
#define KZ_ROW_AT(field) KZ_ROW_OF_SCENE(field)
#endif

/* One row: the first four of every type, then what the type needs. */
#define KZ_ROW(path_, type_, fallback_, place, help_, ...) \
  {.path = path_, .type = type_, .fallback = fallback_, place, .help = help_, __VA_ARGS__}
/* A mapping; one that gives an axis; and one of which the field says whether it is given. */
#define KZ_ROW_MAPPING(path, fallback, help, ...) \
  KZ_ROW(path, KZ_KEY_MAPPING, fallback, KZ_ROW_NOWHERE, help, .unit = "", __VA_ARGS__)
#define KZ_ROW_RANGE(path, range_, axis, fallback, help)                                    \
  KZ_ROW(path, KZ_KEY_MAPPING, fallback, KZ_ROW_NOWHERE, help, .unit = "", .range = range_, \
         .range_offset = offsetof(KZ_ROW_PLAN_OF(KEYS_OF), axis))
#define KZ_ROW_PART(path, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_MAPPING, fallback, KZ_ROW_AT(field), help, .unit = "")
/* Keys that basin.accuracy answers. */
#define KZ_ROW_CHOSEN .chosen_by = "basin.accuracy"
#define KZ_ROW_TEXT(path, fallback, field, help) KZ_ROW(path, KZ_KEY_TEXT, fallback, KZ_ROW_AT(field), help, .unit = "")
#define KZ_ROW_WORD(path, words_, fallback, field, help, ...) \
  KZ_ROW(path, KZ_KEY_WORD, fallback, KZ_ROW_AT(field), help, .unit = "", .words = words_, __VA_ARGS__)
#define KZ_ROW_WORDS(path, words_, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_WORDS, fallback, KZ_ROW_AT(field), help, .unit = "", .words_from = words_)
#define KZ_ROW_INTEGER(path, low_, high_, fallback, field, help, ...) \
  KZ_ROW(path, KZ_KEY_INTEGER, fallback, KZ_ROW_AT(field), help, .unit = "", .low = low_, .high = high_, __VA_ARGS__)
#define KZ_ROW_COUNT(path, low_, high_, fallback, field, help, ...) \
  KZ_ROW(path, KZ_KEY_COUNT, fallback, KZ_ROW_AT(field), help, .unit = "", .low = low_, .high = high_, __VA_ARGS__)
#define KZ_ROW_BOOLEAN(path, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_BOOLEAN, fallback, KZ_ROW_AT(field), help, .unit = "")
#define KZ_ROW_REAL(path, unit_, low_, high_, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_REAL, fallback, KZ_ROW_AT(field), help, .unit = unit_, .low = low_, .high = high_)
/* The two ways to give a window: by its edges, and by its middle. */
#define KZ_ROW_EDGE(path, unit_, limit, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_REAL, fallback, KZ_ROW_AT(field), help, .unit = unit_, .low = -limit, .high = limit, .form = "a")
#define KZ_ROW_DECIMAL(path, unit_, low_, high_, fallback, field, help) \
  KZ_ROW(path, KZ_KEY_DECIMAL, fallback, KZ_ROW_AT(field), help, .unit = unit_, .low = low_, .high = high_, .form = "b")
#define KZ_ROW_CENTRE_HELP "Middle of the window; up to 1000 digits, all of which count."

/* The window of a study's starts or points; it may be the whole circle. */
#define KZ_ROW_THETA_WINDOW(study, help)                                                              \
  KZ_ROW_RANGE(#study ".theta", KZ_RANGE_ANGLES, theta, "", help),                                    \
      KZ_ROW_REAL(#study ".theta.min", "rad", -1e6, 1e6, "", theta.min, "Lower edge of the window."), \
      KZ_ROW_REAL(#study ".theta.max", "rad", -1e6, 1e6, "", theta.max, "Upper edge of the window.")
#define KZ_ROW_VELOCITY_WINDOW(study, most, fallback, lowest, highest, help)                    \
  KZ_ROW_RANGE(#study ".velocity", KZ_RANGE_VELOCITIES, velocity, fallback, help),              \
      KZ_ROW_REAL(#study ".velocity.min", KZ_VELOCITY_UNIT, -most, most, lowest, velocity.min,  \
                  "Lower edge of the window."),                                                 \
      KZ_ROW_REAL(#study ".velocity.max", KZ_VELOCITY_UNIT, -most, most, highest, velocity.max, \
                  "Upper edge of the window.")
#define KZ_ROW_PLANE_AXIS(study, axis, help) \
  KZ_ROW_RANGE(#study "." #axis, KZ_RANGE_PARAMETER, axis, NULL, help), KZ_ROW_PLANE_KEYS(study, axis)
#define KZ_ROW_PLANE_KEYS(study, axis)                                                                             \
  KZ_ROW(#study "." #axis ".parameter", KZ_KEY_WORD, NULL, KZ_ROW_AT(axis.parameter),                              \
         "Key of the pendulum mapping, as written there, that takes the values; pendulum.KEY is the same.",        \
         .unit = "", .words_from = kz_motion_words),                                                               \
      KZ_ROW_REAL(#study "." #axis ".min", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, axis.values.min, "First value."), \
      KZ_ROW_REAL(#study "." #axis ".max", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, axis.values.max, "Last value.")

/* The row of a study, behind its keys: the mapping of its name, the rows of the list that follows, an end. More members
 * of kz_study may be given, as `.check = kz_NAME_check`. */
#ifdef KEYS_OF
#define KZ_ROW_TEXT_OF(name) #name
#define KZ_ROW_STRING_OF(name) KZ_ROW_TEXT_OF(name)
#define KZ_ROW_STUDY(help, ...)                                                                                    \
  KZ_ROW(KZ_ROW_STRING_OF(KEYS_OF), KZ_KEY_MAPPING, "", KZ_ROW_OF_SCENE(KZ_ROW_STORED(KEYS_OF)), help, .unit = "", \
         __VA_ARGS__)
#define KZ_STUDY_ROW(...) KZ_STUDY_ROW_OF(KEYS_OF, __VA_ARGS__)
#define KZ_STUDY_ROW_OF(name, ...) KZ_STUDY_ROW_NAMED(name, __VA_ARGS__)
/* The row of a part of another study, whose run does its work; of: that study, or the mapping that has its keys; has:
 * the field of the scene that says whether it is asked for. */
#define KZ_PART_ROW(of, has, ...) KZ_PART_ROW_OF(KEYS_OF, of, has, __VA_ARGS__)
#define KZ_PART_ROW_OF(name, of, has, ...) KZ_PART_ROW_NAMED(name, of, has, __VA_ARGS__)
#define KZ_PART_ROW_NAMED(name_, of, has, ...)                                  \
  const kz_study kz_##name_##_study = {.name = of,                              \
                                       .wanted = offsetof(kz_scene, has),       \
                                       .plan = offsetof(kz_scene, name_),       \
                                       .plan_bytes = sizeof(kz_##name_##_plan), \
                                       .keys = keys,                            \
                                       __VA_ARGS__}
#define KZ_STUDY_ROW_NAMED(name_, ...)                                            \
  const kz_study kz_##name_##_study = {.name = #name_,                            \
                                       .wanted = offsetof(kz_scene, has_##name_), \
                                       .plan = offsetof(kz_scene, name_),         \
                                       .plan_bytes = sizeof(kz_##name_##_plan),   \
                                       .keys = keys,                              \
                                       .cost = kz_##name_##_cost,                 \
                                       .run = kz_##name_##_run,                   \
                                       __VA_ARGS__}
#endif
