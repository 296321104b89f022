/* Rows of the keys of kz_measure_options, for a study whose plan has them in the field `options`. */
#pragma once

#include "kapitza/study_key_rows.h"

#define MEASURE_OPTIONS(study, many)                                                                                   \
  KZ_ROW_PART(#study ".weight", "", options.has_weight, "The Gaussian distribution of the starts of weighted_share."), \
      KZ_ROW_REAL(#study ".weight.theta", "rad", -1e6, 1e6, NULL, options.weight.theta, "Mean angle from down."),      \
      KZ_ROW_REAL(#study ".weight.velocity", KZ_VELOCITY_UNIT, -KZ_MOST_SPEED, KZ_MOST_SPEED, "0",                     \
                  options.weight.velocity, "Mean velocity."),                                                          \
      KZ_ROW_REAL(#study ".weight.theta_spread", "rad", 0, 1e3, NULL, options.weight.theta_spread,                     \
                  "Standard deviation of the angle."),                                                                 \
      KZ_ROW_REAL(#study ".weight.velocity_spread", KZ_VELOCITY_UNIT, 0, 1e3, "0", options.weight.velocity_spread,     \
                  "Standard deviation of the velocity."),                                                              \
      KZ_ROW_INTEGER(#study ".within", 1, 4e9, "", options.within, "Drive periods of share_within."),                  \
      KZ_ROW(#study ".sizes", KZ_KEY_REALS, "[0.3]", KZ_ROW_AT(options.sizes),                                         \
             "Sizes of the shocks of harmless, ascending.", .unit = "rad", .low = KZ_ABOVE_ZERO, .high = 1e3),         \
      KZ_ROW_INTEGER(#study ".cells", 16, 4096, many, options.cells,                                                   \
                     "Cells of the picture of labels along each axis, for integrity, entropy and boundaries."),        \
      KZ_ROW_REAL(#study ".shock_scale", KZ_VELOCITY_UNIT, 1e-6, 1e6, "1", options.shock_scale,                        \
                  "Change of the velocity that counts as much as 1 rad: the norm of shocks, circles, distances and "   \
                  "amplification."),                                                                                   \
      KZ_ROW_REAL(                                                                                                     \
          #study ".shock_tolerance", "", 0, 0.02, "0", options.shock_tolerance,                                        \
          "Part of its size by which a smallest shock of the table of measures may be too large; 0: as closely as "    \
          "basin.shocks. It decides how many starts are tried.")
