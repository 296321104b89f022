/* Variables of the group stability of the result file. */
#include "kapitza/store_variables.h"
#include "stability.h"

#define EDGE(name, long_name) {name, KZ_REAL, {"m"}, NONE, long_name, {0}}
#define CURVE(name, long_name) {name, KZ_REAL, {"k"}, NONE, long_name, {0}}

/* clang-format off */
const kz_variable kz_stability_variables[] = {
    {"k", KZ_REAL, {"k"}, NONE, "gravity term, (natural / drive frequency) squared; < 0 about inverted"},
    {"m", KZ_REAL, {"m"}, NONE, "drive amplitude"},
    {"a", KZ_REAL, {"k"}, NONE, "the same in the words of ion traps, a = 4 k"},
    {"q", KZ_REAL, {"m"}, NONE, "the same in the words of ion traps, q = 2 m"},
    {"log_multiplier", KZ_REAL, {"m", "k"}, RATE, "natural logarithm of the largest |Floquet multiplier|"},
    {"angle", KZ_REAL, {"m", "k"}, NONE, "Floquet angle / 2 pi"},
    {"stable", KZ_UINT8, {"m", "k"}, NONE, "whether small oscillations stay small", {"no", "yes"}},
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
    EDGE("hill_1", "transition curve of the wave form: lowest k with a solution of period 2 pi"),
    EDGE("hill_2", "transition curve of the wave form: lowest k with a solution of period 4 pi"),
    EDGE("hill_3", "transition curve of the wave form: second k with a solution of period 4 pi"),
    EDGE("hill_4", "transition curve of the wave form: second k with a solution of period 2 pi"),
    EDGE("hill_5", "transition curve of the wave form: third k with a solution of period 2 pi"),
    EDGE("meissner_1", "transition curve 1 of the square wave, closed form by Meissner (1918)"),
    EDGE("meissner_2", "transition curve 2 of the square wave, closed form by Meissner (1918)"),
    EDGE("meissner_3", "transition curve 3 of the square wave, closed form by Meissner (1918)"),
    EDGE("meissner_4", "transition curve 4 of the square wave, closed form by Meissner (1918)"),
    EDGE("meissner_5", "transition curve 5 of the square wave, closed form by Meissner (1918)"),
    CURVE("subharmonic_#", "exact curve of solutions that repeat after this many drive periods"),
    CURVE("butikov_subharmonic_#", "the same curve by Butikov (2018) Eq. (21), corrected"),
    {0},
};
/* clang-format on */
