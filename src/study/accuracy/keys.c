/* The study `tradeoff`: its row, and the table of its keys. */
#define KEYS_OF tradeoff

#include "kapitza/study_key_rows.h"
#include "plan.h"

static const kz_key keys[] = {
    KZ_ROW_STUDY("Study: time and wrong labels of many settings on the basin's window, compared with quad precision."),
    KZ_ROW_INTEGER("tradeoff.samples", 10, 1e6, "4000", samples, "Random cells that are compared."),
    KZ_ROW_WORDS("tradeoff.settings", kz_tradeoff_words, "", settings, "Settings that are compared; left out: all."),
    {.path = NULL},
};

KZ_STUDY_ROW(.check = kz_tradeoff_check, .needs = {{"a window", "basin"}});
