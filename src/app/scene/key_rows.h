/* How the table of keys (keys.c, and keys.inc in the folders of the studies) writes its rows. */
#ifndef KAPITZA_APP_SCENE_KEY_ROWS_H
#define KAPITZA_APP_SCENE_KEY_ROWS_H

#include "scene.h"

#define AT(field) offsetof(kz_scene, field)

/* One row: the first four of every type, then what the type needs. */
#define ROW(path_, type_, fallback_, offset_, help_, ...) \
  {.path = path_, .type = type_, .fallback = fallback_, .offset = offset_, .help = help_, __VA_ARGS__}
#define MAPPING(path, fallback, offset, help) ROW(path, KZ_KEY_MAPPING, fallback, offset, help, .unit = "")
/* Keys that basin.accuracy answers. */
#define CHOSEN .chosen_by = "basin.accuracy", .chooser = AT(basin.accuracy)
#define TEXT(path, fallback, field, help) ROW(path, KZ_KEY_TEXT, fallback, AT(field), help, .unit = "")
#define WORD(path, words_, fallback, field, help, ...) \
  ROW(path, KZ_KEY_WORD, fallback, AT(field), help, .unit = "", .words = words_, __VA_ARGS__)
#define WORDS(path, words_, fallback, field, help) \
  ROW(path, KZ_KEY_WORDS, fallback, AT(field), help, .unit = "", .words_from = words_)
#define INTEGER(path, low_, high_, fallback, field, help, ...) \
  ROW(path, KZ_KEY_INTEGER, fallback, AT(field), help, .unit = "", .low = low_, .high = high_, __VA_ARGS__)
#define COUNT(path, low_, high_, fallback, field, help, ...) \
  ROW(path, KZ_KEY_COUNT, fallback, AT(field), help, .unit = "", .low = low_, .high = high_, __VA_ARGS__)
#define BOOLEAN(path, fallback, field, help) ROW(path, KZ_KEY_BOOLEAN, fallback, AT(field), help, .unit = "")
#define REAL(path, unit_, low_, high_, fallback, field, help) \
  ROW(path, KZ_KEY_REAL, fallback, AT(field), help, .unit = unit_, .low = low_, .high = high_)
/* The two ways to give a window: by its edges, and by its middle. */
#define EDGE(path, unit_, limit, fallback, field, help) \
  ROW(path, KZ_KEY_REAL, fallback, AT(field), help, .unit = unit_, .low = -limit, .high = limit, .form = "a")
#define DECIMAL(path, unit_, low_, high_, fallback, field, help) \
  ROW(path, KZ_KEY_DECIMAL, fallback, AT(field), help, .unit = unit_, .low = low_, .high = high_, .form = "b")
#define CENTRE_HELP "Middle of the window; up to 1000 digits, all of which count."
#define PENDULUM(form_, name, unit_, low_, fallback, help)                                                     \
  ROW("pendulum." #name, KZ_KEY_REAL, fallback, AT(parameters.written.name), help, .unit = unit_, .low = low_, \
      .high = DBL_MAX, .form = form_)

/* The window of a study's starts or points; it may be the whole circle. */
#define THETA_WINDOW(study, help)                                                                    \
  MAPPING(#study ".theta", "", KZ_NO_FIELD, help),                                                   \
      REAL(#study ".theta.min", "rad", -1e6, 1e6, "", study.theta.min, "Lower edge of the window."), \
      REAL(#study ".theta.max", "rad", -1e6, 1e6, "", study.theta.max, "Upper edge of the window.")
#define VELOCITY_WINDOW(study, most, fallback, lowest, highest, help)                                \
  MAPPING(#study ".velocity", fallback, KZ_NO_FIELD, help),                                          \
      REAL(#study ".velocity.min", "rad per drive radian", -most, most, lowest, study.velocity.min,  \
           "Lower edge of the window."),                                                             \
      REAL(#study ".velocity.max", "rad per drive radian", -most, most, highest, study.velocity.max, \
           "Upper edge of the window.")
#define PLANE_AXIS(study, axis, help)                                                                                         \
  MAPPING(#study "." #axis, NULL, KZ_NO_FIELD, help),                                                                         \
      ROW(#study "." #axis ".parameter", KZ_KEY_WORD, NULL, AT(study.axis.parameter),                                         \
          "Key of the pendulum mapping, as written there, that takes the values.", .unit = "", .words_from = kz_sweep_words), \
      REAL(#study "." #axis ".min", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, study.axis.values.min, "First value."),             \
      REAL(#study "." #axis ".max", KZ_OWN_UNIT, -DBL_MAX, DBL_MAX, NULL, study.axis.values.max, "Last value.")

#endif
