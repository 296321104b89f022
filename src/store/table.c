#include "table.h"

#include <stdbool.h>
#include <string.h>

#include "kapitza/common.h"

#define TIME "rad|drive radians"
#define BY_DRIVE {"drive_amplitude", "theta"}
#define ENERGY "1|units of I omega^2"
#define CURVE(name, long_name) {"stability", name, KZ_REAL, {"k"}, NONE, long_name, {0}}
#define OWN "@parameter_units" /* of the swept key */
#define END_KINDS "left_the_range", "fold", "period_doubling", "neimark_sacker", "symmetry_breaking", "not_located"

/* clang-format off: a row is a line */
static const kz_variable variables[] = {
    /* group, name, kind, dimensions, units, long name, flag meanings */
    {"orbit", "time", KZ_REAL, {"time"}, TIME, "time since the record began"},
    {"orbit", "theta", KZ_REAL, {"time"}, ANGLE, "angle from down, counterclockwise, not wrapped"},
    {"orbit", "velocity", KZ_REAL, {"time"}, VELOCITY, "angular velocity"},
    {"orbit", "pivot", KZ_REAL, {"time"}, NONE, "height of the pivot, of a sine m cos t, in units of I/(M r)"},
    {"orbit", "pivot_aside", KZ_REAL, {"time"}, NONE, "how far the pivot is aside, in units of I/(M r)"},
    {"orbit", "strobe_time", KZ_REAL, {"strobe_time"}, TIME, "time of the strobe points, both ends of the record"},
    {"orbit", "strobe_theta", KZ_REAL, {"strobe_time"}, ANGLE, "angle of the strobe point from down, not wrapped"},
    {"orbit", "strobe_velocity", KZ_REAL, {"strobe_time"}, VELOCITY, "angular velocity of the strobe point"},
    {"orbit", "maximum_time", KZ_REAL, {"maximum_time"}, TIME, "time of the turning points after the first sample"},
    {"orbit", "maximum_angle", KZ_REAL, {"maximum_time"}, ANGLE, "angle of the turning point from the centre"},
    {"orbit", "line_frequency", KZ_REAL, {"line_frequency"}, "1|drive frequencies", "frequency of the spectral line"},
    {"orbit", "line_amplitude", KZ_REAL, {"line_frequency"}, "@line_units", "amplitude of the spectral line; line 0 = |mean|"},
    {"orbit", "line_phase", KZ_REAL, {"line_frequency"}, ANGLE, "phase of the spectral line at the first sample"},

    {"stability", "k", KZ_REAL, {"k"}, NONE, "gravity term, (natural / drive frequency) squared; < 0 about inverted"},
    {"stability", "m", KZ_REAL, {"m"}, NONE, "drive amplitude"},
    {"stability", "log_multiplier", KZ_REAL, {"m", "k"}, RATE, "natural logarithm of the largest |Floquet multiplier|"},
    {"stability", "angle", KZ_REAL, {"m", "k"}, NONE, "Floquet angle / 2 pi"},
    {"stability", "stable", KZ_UINT8, {"m", "k"}, NONE, "whether small oscillations stay small", {"no", "yes"}},
    CURVE("exact_1", "exact transition curve 4k = a_0(2m)"),
    CURVE("exact_2", "exact transition curve 4k = b_1(2m)"),
    CURVE("exact_3", "exact transition curve 4k = a_1(2m)"),
    CURVE("exact_3_upper", "exact transition curve 4k = a_1(2m), beyond its turn"),
    CURVE("exact_4", "exact transition curve 4k = b_2(2m)"),
    CURVE("exact_5", "exact transition curve 4k = a_2(2m)"),
    CURVE("exact_5_upper", "exact transition curve 4k = a_2(2m), beyond its turn"),
    CURVE("butikov_1", "transition curve by Butikov (2018) Eq. (3)"),
    CURVE("butikov_2", "transition curve by Butikov (2018) Eq. (4)"),
    CURVE("butikov_3", "transition curve by Butikov (2018) Eq. (5), lower sign"),
    CURVE("butikov_3_upper", "transition curve by Butikov (2018) Eq. (5), upper sign"),
    CURVE("butikov_4", "transition curve by Butikov (2018) Eq. (6)"),
    CURVE("butikov_5", "transition curve by Butikov (2018) Eq. (7)"),
    CURVE("butikov_4_refined", "transition curve by Butikov (2018) Eq. (17)"),
    CURVE("butikov_5_refined", "transition curve by Butikov (2018) Eq. (19)"),
    CURVE("butikov_5_refined_upper", "transition curve by Butikov (2018) Eq. (19), other sign"),
    CURVE("blackburn_lower", "lower boundary of the inverted state, Blackburn (1992) Eq. (5)"),
    CURVE("blackburn_upper", "upper boundary of the inverted state, Blackburn (1992) Eq. (6)"),
    CURVE("blackburn_down_upper", "upper boundary of the hanging state, Blackburn (1992) Eq. (6)"),
    CURVE("damped_0", "exact lower boundary of the inverted state with damping"),
    CURVE("damped_1", "exact lowest m of the damped tongue from k = 1/4"),
    CURVE("damped_1_upper", "exact highest m of the damped tongue from k = 1/4"),
    CURVE("damped_2", "exact lowest m of the damped tongue from k = 1"),
    CURVE("damped_2_upper", "exact highest m of the damped tongue from k = 1"),
    CURVE("butikov_damped_1", "damped tongue from k = 1/4 by Butikov (2018) Eq. (25), corrected"),
    CURVE("butikov_damped_1_upper", "damped tongue from k = 1/4 by Butikov (2018) Eq. (25), corrected, larger root"),
    CURVE("butikov_damped_2", "damped tongue from k = 1 by Butikov (2018) Eq. (26), corrected"),
    CURVE("subharmonic_#", "exact curve of solutions that repeat after this many drive periods"),
    CURVE("butikov_subharmonic_#", "the same curve by Butikov (2018) Eq. (21), corrected"),

    {"potential", "theta", KZ_REAL, {"theta"}, ANGLE, "slow angle from down, counterclockwise"},
    {"potential", "drive_amplitude", KZ_REAL, {"drive_amplitude"}, NONE, "drive amplitude m"},
    {"potential", "energy", KZ_REAL, BY_DRIVE, ENERGY,
     "effective potential of the slow equation, Blackburn (1992) Eq. (10), exact"},
    {"potential", "energy_blackburn", KZ_REAL, BY_DRIVE, ENERGY, "effective potential by Blackburn (1992) Eq. (11)"},
    {"potential", "energy_simple", KZ_REAL, BY_DRIVE, ENERGY, "effective potential by Blackburn (1992) Eq. (12)"},
    {"potential",
     "rim",
     KZ_REAL,
     {"drive_amplitude"},
     ANGLE,
     "rim of the inverted well from down, cos = -2 k/m^2 of Eq. (12); NaN: no well"},
    {"potential",
     "rim_exact",
     KZ_REAL,
     {"drive_amplitude"},
     ANGLE,
     "rim of the inverted well of the exact potential from down; NaN: no well"},
    {"potential",
     "stable_inverted",
     KZ_UINT8,
     {"drive_amplitude"},
     NONE,
     "whether the exact potential has an inverted well",
     {"no", "yes"}},

    {"tradeoff", "setting", KZ_INT32, {"setting"}, NONE, "place in the list of settings"},
    {"tradeoff", "label", KZ_TEXT, {"setting"}, NONE, "name of the setting"},
    {"tradeoff", "method", KZ_INT8, {"setting"}, NONE, "how cells are labelled", {KZ_METHOD_WORDS}},
    {"tradeoff", "scheme", KZ_TEXT, {"setting"}, NONE, "integrator"},
    {"tradeoff", "steps_per_period", KZ_INT32, {"setting"}, NONE, "steps of the scheme in a drive period"},
    {"tradeoff",
     "interpolation",
     KZ_INT8,
     {"setting"},
     NONE,
     "interpolation of the map table, which a direct label does not use",
     {KZ_INTERPOLATION_WORDS}},
    {"tradeoff", "table_nodes", KZ_INT32, {"setting"}, NONE, "nodes of the map table along each axis"},
    {"tradeoff", "wrong", KZ_REAL, {"setting"}, NONE, "share of cells whose label differs from the reference"},
    {"tradeoff", "wrong_low", KZ_REAL, {"setting"}, NONE, "lower end of its 95 % interval"},
    {"tradeoff", "wrong_high", KZ_REAL, {"setting"}, NONE, "upper end of its 95 % interval"},
    {"tradeoff", "undecided", KZ_REAL, {"setting"}, NONE, "share of cells that method exact does not decide"},
    {"tradeoff",
     "wrong_inside",
     KZ_REAL,
     {"setting"},
     NONE,
     "share of cells that are wrong without another label next to them"},
    {"tradeoff", "wrong_distance", KZ_REAL, {"setting"}, "1|cells", "median distance of the wrong cells from another label"},
    {"tradeoff", "fraction_error", KZ_REAL, {"setting"}, NONE, "largest error of a basin's share of the sample"},
    {"tradeoff",
     "seconds",
     KZ_REAL,
     {"setting"},
     "s",
     "processor time of one core for the map table and all cells of the basin"},
    {"tradeoff", "seconds_per_million_cells", KZ_REAL, {"setting"}, "s", "processor time of one core to label a million cells"},
    {"tradeoff",
     "pareto",
     KZ_INT8,
     {"setting"},
     NONE,
     "whether no other setting is both as fast and as accurate",
     {"no", "yes"}},

    {"sweep", "value", KZ_REAL, {"value"}, OWN, "value of the swept key of the pendulum"},
    {"sweep", "branch", KZ_INT32, {"branch"}, NONE, "number of the branch"},
    {"sweep", "branch_name", KZ_TEXT, {"branch"}, NONE, "name of the attractor where the branch begins"},
    {"sweep", "branch_period", KZ_INT32, {"branch"}, PERIODS, "period of the orbit; 0 = aperiodic (chaotic)"},
    {"sweep", "branch_winding", KZ_INT32, {"branch"}, NONE, "net turns in one period of the orbit, + counterclockwise"},
    {"sweep", "branch_centre", KZ_INT8, {"branch"}, NONE, "what the orbit moves about where the branch begins", {CENTRES}},
    {"sweep", "branch_symmetric", KZ_INT8, {"branch"}, NONE, "whether the orbit is its own mirror image", {"no", "yes"}},
    {"sweep", "branch_mirror", KZ_INT32, {"branch"}, NONE, "number of the branch of mirror images; -1 = not seen"},
    {"sweep", "branch_start", KZ_REAL, {"branch"}, OWN, "lowest value at which the branch exists and attracts"},
    {"sweep", "branch_end", KZ_REAL, {"branch"}, OWN, "highest value at which the branch exists and attracts"},
    {"sweep", "branch_start_kind", KZ_INT8, {"branch"}, NONE, "how the branch begins", {END_KINDS}},
    {"sweep", "branch_end_kind", KZ_INT8, {"branch"}, NONE, "how the branch ends", {END_KINDS}},
    {"sweep", "branch_amplitude", KZ_REAL, {"value", "branch"}, ANGLE, "largest angle from the centre; NaN = not there"},
    {"sweep", "branch_multiplier", KZ_REAL, {"value", "branch"}, NONE, "modulus of the largest Floquet multiplier"},
    {"sweep", "branch_theta", KZ_REAL, {"value", "branch"}, ANGLE, "angle of one strobe point from down"},
    {"sweep", "branch_velocity", KZ_REAL, {"value", "branch"}, VELOCITY, "angular velocity of the same strobe point"},
    {"sweep",
     "lifetime",
     KZ_REAL,
     {"value"},
     PERIODS,
     "mean time from lifetime_after on until a motion settles; NaN = none settled"},
    {"sweep", "lifetime_low", KZ_REAL, {"value"}, PERIODS, "lower end of its 95 % interval"},
    {"sweep", "lifetime_high", KZ_REAL, {"value"}, PERIODS, "upper end of its 95 % interval"},
    {"sweep", "lifetime_after", KZ_REAL, {"value"}, PERIODS, "time from which the mean lifetime is counted"},
    {"sweep", "lifetime_open", KZ_REAL, {"value"}, NONE, "starts that had not settled in the end"},
    {"sweep", "alike", KZ_REAL, {"value"}, NONE, "share of the cells or starts that end alike at all phases of release"},
    {"sweep", "alike_low", KZ_REAL, {"value"}, NONE, "lower end of its 95 % interval (Wilson)"},
    {"sweep", "alike_high", KZ_REAL, {"value"}, NONE, "upper end of its 95 % interval (Wilson)"},
    {"sweep", "shock_angle", KZ_REAL, {"value", "branch"}, ANGLE, "smallest change of the angle that leaves the basin"},
    {"sweep", "shock_kick", KZ_REAL, {"value", "branch"}, VELOCITY, "smallest change of the velocity that leaves the basin"},
    {"sweep", "shock_size", KZ_REAL, {"value", "branch"}, ANGLE, "size of the smallest shock that leaves the basin"},
    {"sweep", "fraction", KZ_REAL, {"value", "branch"}, NONE, "share of the cells or starts; NaN = not there"},
    {"sweep", "fraction_low", KZ_REAL, {"value", "branch"}, NONE, "lower end of the 95 % interval of the share (Wilson)"},
    {"sweep", "fraction_high", KZ_REAL, {"value", "branch"}, NONE, "upper end of the 95 % interval of the share (Wilson)"},
    {"sweep", "flutter_amplitude", KZ_REAL, {"value"}, ANGLE, "largest angle from inverted of the attracting flutter"},
    {"sweep", "flutter_onset", KZ_REAL, {"value"}, NONE, "drive m at which the inverted state gives way to flutter"},
    {"sweep", "flutter_asymmetry", KZ_REAL, {"value"}, NONE, "drive m at which flutter loses its mirror symmetry"},
    {"sweep", "flutter_end", KZ_REAL, {"value"}, NONE, "drive m at which the cycles that follow double their period"},
    {"sweep", "flutter_release_end", KZ_REAL, {"value"}, NONE, "lowest drive m at which a release of 1 degree fails"},
    {"sweep", "release_angle", KZ_REAL, {"value"}, ANGLE, "angle from inverted at which a release from rest first fails"},
    {"sweep", "release_angle_scan", KZ_REAL, {"value"}, ANGLE, "the same by a scan in whole degrees, refined by bisection"},
    {"sweep", "release_angle_largest", KZ_REAL, {"value"}, ANGLE, "end of the last interval of releases that stay"},
    {"sweep", "release", KZ_REAL, {"release"}, ANGLE, "angle from inverted of a release from rest"},
    {"sweep", "release_stays", KZ_UINT8, {"value", "release"}, NONE, "whether the release stays about inverted", {"no", "yes"}},
    {"sweep", "sample", KZ_INT32, {"sample"}, PERIODS, "strobe points of the walk up, then of the walk down"},
    {"sweep", "sample_walk", KZ_INT8, {"sample"}, NONE, "direction of the walk along the values", {"up", "down"}},
    {"sweep", "strobe_theta", KZ_REAL, {"value", "sample"}, ANGLE, "angle of the strobe point from down"},
    {"sweep", "strobe_velocity", KZ_REAL, {"value", "sample"}, VELOCITY, "angular velocity of the strobe point"},
};
/* clang-format on */

/* The same name; "#" at the end of a row's name stands for a number. */
static bool is_name(const char *row, const char *name) {
  const size_t stem = strcspn(row, "#");
  if (row[stem] == '\0') return strcmp(row, name) == 0;
  return strncmp(row, name, stem) == 0 && name[stem] != '\0' && strspn(name + stem, "0123456789") == strlen(name + stem);
}

const kz_variable *kz_variable_find(const char *group, const char *name) {
  const struct {
    const kz_variable *rows;
    size_t count;
  } parts[] = {{kz_basin_variables, kz_basin_variable_count},
               {variables, sizeof variables / sizeof *variables},
               {kz_saddle_variables, kz_saddle_variable_count}};
  for (size_t part = 0; part < sizeof parts / sizeof *parts; part++)
    for (size_t i = 0; i < parts[part].count; i++)
      if (strcmp(parts[part].rows[i].group, group) == 0 && is_name(parts[part].rows[i].name, name)) return &parts[part].rows[i];
  return NULL;
}
