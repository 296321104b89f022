/* The study `stability`: its row, and the table of its keys. */
#define KEYS_OF stability

#include "kapitza/study_key_rows.h"
#include "kapitza/study_stability.h"

#define STABILITY_AXIS(form_, axis, fallback, help)                                                      \
  KZ_ROW("stability." #axis, KZ_KEY_MAPPING, fallback, KZ_ROW_NOWHERE, help, .unit = "", .form = form_), \
      KZ_ROW_REAL("stability." #axis ".min", "", -1e6, 1e6, NULL, axis.min, "First value."),             \
      KZ_ROW_REAL("stability." #axis ".max", "", -1e6, 1e6, NULL, axis.max, "Last value."),              \
      KZ_ROW_INTEGER("stability." #axis ".count", 1, 1e6, "", axis.count, "Number of values; left out: 1000.")
#define STABILITY_DAMPING(form_, name, symbol_, low_, help)                                                \
  KZ_ROW("stability." #name, KZ_KEY_REAL, "", KZ_ROW_AT(name), help, .unit = "", .low = low_, .high = 1e5, \
         .form = form_, .symbol = symbol_)

static const kz_key keys[] = {
    KZ_ROW_STUDY(
        "Study: the chart of the linear equation u'' + beta u' + (k - m f(t)) u = 0 over (k, m), and its transition "
        "curves; f is "
        "the wave form of the pendulum, or cos t."),
    STABILITY_AXIS("ab", k, NULL, "Values of k, both ends included; negative about the inverted position."),
    STABILITY_AXIS("ab", m, NULL,
                   "Values of m, both ends included; about the inverted position m changes its sign as k does."),
    STABILITY_DAMPING("ac", damping, "beta", 0.0,
                      "beta, the same at every point; left out, with quality_factor: no damping."),
    STABILITY_DAMPING("bd", quality_factor, "Q", 1e-3, "Q: beta = sqrt(abs(k))/Q at each point."),
    STABILITY_AXIS("cd", a, "", "Instead of k, in the words of ion traps: a = 4 k."),
    STABILITY_AXIS("dc", q, "", "Instead of m, in the words of ion traps: q = 2 m."),
    KZ_ROW("stability.curves", KZ_KEY_WORDS, "", KZ_ROW_AT(curves),
           "Transition curves: of the sine over k, with the upper branch of curves that turn back; hill_1 to 5 of any "
           "wave form "
           "over m, without damping; meissner_1 to 5 of the true square wave.",
           .unit = "", .words_from = kz_curve_names),
    KZ_ROW("stability.subharmonics", KZ_KEY_INTEGERS, "", KZ_ROW_AT(subharmonics),
           "Periods n of subharmonic solutions. Their curves are computed exactly and by the determinant.", .unit = "",
           .low = 2, .high = 1000),
    {.path = NULL},
};

KZ_STUDY_ROW();
